// SPDX-License-Identifier: Apache-2.0
// What a node of the light tree knows of the lights below it.
#pragma once

#include <glm/vec3.hpp>

namespace clrt {

/// Box, cone of normals and power of some lights.
struct LightBounds {
    glm::vec3 low{0}, high{0};
    glm::vec3 axis{0, 0, 1}; ///< unit
    float cos_spread = -1;   ///< of the half angle of the cone around all normals; -1: they lie anywhere
    float power = 0;         ///< irradiance at normal incidence and distance 1, head-on, summed
    bool both_sides = false; ///< some light shines to both sides of its plane

    glm::vec3 centre() const { return 0.5f * (low + high); }
    /// Half the box's diagonal.
    float radius() const;
};

/// Bounds of two sets of lights together.
LightBounds united(const LightBounds& a, const LightBounds& b);

/// How much the lights of a set differ, as seen from the vertices that they light: the cost that a split
/// keeps small (Conty Estevez and Kulla 2018), summed without their cones.
class LightSpread {
public:
    void add(const LightBounds& bounds);
    void add(const LightSpread& other);
    /// Power times the solid angle into which the lights shine times the square of the box's diagonal.
    float cost() const;
    bool is_empty() const { return power_ <= 0; }

private:
    glm::vec3 low_{0}, high_{0}, axes_{0}; ///< axes times power, summed
    float power_ = 0;
};

} // namespace clrt
