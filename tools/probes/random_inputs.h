// SPDX-License-Identifier: Apache-2.0
// Inputs for tests: random numbers with a fixed seed, directions, and conversions to the kernels' vectors.
#pragma once

#include "kernels/shared/types.h"
#include "probes/closed_forms.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <random>

namespace clrt {

/// u of a float: half a unit in the last place of 1.
constexpr double FLOAT_U = 5.9604644775390625e-8;

inline float bits_to_float(u32 bits) {
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

inline u32 float_to_bits(float value) {
    u32 bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

/// The unit direction at polar angle acos(z) and azimuth phi around +z.
inline glm::dvec3 direction_at(double z, double phi) {
    const double r = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Random inputs; the same seed gives the same values everywhere (no library distributions).
class Random {
public:
    explicit Random(u32 seed) : engine_(seed) {}

    u32 word() { return u32(engine_()); }
    /// In (0, 1), on the lattice of the kernels' numbers: odd multiples of 2^-24.
    double unit() { return double((word() >> 8) | 1u) * FLOAT_U; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    /// Of random sign, its logarithm uniform between those of the bounds.
    double signed_log(double low, double high) {
        const double size = std::exp(between(std::log(low), std::log(high)));
        return word() & 1u ? size : -size;
    }
    /// Uniform on the unit sphere.
    glm::dvec3 direction() {
        const double z = between(-1, 1);
        return direction_at(z, 2 * PI * unit());
    }
    /// Uniform on the hemisphere around +z.
    glm::dvec3 upper_direction() {
        const double z = unit();
        return direction_at(z, 2 * PI * unit());
    }
    glm::dvec3 in_cube(double half_size) {
        const double x = between(-half_size, half_size), y = between(-half_size, half_size);
        return {x, y, between(-half_size, half_size)};
    }

private:
    std::mt19937 engine_;
};

} // namespace clrt
