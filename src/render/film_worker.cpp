// SPDX-License-Identifier: Apache-2.0
#include "render/film_worker.h"

#include "options/summed_layers.h"
#include "seconds.h"

#include <algorithm>
#include <utility>

namespace clrt {

namespace {

/// Adds sums to others. One that does not fit 64 bits is full (kernels/film/sum.h).
void add_full_sums(std::vector<std::int64_t>& sums, const std::vector<std::int64_t>& others) {
    for (size_t i = 0; i < sums.size(); ++i)
        if (__builtin_add_overflow(sums[i], others[i], &sums[i]))
            sums[i] = INT64_MAX;
}

} // namespace

FilmWorker::FilmWorker(const PreparedScene& prepared, const RenderParams& params, RenderProgress& shared)
    : prepared_(prepared), shared_(shared),
      buffers_(prepared.device, params, summed_layers(prepared.planned->options).size()),
      launcher_(prepared.device, prepared.programs->picture,
                integrator_kernel(prepared.planned->options.transport.integrator), params, prepared.buffers),
      launch_size_(prepared.device.info.compute_units), tile_count_(params.tile_count) {
    buffers_.bind(launcher_.kernel());
    launcher_.run(0, 0, 0, 0);
}

bool FilmWorker::render(const SampleRange& range, const std::function<bool(double)>& goes_on) {
    const auto count = std::uint32_t(range.end - range.first);
    for (u32 tile = 0; tile < tile_count_;) {
        const u32 end = tile + launch_size_.tiles(count, tile_count_ - tile);
        const auto start = std::chrono::steady_clock::now();
        launcher_.run(std::uint32_t(range.first), count, tile, end);
        const double seconds = seconds_since(start);
        longest_launch_seconds_ = std::max(longest_launch_seconds_, seconds);
        launch_size_.took(end - tile, count, seconds);
        tile = end;
        if (!goes_on(double(tile) / tile_count_))
            return false;
    }
    return true;
}

void FilmWorker::deliver() {
    // Everything that the device may fail at comes first.
    RenderProgress own;
    own.film = film_layer(shared_.film);
    own.film.replicates = shared_.film.replicates;
    own.film.shown = shared_.film.shown;
    buffers_.read_sums(own);
    buffers_.read_shown(own.film);
    RenderCounts counts = buffers_.read_counts();
    buffers_.clear_sums();

    add_full_sums(shared_.film.sums, own.film.sums);
    for (size_t i = 0; i < own.path_layers.size(); ++i)
        add_full_sums(shared_.path_layers[i].sums, own.path_layers[i].sums);
    shared_.film.shown = std::move(own.film.shown);
    counts_ = std::move(counts);
}

} // namespace clrt
