// SPDX-License-Identifier: Apache-2.0
#include "scene/placed_box.h"

#include "scene/vectors.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

namespace clrt {

glm::dvec3 placed(const Instance& instance, const glm::dvec3& p) {
    glm::dvec3 result;
    for (int axis = 0; axis < 3; ++axis) {
        const vec4& row = instance.to_world[axis];
        result[axis] = glm::dot(to_dvec3(row), p) + double(row.w);
    }
    return result;
}

std::array<glm::dvec3, 8> PlacedBox::corners_in(const Instance& instance) const {
    std::array<glm::dvec3, 8> corners;
    for (size_t i = 0; i < 8; ++i)
        corners[i] =
            placed(instance, {i & 1 ? bounds.high.x : bounds.low.x, i & 2 ? bounds.high.y : bounds.low.y,
                              i & 4 ? bounds.high.z : bounds.low.z});
    return corners;
}

double PlacedBox::squared_distance_in(const Instance& instance, const glm::dvec3& p) const {
    const std::array<glm::dvec3, 8> corners = corners_in(instance);
    glm::dvec3 low = corners[0], high = corners[0];
    for (const glm::dvec3& corner : corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const glm::dvec3 way = p - glm::clamp(p, low, high);
    return glm::dot(way, way);
}

PlacedBox box_of_prototype(const Scene& scene, const Prototype& prototype,
                           const std::function<bool(const Triangle&)>& asks) {
    const double most = std::numeric_limits<double>::max();
    PlacedBox box{{glm::dvec3(most), glm::dvec3(-most)}};
    for (u32 i = 0; i < prototype.triangle_count; ++i) {
        const Triangle& triangle = scene.triangles[prototype.first_triangle + i];
        if (asks(triangle))
            for (const u32 corner : {triangle.v0, triangle.v1, triangle.v2}) {
                box.bounds.low = glm::min(box.bounds.low, to_dvec3(scene.positions[corner]));
                box.bounds.high = glm::max(box.bounds.high, to_dvec3(scene.positions[corner]));
            }
    }
    return box;
}

} // namespace clrt
