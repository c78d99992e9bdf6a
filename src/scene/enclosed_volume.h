// SPDX-License-Identifier: Apache-2.0
// Whether surfaces are closed, and which side of them is inside.
#pragma once

#include "scene/triangle_corners.h"

#include <glm/geometric.hpp>

namespace clrt {

/// What triangles enclose, by Gauss's theorem: the vectors of the areas of closed surfaces add up to nothing,
/// and the volume that they bound is negative where their fronts are inside.
class EnclosedVolume {
public:
    void add(const TriangleCorners& c) {
        const glm::dvec3 across = glm::cross(c.p[1] - c.p[0], c.p[2] - c.p[0]);
        volume_ += glm::dot(c.p[0], across);
        area_ += glm::length(across);
        sum_ += across;
    }

    bool is_closed() const { return glm::length(sum_) < OPEN_SHARE * area_; }
    bool is_inside_out() const { return is_closed() && volume_ < 0; }

private:
    /// Of their area: what closed surfaces may lack.
    static constexpr double OPEN_SHARE = 1e-3;

    double volume_ = 0, area_ = 0; ///< six times, twice
    glm::dvec3 sum_{0};
};

} // namespace clrt
