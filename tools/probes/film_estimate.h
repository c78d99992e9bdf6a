// SPDX-License-Identifier: Apache-2.0
// What a film says about a number.
#pragma once

#include "film/film.h"
#include "options/options.h"

#include <glm/vec3.hpp>

namespace clrt {

/// A mean and its standard error from the spread of the replicates.
struct Estimate {
    double mean = 0, error = 0;
};

/// Mean of a channel over a window of pixels of the film (counted from the film's own corner).
Estimate film_estimate(const Film& film, int channel, const Crop& window);

/// The same over all pixels.
Estimate film_estimate(const Film& film, int channel = 0);

/// The radiance of a pixel, rgb.
glm::dvec3 film_pixel(const Film& film, int x, int y);

/// Relative error that single precision may add to a picture whatever its noise: a few tens of roundings.
constexpr double RENDER_ROUNDING = 4e-6;

/// Standard errors that a right picture may be off. With 64 replicates the chance is about 1e-7 a comparison.
constexpr double LARGEST_Z = 6;

} // namespace clrt
