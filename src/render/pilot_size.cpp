// SPDX-License-Identifier: Apache-2.0
#include "render/pilot_size.h"

#include "render/render_params.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// Samples a pixel of a pilot: two a replicate, so that pixels are as small as they can be. What varies
/// within a pixel counts as noise of all integrators and hides how they differ.
constexpr std::uint32_t PILOT_SPP = 8;
/// Fewer samples of all pixels together tell nothing reliable of caustics, more tell nothing new.
constexpr double FEWEST_SAMPLES = 8192, MOST_PILOT_SAMPLES = 131072;
/// Samples of path in a second that a slow machine takes, for renders that end by time.
constexpr double SLOW_PACE = 2e5;

/// Of pilots of the sky.
constexpr double MOST_SKY_PIXELS = 512, FEWEST_SKY_PIXELS = 256;
constexpr std::uint32_t SKY_PILOT_SPP = 32;

/// At most so many pixels in the shape of a frame of `width` x `height`.
PilotSize scaled_size(double width, double height, double pixels, std::uint32_t spp) {
    const double scale = std::sqrt(pixels / (width * height));
    return {std::max(int(width * scale), 1), std::max(int(height * scale), 1), spp};
}

double window_width(const Options& options) {
    const Crop window = render_window(options.film);
    return window.x1 - window.x0;
}

double window_height(const Options& options) {
    const Crop window = render_window(options.film);
    return window.y1 - window.y0;
}

} // namespace

double expected_samples(const Options& options) {
    const SamplingOptions& sampling = options.sampling;
    const double pixels = window_width(options) * window_height(options);
    const bool is_by_time = sampling.time_seconds && !sampling.spp;
    const double samples = is_by_time ? HUGE_VAL : pixels * double(sampling.spp.value_or(DEFAULT_SPP));
    return sampling.time_seconds ? std::min(samples, SLOW_PACE * *sampling.time_seconds) : samples;
}

std::optional<PilotSize> size_of_pilots(double work, const Options& options) {
    const double samples = std::min(PILOT_SHARE / work * expected_samples(options), MOST_PILOT_SAMPLES);
    if (samples < FEWEST_SAMPLES)
        return std::nullopt;
    const double pixels = std::min(samples / PILOT_SPP, window_width(options) * window_height(options));
    return scaled_size(window_width(options), window_height(options), pixels, PILOT_SPP);
}

PilotSize in_tiles(PilotSize size) {
    const auto whole = [](int pixels) { return std::max(pixels / TILE_SIZE, 1) * TILE_SIZE; };
    return {whole(size.width), whole(size.height), size.spp, TILE_SIZE};
}

PilotSize scaled_pilot(const Options& options, double samples, std::uint32_t spp) {
    return scaled_size(window_width(options), window_height(options), samples / spp, spp);
}

std::optional<PilotSize> sky_pilot_size(const Options& options) {
    const double width = options.film.size.x, height = options.film.size.y;
    if (width * height < FEWEST_SKY_PIXELS)
        return std::nullopt;
    return scaled_size(width, height, std::min(width * height, MOST_SKY_PIXELS), SKY_PILOT_SPP);
}

} // namespace clrt
