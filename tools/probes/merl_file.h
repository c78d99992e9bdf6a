// SPDX-License-Identifier: Apache-2.0
// Files of measured BRDFs, in the form of the MERL database, of which nothing was measured.
#pragma once

#include "kernels/shared/types.h"

#include <functional>
#include <glm/vec3.hpp>
#include <string>

namespace clrt {

/// Samples of half angle, difference angle and azimuth.
struct MerlCounts {
    i32 half = 90, difference = 90, azimuth = 180;
};

/// A BRDF, per steradian, of unit directions above the surface, z along its normal.
using BrdfFunction = std::function<glm::dvec3(const glm::dvec3& wo, const glm::dvec3& wi)>;

/// The bytes of a file whose cells hold the function at their middles, and -1 where one of the directions is
/// below the horizon.
std::string merl_file(const BrdfFunction& brdf, const MerlCounts& counts = {});

/// Lambert's BRDF below a rough reflection: GGX of this alpha with Smith's uncorrelated shadowing (Walter et
/// al. 2007) and the colour `specular`, without Fresnel. Alpha 0: no reflection.
BrdfFunction matte_and_glossy(const glm::dvec3& matte, const glm::dvec3& specular = glm::dvec3(0),
                              double alpha = 0);

} // namespace clrt
