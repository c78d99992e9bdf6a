// SPDX-License-Identifier: Apache-2.0
#include "render/metropolis.h"

#include "device/buffer_values.h"
#include "render/chain_starts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <xxhash.h>

namespace clrt {

namespace {

/// Pixels a chain of each replicate: few chains walk far, many keep a device busy (with four times as many
/// the efficiency behind a door ajar was about 0.7 times).
constexpr u32 PIXELS_PER_CHAIN = 256;
/// Chains of a replicate at most: 16384 in four keep a large device busy, and their words are 16 MB.
constexpr u32 LARGEST_CHAINS = 4096;
/// The first epoch, samples of each replicate.
constexpr std::uint64_t FIRST_EPOCH = 4;
/// New paths for each step of the epoch.
constexpr double PATHS_PER_STEP = 0.0625;
/// New paths of a replicate: fewer tell too little, more are no launch of seconds any more, and longer epochs
/// would need them.
constexpr std::uint64_t FEWEST_PATHS = 1u << 13, MOST_PATHS = 1u << 18;
/// New paths of a launch.
constexpr u32 PATHS_AT_ONCE = 1u << 16;
/// Dark tiles count as if they had this part of the picture's mean: they are found by chance alone.
constexpr double IMPORTANCE_FLOOR = 0.1;

const char* const WRITING_CHAINS = "writing chains";
const char* const READING_CHAINS = "reading chains";

std::uint64_t pixels_of(const RenderParams& params) {
    return std::uint64_t(params.crop_width) * params.crop_height;
}

u32 chains_of(const RenderParams& params) {
    return std::clamp(u32(pixels_of(params) / PIXELS_PER_CHAIN), 1u, LARGEST_CHAINS);
}

u32 lengths_of(const RenderParams& params) {
    return params.max_depth < CHAIN_SHORTEST ? 0 : params.max_depth - CHAIN_SHORTEST + 1;
}

/// New paths of each length, for an epoch of so many samples of each replicate.
u32 paths_of(const RenderParams& params, double samples) {
    const double wanted = PATHS_PER_STEP * double(pixels_of(params)) * samples;
    return u32(std::clamp(wanted, double(FEWEST_PATHS), double(MOST_PATHS)) / lengths_of(params)) + 1;
}

/// A number in [0, 1) of its own for each replicate and epoch.
double offset_of(u32 seed, u32 replicate, u32 epoch) {
    const u32 key[] = {seed, replicate, epoch};
    return std::ldexp(double(XXH3_64bits(key, sizeof key) >> 11), -53);
}

double luminance(const float* rgb) {
    return 0.2126 * double(rgb[0]) + 0.7152 * double(rgb[1]) + 0.0722 * double(rgb[2]);
}

/// Mean luminance of the film's tiles, in the order of its slots.
std::vector<double> tile_luminances(const Film& film, const RenderParams& params) {
    const std::vector<float> mean = film_mean(film);
    std::vector<double> sums(params.tile_count), pixels(params.tile_count);
    for (u32 y = 0; y < params.crop_height; ++y)
        for (u32 x = 0; x < params.crop_width; ++x) {
            const size_t tile = size_t(y / TILE_SIZE) * params.tiles_x + x / TILE_SIZE;
            sums[tile] += luminance(&mean[3 * (size_t(y) * params.crop_width + x)]);
            pixels[tile] += 1;
        }
    for (size_t i = 0; i < sums.size(); ++i)
        sums[i] /= pixels[i];
    return sums;
}

} // namespace

Metropolis::Metropolis(const PreparedScene& prepared, const RenderParams& params, const FilmBuffers& film,
                       Render& render)
    : prepared_(prepared), params_(params), film_(film), render_(render),
      kernel_(prepared.programs->picture, "render_chains") {
    const Device& device = prepared.device;
    launch_.chains = chains_of(params);
    launch_.steps = u32((pixels_of(params) + launch_.chains - 1) / launch_.chains);
    launch_.lengths = lengths_of(params);
    const size_t chains = size_t(params.replicates) * launch_.chains;
    const size_t words = CHAIN_BOUNCE_WORDS * (size_t(params.max_depth) + 1);
    const size_t paths = launch_.lengths == 0 ? 1 : size_t(paths_of(params, INFINITY)) * launch_.lengths;
    chains_ = create_buffer(device, "chains", chains * sizeof(Chain));
    words_ = create_buffer(device, "words", chains * words * sizeof(u32));
    scores_ = create_buffer(device, "scores", params.replicates * paths * sizeof(float));
    starts_ = create_buffer(device, "starts", chains * sizeof(u32));
    scales_ = create_buffer(device, "scales", params.replicates * sizeof(float));
    importance_ = create_buffer(device, "importance", params.tile_count * sizeof(float));
    bind_scene(prepared.buffers, kernel_);
    film.bind(kernel_);
    kernel_.set("chains", chains_);
    kernel_.set("words", words_);
    kernel_.set("scores", scores_);
    kernel_.set("starts", starts_);
    kernel_.set("scales", scales_);
    kernel_.set("importance", importance_);
    end_ = film_samples(render.film);
}

void Metropolis::launch(u32 task, u32 first, u32 items) {
    launch_.task = task;
    launch_.first = first;
    kernel_.set("params", params_);
    kernel_.set("launch", launch_);
    device_seconds_ +=
        run_groups(prepared_.device, kernel_, (items + TILE_PIXELS - 1) / TILE_PIXELS, "walking chains");
}

/// Paths are scored by the luminance that they add, over what the picture has there so far: dark places get
/// as many as bright ones. Before there is a picture all places are alike.
void Metropolis::write_importance(std::uint64_t samples) {
    std::vector<float> importance(params_.tile_count, 1.0f);
    if (samples > 0) {
        film_.read_sums(render_);
        const std::vector<double> tiles = tile_luminances(render_.film, params_);
        double mean = 0;
        for (const double tile : tiles)
            mean += tile / double(tiles.size());
        for (size_t i = 0; i < tiles.size() && mean > 0; ++i)
            importance[i] = float(1 / (tiles[i] / mean + IMPORTANCE_FLOOR));
    }
    write_values(prepared_.device, WRITING_CHAINS, importance_, importance);
}

void Metropolis::find_paths() {
    const u32 paths = params_.replicates * launch_.paths * launch_.lengths;
    for (u32 first = 0; first < paths; first += PATHS_AT_ONCE)
        launch(CHAIN_FIND, first, std::min(PATHS_AT_ONCE, paths - first));
}

void Metropolis::choose_starts_of_replicates() {
    const size_t paths = size_t(launch_.paths) * launch_.lengths;
    const auto scores =
        read_values<float>(prepared_.device, READING_CHAINS, scores_, 0, params_.replicates * paths);
    std::vector<u32> starts;
    std::vector<float> scales;
    for (u32 replicate = 0; replicate < params_.replicates; ++replicate) {
        const double offset = offset_of(params_.seed, replicate, launch_.epoch);
        const ChainStarts chosen = choose_starts(&scores[replicate * paths], paths, launch_.chains, offset);
        starts.insert(starts.end(), chosen.numbers.begin(), chosen.numbers.end());
        const double steps = double(launch_.steps) * double(launch_.chains);
        scales.push_back(float(chosen.sum / double(launch_.paths) * double(pixels_of(params_)) / steps));
    }
    write_values(prepared_.device, WRITING_CHAINS, starts_, starts);
    write_values(prepared_.device, WRITING_CHAINS, scales_, scales);
}

void Metropolis::advance(std::uint64_t samples, std::uint64_t next) {
    if (samples < end_ || launch_.lengths == 0)
        return;
    read_back();
    ended_ = render_.chains;
    const std::uint64_t replicates = params_.replicates;
    const double longest = double(MOST_PATHS) / PATHS_PER_STEP / double(pixels_of(params_));
    const double length = std::clamp(double(samples) / double(replicates), double(FIRST_EPOCH),
                                     std::max(std::floor(longest), double(FIRST_EPOCH)));
    end_ = samples + std::uint64_t(length) * replicates;
    launch_.epoch = u32(next);
    launch_.paths = paths_of(params_, length);
    write_importance(samples);
    find_paths();
    choose_starts_of_replicates();
    launch(CHAIN_START, 0, params_.replicates * launch_.chains);
}

void Metropolis::walk(std::uint64_t first, std::uint32_t count) {
    if (launch_.lengths == 0)
        return;
    params_.first_sample = u32(first);
    params_.sample_count = count;
    launch(CHAIN_WALK, 0, params_.replicates * launch_.chains);
}

void Metropolis::read_back() {
    render_.chains = ended_;
    const size_t chains = size_t(params_.replicates) * launch_.chains;
    for (const Chain& chain : read_values<Chain>(prepared_.device, READING_CHAINS, chains_, 0, chains)) {
        render_.chains.small += chain.steps - chain.large_steps;
        render_.chains.large += chain.large_steps;
        render_.chains.taken_small += chain.taken_small;
        render_.chains.taken_large += chain.taken_large;
    }
}

std::string chain_text(const ChainCounts& counts) {
    const auto percent = [](std::uint64_t taken, std::uint64_t proposed) {
        return 100 * double(taken) / double(std::max<std::uint64_t>(proposed, 1));
    };
    if (counts.small + counts.large == 0)
        return "";
    return fmt::format("{} steps, taken: {:.0f} % of small and {:.1f} % of large ones",
                       counts.small + counts.large, percent(counts.taken_small, counts.small),
                       percent(counts.taken_large, counts.large));
}

} // namespace clrt
