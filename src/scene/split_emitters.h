// SPDX-License-Identifier: Apache-2.0
// Emitters where a map makes triangles shine unevenly.
#pragma once

#include "scene/scene.h"

#include <cstddef>

namespace clrt {

/// Parts that a scene has at most beyond one a triangle.
constexpr size_t MOST_EMITTER_PARTS = size_t(1) << 15;

/// Where a material emits so unevenly over its triangles that choosing points by its map pays, its triangles
/// are emitters by what each of them sends itself, cut where that pays most. All others stay as they are, bit
/// by bit.
void split_emitters(Scene& scene);

/// Makes every emissive triangle one emitter, by the mean of its material's map.
void unite_emitters(Scene& scene);

/// Emissive triangles, whole and in parts.
struct EmissiveTriangles {
    size_t count = 0;            ///< all of them
    size_t split = 0, parts = 0; ///< those in parts, and their parts
};
EmissiveTriangles count_emissive_triangles(const Scene& scene);

} // namespace clrt
