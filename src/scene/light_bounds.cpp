// SPDX-License-Identifier: Apache-2.0
#include "scene/light_bounds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

namespace clrt {
namespace {

/// By so much a cone's cosine is lowered in every union: more than what rounding it and the axis to floats
/// takes from the cone, which near a cosine of 1 is 3e-4 of an angle.
constexpr float CONE_ROUNDING = 0x1p-22f;

struct Cone {
    glm::dvec3 axis;
    double spread; ///< half angle, radians
};

Cone cone_of(const LightBounds& bounds) {
    return {glm::dvec3(bounds.axis), std::acos(std::clamp(double(bounds.cos_spread), -1.0, 1.0))};
}

/// The narrowest cone around two.
Cone cone_around(const Cone& a, const Cone& b) {
    constexpr double PI = glm::pi<double>();
    const double between = std::acos(std::clamp(glm::dot(a.axis, b.axis), -1.0, 1.0));
    if (std::min(between + b.spread, PI) <= a.spread)
        return a;
    if (std::min(between + a.spread, PI) <= b.spread)
        return b;
    const double spread = 0.5 * (a.spread + between + b.spread);
    const glm::dvec3 across = b.axis - glm::dot(a.axis, b.axis) * a.axis;
    const double length = glm::length(across);
    if (spread >= PI || !(length > 1e-9)) // axes that are opposite lead no way round
        return {a.axis, length > 1e-9 || between > 1 ? PI : spread};
    const double turn = spread - a.spread;
    return {std::cos(turn) * a.axis + std::sin(turn) / length * across, spread};
}

} // namespace

float LightBounds::radius() const {
    return 0.5f * glm::length(high - low);
}

LightBounds united(const LightBounds& a, const LightBounds& b) {
    LightBounds sum;
    sum.low = glm::min(a.low, b.low);
    sum.high = glm::max(a.high, b.high);
    sum.power = a.power + b.power;
    sum.both_sides = a.both_sides || b.both_sides;
    Cone other = cone_of(b);
    if (b.both_sides && glm::dot(a.axis, b.axis) < 0)
        other.axis = -other.axis;
    const Cone cone = cone_around(cone_of(a), other);
    sum.axis = glm::vec3(cone.axis);
    sum.cos_spread = std::max(float(std::cos(cone.spread)) - CONE_ROUNDING, -1.0f);
    return sum;
}

void LightSpread::add(const LightBounds& bounds) {
    low_ = is_empty() ? bounds.low : glm::min(low_, bounds.low);
    high_ = is_empty() ? bounds.high : glm::max(high_, bounds.high);
    if (bounds.cos_spread > -1)
        axes_ += bounds.power * bounds.axis;
    power_ += bounds.power;
}

void LightSpread::add(const LightSpread& other) {
    if (other.is_empty())
        return;
    low_ = is_empty() ? other.low_ : glm::min(low_, other.low_);
    high_ = is_empty() ? other.high_ : glm::max(high_, other.high_);
    axes_ += other.axes_;
    power_ += other.power_;
}

float LightSpread::cost() const {
    if (is_empty())
        return 0;
    // The solid angle is pi for one normal, 4 pi for normals in all directions, whose sum vanishes; in
    // between 4 - 3 s^2, s the length of their mean, follows it within a tenth.
    const float squared = glm::dot(axes_, axes_) / (power_ * power_);
    const glm::vec3 diagonal = high_ - low_;
    return power_ * (4 - 3 * squared) * glm::dot(diagonal, diagonal);
}

} // namespace clrt
