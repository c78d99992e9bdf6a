// SPDX-License-Identifier: Apache-2.0
// Means of windows, replicate by replicate.
#include "probes/film_estimate.h"

#include "probes/statistics.h"

#include <cmath>

namespace clrt {

Estimate film_estimate(const Film& film, int channel, const Crop& window) {
    const size_t width = size_t(film.width), plane = width * size_t(film.height) * 3;
    const double pixels = double(window.x1 - window.x0) * double(window.y1 - window.y0);
    std::vector<double> means;
    for (int r = 0; r < film.replicates; ++r) {
        const double samples = double(film_replicate_samples(film, r));
        if (samples == 0)
            continue;
        double sum = 0;
        for (int y = window.y0; y < window.y1; ++y)
            for (int x = window.x0; x < window.x1; ++x)
                sum += double(
                    film.sums[size_t(r) * plane + 3 * (size_t(y) * width + size_t(x)) + size_t(channel)]);
        means.push_back(sum * film.scale.quantum / (samples * pixels));
    }
    const Moments moments = moments_of(means);
    return {moments.mean, std::sqrt(moments.variance_of_mean())};
}

Estimate film_estimate(const Film& film, int channel) {
    return film_estimate(film, channel, {0, 0, film.width, film.height});
}

glm::dvec3 film_pixel(const Film& film, int x, int y) {
    glm::dvec3 rgb(0);
    const Crop pixel{x, y, x + 1, y + 1};
    for (int c = 0; c < 3; ++c)
        rgb[c] = film_estimate(film, c, pixel).mean;
    return rgb;
}

} // namespace clrt
