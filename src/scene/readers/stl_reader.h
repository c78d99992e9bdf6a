// SPDX-License-Identifier: Apache-2.0
// STL (3D Systems 1989), text or binary: triangles and nothing else.
#pragma once

#include "scene/readers/reader_table.h"

namespace clrt {

/// Whether bytes are an STL: of the size that the count of a binary one asks for, whatever they begin with,
/// or a text that begins with "solid" and has facets.
bool is_stl(std::string_view bytes);

/// Reads an STL. Equal vertices become one; the facets' own normals are not used: the order of the vertices
/// says which side is the front. The solids of a text are objects. What a binary one holds behind its
/// triangles, and the attributes of these (colours, in some programs), is ignored with a notice; facets of a
/// text with more than three vertices are cut into triangles; facets with a non-finite vertex, or fewer than
/// three, are left out with a notice. Throws SceneError for a binary file that is cut off (byte) and for a
/// text that is no sequence of facets (file:line).
SceneDescription read_stl_scene(SceneFile file, const ReadContext& context);

} // namespace clrt
