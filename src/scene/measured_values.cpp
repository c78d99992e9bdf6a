// SPDX-License-Identifier: Apache-2.0
#include "scene/measured_values.h"

#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace clrt {
namespace {

/// Two neighbouring cells of an axis and how far between their middles a coordinate is.
struct MeasuredStep {
    u32 low, high;
    double part;
};

MeasuredStep measured_step(double coordinate, u32 count) {
    const double along = std::clamp(coordinate * count - 0.5, 0.0, double(count - 1));
    const u32 low = u32(along);
    return {low, std::min(low + 1, count - 1), along - low};
}

MeasuredStep measured_step_around(double coordinate, u32 count) {
    const double along = coordinate * count - 0.5, inside = along < 0 ? along + count : along;
    const u32 low = std::min(u32(inside), count - 1);
    return {low, low + 1 == count ? 0 : low + 1, inside - low};
}

} // namespace

glm::dvec3 MeasuredValues::at(const glm::dvec3& wo, const glm::dvec3& wi) const {
    const glm::dvec3 sum = wo + wi, apart = wi - wo, h = glm::normalize(sum);
    const double sine = std::hypot(h.x, h.y);
    const glm::dvec2 along = sine > 0 ? glm::dvec2(h) / sine : glm::dvec2(1, 0);
    const double x = h.z * (along.x * apart.x + along.y * apart.y) - sine * apart.z,
                 y = along.x * apart.y - along.y * apart.x;
    const bool is_other = y < 0 || (y == 0 && x < 0);
    const double azimuth_angle = is_other ? std::atan2(-y, -x) : std::atan2(y, x);
    const MeasuredStep half = measured_step(std::sqrt(std::atan2(sine, h.z) * 2 / PI), half_count),
                       difference = measured_step(std::atan2(glm::length(apart), glm::length(sum)) * 2 / PI,
                                                  difference_count),
                       azimuth = measured_step_around(azimuth_angle / PI, azimuth_count);
    glm::dvec3 result(0);
    for (int corner = 0; corner < 4; ++corner) {
        const bool is_high_half = corner & 1, is_high_difference = corner & 2;
        const u32 i = is_high_half ? half.high : half.low;
        const u32 j = is_high_difference ? difference.high : difference.low;
        const double share = (is_high_half ? half.part : 1 - half.part) *
                             (is_high_difference ? difference.part : 1 - difference.part);
        const glm::vec3* row = &values[(size_t(i) * difference_count + j) * azimuth_count];
        result += share * glm::mix(glm::dvec3(row[azimuth.low]), glm::dvec3(row[azimuth.high]), azimuth.part);
    }
    return result;
}

} // namespace clrt
