// SPDX-License-Identifier: Apache-2.0
#include "render/film_worker.h"

#include "options/summed_layers.h"
#include "render/light_outlines.h"
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
    : prepared_(prepared), device_(prepared.device), shared_(shared),
      buffers_(device_, params, summed_layers(prepared.planned->options).size()),
      launcher_(device_, prepared.programs->picture,
                integrator_kernel(prepared.planned->options.transport.integrator), params, prepared.buffers),
      launch_size_(prepared.device.info.compute_units), tile_count_(params.tile_count) {
    fetched_.film = film_layer(shared.film);
    fetched_.film.replicates = shared.film.replicates;
    fetched_.film.shown.resize(shared.film.shown.size());
    buffers_.write_emission(find_light_outlines(prepared.planned->scene, params));
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

void FilmWorker::fetch() {
    buffers_.read_sums(fetched_);
    buffers_.read_shown(fetched_.film);
    fetched_.counts = buffers_.read_counts();
    buffers_.clear_sums();
}

void FilmWorker::add() {
    add_full_sums(shared_.film.sums, std::exchange(fetched_.film.sums, {}));
    for (size_t i = 0; i < fetched_.path_layers.size(); ++i)
        add_full_sums(shared_.path_layers[i].sums, fetched_.path_layers[i].sums);
    fetched_.path_layers.clear();
    for (size_t i = 0; i < fetched_.film.shown.size(); ++i)
        shared_.film.shown[i] |= fetched_.film.shown[i];
    counts_ = fetched_.counts;
}

} // namespace clrt
