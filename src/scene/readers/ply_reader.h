// SPDX-License-Identifier: Apache-2.0
// PLY, the format of scans: text and binary files of either byte order.
#pragma once

#include "scene/readers/reader_table.h"

namespace clrt {

/// Reads a PLY: `vertex` with x, y, z, where given nx, ny, nz, texture coordinates (u, v; s, t; texture_u,
/// texture_v) and colours (red, green, blue: sRGB, integers of their type's range or floats to 1), and `face`
/// with polygons by vertex_indices or vertex_index, or `tristrips`. Other elements and properties are
/// skipped. Faces with a non-finite corner or fewer than three are left out. The material is matte, of the
/// colours where there are some. Throws SceneError: line or byte, expected, found.
SceneDescription read_ply_scene(SceneFile file, const ReadContext& context);

} // namespace clrt
