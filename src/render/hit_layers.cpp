// SPDX-License-Identifier: Apache-2.0
#include "render/hit_layers.h"

#include "console/signals.h"
#include "device/opencl_error.h"
#include "render/tile_pixels.h"

#include <algorithm>
#include <chrono>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

/// A launch's sums take no more than this: 12000 tiles, as many as keep any device busy.
constexpr size_t LARGEST_BUFFER_BYTES = size_t(64) << 20;
constexpr size_t TILE_VALUES = size_t(AOV_SUMS) * TILE_PIXELS, TILE_WORDS = size_t(AOV_WORDS) * TILE_PIXELS;
constexpr size_t TILE_BYTES = TILE_VALUES * sizeof(std::int64_t) + TILE_WORDS * sizeof(u32);

/// Samples that the tiles of a half still lack, on the average tile and at most.
struct Lag {
    double mean = 0;
    u32 most = 0;
};

Lag lag_of(const std::vector<u32>& from, const std::vector<u32>& to) {
    Lag lag;
    for (size_t tile = 0; tile < to.size(); ++tile) {
        lag.mean += double(to[tile] - from[tile]) / double(to.size());
        lag.most = std::max(lag.most, to[tile] - from[tile]);
    }
    return lag;
}

/// At most `step` samples further.
std::vector<u32> step_towards(const std::vector<u32>& from, const std::vector<u32>& to, u32 step) {
    std::vector<u32> next(to.size());
    for (size_t tile = 0; tile < to.size(); ++tile)
        next[tile] = std::min(to[tile], from[tile] + step);
    return next;
}

} // namespace

HitLayers::HitLayers(const Device& device, const Program& program, const RenderParams& params, bool by_halves,
                     const SceneBuffers& scene, FilmBuffers& film_buffers, HitSums& sums, bool has_mattes)
    : device_(device), params_(params), film_buffers_(film_buffers), sums_(sums),
      launcher_(device, program, "render_aov", params, scene), launch_size_(device.info.compute_units),
      largest_launch_(u32(std::min<size_t>(params.tile_count, LARGEST_BUFFER_BYTES / TILE_BYTES))),
      has_mattes_(has_mattes) {
    const size_t pixels = size_t(params.crop_width) * params.crop_height;
    for (size_t half = 0; half < (by_halves ? 2 : 1); ++half) {
        sums_.values[half].resize(AOV_SUMS * pixels);
        sums_.words[half].resize(AOV_WORDS * pixels);
        if (has_mattes)
            sums_.mattes[half].resize(MATTE_WORDS * pixels);
    }
    make_buffers();
    read_values_.resize(TILE_VALUES * largest_launch_);
    read_words_.resize(TILE_WORDS * largest_launch_);
    // A launch without samples makes the driver finish its compilation.
    film_buffers_.bind_ranges(launcher_.kernel());
    launcher_.run(0, 0, 0, 0);
}

HitLayers::HitLayers(const PreparedScene& prepared, const RenderParams& params, FilmBuffers& film_buffers,
                     HitSums& sums)
    : HitLayers(prepared.device, *prepared.programs->layers, params,
                is_adaptive(prepared.planned->options) || prepared.planned->options.denoise.denoiser,
                prepared.buffers, film_buffers, sums, wants_mattes(prepared.planned->options)) {
    sums.most_samples = most_hit_samples(prepared.planned->options);
}

/// Halves the buffers until they fit.
void HitLayers::make_buffers() {
    for (;; largest_launch_ /= 2)
        try {
            values_ =
                create_buffer(device_, "hit_sums", TILE_VALUES * largest_launch_ * sizeof(std::int64_t));
            words_ = create_buffer(device_, "hit_words", TILE_WORDS * largest_launch_ * sizeof(u32));
            if (has_mattes_)
                mattes_.emplace(device_, params_, largest_launch_);
            break;
        } catch (const DeviceError&) {
            values_ = words_ = {};
            mattes_.reset();
            if (largest_launch_ <= 1)
                throw;
        }
    launcher_.kernel().set("hit_sums", values_);
    launcher_.kernel().set("hit_words", words_);
    if (mattes_)
        mattes_->bind(launcher_.kernel());
}

void HitLayers::advance(const Film& film, const std::function<void(double)>& report) {
    is_adaptive(film) ? advance_tiles(film, report) : advance_equally(film, report);
}

/// Goes through the film's ranges in order, from the sample where the sums end.
void HitLayers::advance_equally(const Film& film, const std::function<void(double)>& report) {
    const std::uint64_t all = wanted_hit_samples(sums_, film);
    std::uint64_t before = 0; // samples of the ranges before
    for (const SampleRange& range : film.ranges) {
        const std::uint64_t length = std::min<std::uint64_t>(range.end - range.first, all - before);
        while (sums_.samples < before + length) {
            const u32 fitting = launch_size_.samples(params_.tile_count);
            if (stop_signal() && sums_.samples > 0 && all - sums_.samples > fitting)
                return;
            const u32 count = u32(std::min<std::uint64_t>(before + length - sums_.samples, fitting));
            const u32 first = u32(range.first + (sums_.samples - before));
            if (sums_.halves() == 2)
                advance_halves(first, std::uint64_t(first) + count);
            else
                run_tiles(0, count, [&](u32 tile, u32 end) { launcher_.run(first, count, tile, end); });
            sums_.samples += count;
            report(double(sums_.samples) / double(all));
        }
        before += length;
    }
}

/// Adds samples [first, end) to the sums of the halves that they belong to.
void HitLayers::advance_halves(std::uint64_t first, std::uint64_t end) {
    const size_t tiles = size_t((params_.crop_width + ADAPTIVE_TILE_SIZE - 1) / ADAPTIVE_TILE_SIZE) *
                         ((params_.crop_height + ADAPTIVE_TILE_SIZE - 1) / ADAPTIVE_TILE_SIZE);
    for (size_t half = 0; half < 2; ++half) {
        const u32 from = u32(samples_of_half_below(first, int(params_.replicates), half));
        const u32 to = u32(samples_of_half_below(end, int(params_.replicates), half));
        film_buffers_.write_tile_ranges(std::vector<u32>(tiles, from), std::vector<u32>(tiles, to));
        if (to > from)
            run_tiles(half, to - from,
                      [&](u32 tile, u32 tiles_end) { launcher_.run_half(int(half), tile, tiles_end); });
        sums_.samples_of_half[half] += to - from;
    }
}

/// Takes the tiles of both halves to where the film's are.
void HitLayers::advance_tiles(const Film& film, const std::function<void(double)>& report) {
    const TileSamples wanted = wanted_hit_tiles(sums_, film);
    for (size_t half = 0; half < 2; ++half) {
        std::vector<u32>& from = sums_.tile_samples[half];
        const std::vector<u32>& to = wanted[half];
        from.resize(to.size());
        const double all = lag_of(from, to).mean;
        for (Lag lag = lag_of(from, to); lag.most > 0; lag = lag_of(from, to)) {
            const u32 fitting = launch_size_.samples(params_.tile_count);
            if (stop_signal() && lag.most > fitting && *std::min_element(from.begin(), from.end()) > 0)
                break;
            const std::vector<u32> next = step_towards(from, to, fitting);
            film_buffers_.write_tile_ranges(from, next);
            run_tiles(half, lag_of(from, next).mean,
                      [&](u32 tile, u32 end) { launcher_.run_half(int(half), tile, end); });
            from = next;
            report(0.5 * (double(half) + 1 - lag_of(from, to).mean / all));
        }
    }
}

/// Calls launch(first tile, end of tiles) for all tiles, as many at once as take LAUNCH_SECONDS for so many
/// samples, and adds what each launch gives to a half's sums.
template <class Launch>
void HitLayers::run_tiles(size_t half, double samples, Launch&& launch) {
    for (u32 tile = 0; tile < params_.tile_count;) {
        const u32 end =
            tile + std::min(largest_launch_, launch_size_.tiles(samples, params_.tile_count - tile));
        if (mattes_)
            mattes_->write(sums_.mattes[half], tile, end);
        const auto start = Clock::now();
        launch(tile, end);
        launch_size_.took(end - tile, samples, std::chrono::duration<double>(Clock::now() - start).count());
        add_launch(half, tile, end);
        tile = end;
    }
}

/// Reads the sums of a launch.
void HitLayers::add_launch(size_t half, u32 first_tile, u32 end_tile) {
    const size_t tiles = end_tile - first_tile;
    check_opencl("reading the layers back", [&] {
        device_.queue.enqueueReadBuffer(values_, CL_TRUE, 0, tiles * TILE_VALUES * sizeof(std::int64_t),
                                        read_values_.data());
        device_.queue.enqueueReadBuffer(words_, CL_TRUE, 0, tiles * TILE_WORDS * sizeof(u32),
                                        read_words_.data());
    });
    for_tile_pixels(params_, first_tile, end_tile, [&](size_t slot, size_t pixel) {
        const u32* words = &read_words_[slot * AOV_WORDS];
        if (words[AOV_HITS] == 0)
            return;
        u32* sum_words = &sums_.words[half][pixel * AOV_WORDS];
        if (sum_words[AOV_HITS] == 0)
            std::copy_n(words, AOV_WORDS, sum_words);
        else
            sum_words[AOV_HITS] += words[AOV_HITS];
        for (size_t k = 0; k < AOV_SUMS; ++k)
            sums_.values[half][pixel * AOV_SUMS + k] += read_values_[slot * AOV_SUMS + k];
    });
    if (mattes_)
        mattes_->read(sums_.mattes[half], first_tile, end_tile);
}

} // namespace clrt
