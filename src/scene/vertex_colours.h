// SPDX-License-Identifier: Apache-2.0
// Colours of vertices: textures whose texels are vertices.
#pragma once

#include "scene/scene.h"

#include <string>

namespace clrt {

/// Puts the colours where the kernels read them: behind the texels. Wants the final positions.
void store_vertex_colours(Scene& scene, const std::string& path);

} // namespace clrt
