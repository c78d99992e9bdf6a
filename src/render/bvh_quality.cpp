// SPDX-License-Identifier: Apache-2.0
// A rule from known quantities.
#include "render/bvh_quality.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clrt {
namespace {

// One core, meshes of 30 thousand to 1 million triangles: HIGH takes 0.6 to 0.8 microseconds a triangle
// longer, 1.2 where triangles are cut.
constexpr double EXTRA_BUILD_NS = 700;
// PoCL 3.1, rooms of which HIGH cuts no triangle: rays took -3 to 7 % less. Long thin triangles cost a fifth
// less to test.
constexpr double SAVED_SHARE = 0.02;
constexpr double MARGIN = 2;
// A ray costs more in larger trees, by levels and by cache misses: 250 ns in a closed mesh of a million.
constexpr double RAY_NS_A_LEVEL = 12;
// --error without --spp or --time: nobody knows yet, but who asks for an error asks for more than the
// default.
constexpr std::uint32_t SPP_FOR_AN_ERROR = 1024;

// Rays of a sample: to each vertex that scatters and on to a light, as long as roulette lets paths live.
double rays_per_sample(const Options& options) {
    constexpr int USUAL_VERTICES = 5;
    return 2.0 * std::clamp(effective_max_depth(options.transport) - 1, 1, USUAL_VERTICES);
}

double predicted_seconds(const Options& options, size_t triangles) {
    double pixels = double(options.film.size.x) * options.film.size.y;
    if (options.film.crop)
        pixels = double(options.film.crop->x1 - options.film.crop->x0) *
                 (options.film.crop->y1 - options.film.crop->y0);
    const double ray_ns = RAY_NS_A_LEVEL * std::log2(double(triangles) + 2);
    const double seconds =
        pixels *
        options.sampling.spp.value_or(options.sampling.has_target() ? SPP_FOR_AN_ERROR : DEFAULT_SPP) *
        rays_per_sample(options) * ray_ns * 1e-9;
    if (!options.sampling.time_seconds)
        return seconds;
    return options.sampling.spp ? std::min(seconds, *options.sampling.time_seconds)
                                : *options.sampling.time_seconds;
}

} // namespace

BvhQualityChoice choose_bvh_quality(const Options& options, size_t triangles) {
    if (options.bvh.quality)
        return {*options.bvh.quality, "as chosen"};
    const double saved = SAVED_SHARE * predicted_seconds(options, triangles);
    const double extra = double(triangles) * EXTRA_BUILD_NS * 1e-9;
    const bool pays = saved > MARGIN * extra;
    return {pays ? BvhQuality::HIGH : BvhQuality::FAST,
            fmt::format("about {:.2g} s to save, {:.2g} s to build", saved, extra)};
}

} // namespace clrt
