// SPDX-License-Identifier: Apache-2.0
// The text of an STL -> its facets.
#pragma once

#include "scene/readers/stl_mesh.h"

#include <string>
#include <string_view>

namespace clrt {

/// Adds the facets of a text to the mesh. Words may stand on any line, and in any case. Throws SceneError
/// (file:line) for one that is not expected where it stands.
void parse_stl_text(std::string_view text, const std::string& path, StlMesh& mesh);

} // namespace clrt
