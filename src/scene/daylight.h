// SPDX-License-Identifier: Apache-2.0
// A clear sky with its sun, as an environment map and a light.
#pragma once

#include "options/light_options.h"
#include "scene/environment.h"

namespace clrt {

/// Light is in units of 1 / pi of the sun's irradiance above the air, luminance: a white matte surface that
/// faces the sun there has radiance 1. Times 1361 / pi it is W/m^2 of the sun's whole spectrum, times 133000
/// / pi lux.
struct Daylight {
    EnvironmentImage image; ///< lat-long about +Y; below the horizon the matte ground
    SunOptions sun;         ///< as wide as the sun is; irradiance 0: below the horizon
};

/// The direction to the sun, unit: azimuth clockwise seen from above from -z, or +y where z is up.
glm::dvec3 sun_direction(const SkyOptions& sky, const glm::dvec3& up);

/// The light of a clear sky over a scene with this up, by scene/atmosphere.h. Clouds, refraction, the sun's
/// limb and the night's light are left out.
Daylight make_daylight(const SkyOptions& sky, const glm::dvec3& up);

} // namespace clrt
