// SPDX-License-Identifier: Apache-2.0
#include "scene/sky_table.h"

#include "colour.h"
#include "scene/alias_table.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// A map whose bright texels exceed its mean by less than this share of its light is constant: more is not
/// rounding.
constexpr double SMALLEST_EXCESS = 1e-6;

double luminance_at(const Environment& sky, int x, int y) {
    return luminance(to_dvec3(sky.texels[size_t(y) * size_t(sky.width) + size_t(x)].radiance));
}

/// MIS compensation of weights that are luminance times solid angle and add up to `sum`: leaves of each what
/// exceeds the mean over the sphere, and returns what share of all that is. Where next to nothing does, they
/// stay as they are.
double keep_above_mean(std::vector<double>& weights, int width, int height, double sum) {
    const auto above_mean = [&](int x, int y) {
        const double share = texel_solid_angle(y, width, height) / (4 * PI);
        return std::fmax(weights[size_t(y) * size_t(width) + size_t(x)] - sum * share, 0.0);
    };
    double excess = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            excess += above_mean(x, y);
    if (!(excess > SMALLEST_EXCESS * sum))
        return 1;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            weights[size_t(y) * size_t(width) + size_t(x)] = above_mean(x, y);
    return excess / sum;
}

} // namespace

std::vector<double> cell_luminance(const Environment& sky) {
    const int width = sky.width, height = sky.height;
    std::vector<double> result(sky.texels.size());
    tbb::parallel_for(0, height, [&](int y) {
        // Over its own cell a bilinear tent has the mean 6/8, over each neighbour's 1/8.
        const int rows[3] = {std::max(y - 1, 0), y, std::min(y + 1, height - 1)};
        std::vector<double> column(static_cast<size_t>(width));
        for (int x = 0; x < width; ++x)
            column[size_t(x)] = 0.125 * luminance_at(sky, x, rows[0]) + 0.75 * luminance_at(sky, x, rows[1]) +
                                0.125 * luminance_at(sky, x, rows[2]);
        for (int x = 0; x < width; ++x) {
            const double left = column[size_t(x == 0 ? width - 1 : x - 1)];
            const double right = column[size_t(x == width - 1 ? 0 : x + 1)];
            result[size_t(y) * size_t(width) + size_t(x)] =
                0.125 * left + 0.75 * column[size_t(x)] + 0.125 * right;
        }
    });
    return result;
}

double texel_solid_angle(int row, int width, int height) {
    // cos a - cos b = 2 sin((a+b)/2) sin((b-a)/2): no cancellation at the poles.
    const double middle = PI * (row + 0.5) / height, half = 0.5 * PI / height;
    return 2 * PI / width * 2 * std::sin(middle) * std::sin(half);
}

std::vector<double> texel_weights(const Environment& sky) {
    std::vector<double> weights = cell_luminance(sky);
    for (int y = 0; y < sky.height; ++y) {
        const double solid_angle = texel_solid_angle(y, sky.width, sky.height);
        for (int x = 0; x < sky.width; ++x)
            weights[size_t(y) * size_t(sky.width) + size_t(x)] *= solid_angle;
    }
    return weights;
}

void tabulate_sky(Environment& sky, SkySampling sampling) {
    if (sky.texels.empty() || sky.sampling == sampling)
        return;
    std::vector<double> weights = texel_weights(sky);
    sky.tabulated_share = 1;
    if (sampling == SkySampling::BY_TABLE_AND_BSDF)
        sky.tabulated_share = keep_above_mean(weights, sky.width, sky.height,
                                              std::accumulate(weights.begin(), weights.end(), 0.0));
    const AliasTable table = build_alias_table(weights);
    tbb::parallel_for(size_t(0), sky.texels.size(), [&](size_t i) {
        TEXEL_PROBABILITY(sky.texels[i]) = float(table.probability[i]);
        sky.texels[i].alias = table.entries[i].alias;
        sky.texels[i].threshold = table.entries[i].threshold;
    });
    sky.sampling = sampling;
}

} // namespace clrt
