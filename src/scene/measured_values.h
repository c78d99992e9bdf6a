// SPDX-License-Identifier: Apache-2.0
// The numbers of a measured isotropic BRDF, and their interpolation as the kernels do it
// (kernels/scattering/bsdf_measured.h).
#pragma once

#include "kernels/shared/measured_types.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <vector>

namespace clrt {

/// A table over half angle, difference angle and the difference's azimuth, whose cells are those of
/// MeasuredBrdf.
struct MeasuredValues {
    u32 half_count = 0, difference_count = 0, azimuth_count = 0; ///< above 0
    std::vector<glm::vec3> values; ///< r, g, b per steradian, finite, not negative; the azimuth runs fastest
    size_t missing = 0;            ///< of them, above the horizon: without a measurement, and black

    /// The BRDF, per steradian, for two directions above the surface, z along its normal.
    glm::dvec3 at(const glm::dvec3& wo, const glm::dvec3& wi) const;
};

} // namespace clrt
