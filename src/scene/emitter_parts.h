// SPDX-License-Identifier: Apache-2.0
// Parts of emissive triangles, as kernels/geometry/emitter_part.h has them: which part a point is on, and
// where the part is.
#pragma once

#include "scene/scene.h"

#include <array>
#include <cstddef>
#include <glm/vec2.hpp>

namespace clrt {

/// Parts of a triangle after so many cuts. Their numbers are the digits of their codes: part 4 i + k is the
/// k-th of the four that part i is cut into.
constexpr size_t part_count(u32 level) {
    return size_t(1) << 2 * level;
}

/// A part's place: the barycentric weights of corners 1 and 2 of the triangle at a point of it are
/// origin + step b, b those of the part.
struct PartPlace {
    glm::dvec2 origin{0};
    double step = 1;

    glm::dvec2 at(const glm::dvec2& b) const { return origin + step * b; }
    glm::dvec2 centre() const { return at(glm::dvec2(1.0 / 3)); }
};

/// Where part number `index` of a level is.
PartPlace part_place(u32 level, u32 index);

/// The part of a level that a point is on.
u32 part_at(u32 level, glm::dvec2 weights);

/// The record of a part of a triangle that has so many.
EmitterPart emitter_part(u32 level, u32 index, u32 parts);

/// Where an emitter is on its triangle.
PartPlace emitter_place(const Scene& scene, u32 emitter);

/// Corners of an emitter, of the whole triangle or a part of it, normalised frame.
std::array<glm::dvec3, 3> emitter_corners(const Scene& scene, u32 emitter);

/// Its area.
double emitter_area(const Scene& scene, u32 emitter);

} // namespace clrt
