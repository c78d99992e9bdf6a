// SPDX-License-Identifier: Apache-2.0
#include "render/render.h"

#include "app/signals.h"
#include "device/opencl_error.h"
#include "error.h"
#include "render/render_params.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t DEFAULT_SPP = 64;
/// Launches aim at this long: short enough for progress, Ctrl-C and the watchdogs of display drivers.
constexpr double LAUNCH_SECONDS = 0.5;
/// Work-groups a row of the launch grid; keeps both grid dimensions below 65535 work-items, beyond which some drivers
/// compile another variant.
constexpr u32 GRID_COLUMNS = 2048;
/// Launches take multiples of this many samples where they can: kernels simulate up to four at once.
constexpr double SAMPLE_GROUP = 4;
/// Samples a pixel that the auxiliary layers average.
constexpr std::uint32_t LAYER_SAMPLES = 16;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One kernel with its parameters; launches tiles and samples of them.
class Launcher {
public:
    Launcher(const Device& device, const Program& program, const std::string& name, const RenderParams& params,
             const SceneBuffers& buffers)
        : device_(device), kernel_(program, name), params_(params) {
        bind_scene(buffers, kernel_);
    }
    Kernel& kernel() { return kernel_; }

    /// Runs `count` samples from `first` on tiles [first_tile, end_tile) and waits.
    void run(std::uint32_t first, std::uint32_t count, u32 first_tile, u32 end_tile) {
        params_.first_sample = first;
        params_.sample_count = count;
        params_.first_tile = first_tile;
        params_.end_tile = end_tile;
        kernel_.set("params", params_);
        const u32 groups = std::max(end_tile - first_tile, 1u);
        const u32 columns = std::min(groups, GRID_COLUMNS);
        const u32 rows = (groups + columns - 1) / columns;
        check_opencl("rendering", [&] {
            device_.queue.enqueueNDRangeKernel(kernel_.handle(), cl::NullRange, cl::NDRange(columns * TILE_SIZE, rows * TILE_SIZE),
                                               cl::NDRange(TILE_SIZE, TILE_SIZE));
            device_.queue.finish();
        });
    }

private:
    const Device& device_;
    Kernel kernel_;
    RenderParams params_;
};

/// Slots of the film: whole tiles.
size_t film_slots(const RenderParams& params) {
    return size_t(params.tile_count) * TILE_PIXELS;
}

/// Halves the number of replicates kept apart until their sums and those of `layers` layers fit the device.
int fitting_replicates(const Device& device, const RenderParams& params, size_t layers) {
    const size_t plane = film_slots(params) * 3 * sizeof(std::int64_t);
    const size_t most = std::min(device.info.largest_buffer_bytes, device.info.memory_bytes / 2);
    int replicates = int(params.replicates);
    while ((size_t(replicates) + layers) * plane > most && replicates % 2 == 0)
        replicates /= 2;
    if (replicates != int(params.replicates))
        spdlog::warn("the film of {} replicates does not fit the device: {} are kept apart, the error is coarser",
                     params.replicates, replicates);
    return replicates;
}

RenderCounts read_counts(const std::vector<u32>& words) {
    RenderCounts counts;
    counts.nan = words[COUNT_NAN];
    counts.infinite = words[COUNT_INFINITE];
    counts.negative = words[COUNT_NEGATIVE];
    counts.overflow = words[COUNT_OVERFLOW];
    const u32 noted = std::min<u32>(words[COUNT_BAD_SAMPLES], REPLAY_CAPACITY);
    for (u32 i = 0; i < noted; ++i)
        counts.bad_samples.emplace_back(words[COUNT_WORDS + 2 * i], words[COUNT_WORDS + 2 * i + 1]);
    return counts;
}

/// Decides how much each launch does and when to stop.
class Schedule {
public:
    Schedule(const Options& options, u32 tiles) : options_(options), tiles_(tiles) {
        const bool bounded = options.spp || options.time_seconds;
        target_ = options.spp ? *options.spp : (bounded ? UINT32_MAX - options.first_sample : DEFAULT_SPP);
    }
    std::uint64_t target() const { return target_; }

    /// Samples of the next launch on all tiles; 0 ends the render. `done` samples took `seconds`.
    std::uint32_t next_samples(std::uint64_t done, double seconds) const {
        if (done >= target_ || (done > 0 && stop_signal()))
            return 0;
        if (done == 0)
            return 1;
        const double pass = std::max(seconds / double(done), 1e-6);
        const double fitting = LAUNCH_SECONDS / pass;
        double samples = fitting <= 1 ? 1 : std::ceil(fitting / SAMPLE_GROUP) * SAMPLE_GROUP;
        // Grow slowly: the first passes may be unlike the later ones.
        samples = std::min(samples, 2.0 * double(done));
        if (options_.time_seconds) {
            const double left = *options_.time_seconds - seconds;
            if (left < 0.5 * pass)
                return 0;
            samples = std::min(samples, std::max(1.0, left / pass));
        }
        return std::uint32_t(std::min(double(target_ - done), samples));
    }

    /// Tiles of a launch when one pass takes `pass_seconds` (0: not known yet, a cautious first share).
    u32 launch_tiles(double pass_seconds) const {
        if (pass_seconds <= 0)
            return std::max(tiles_ / 16, std::min(tiles_, 64u));
        const double share = LAUNCH_SECONDS / pass_seconds;
        return share >= 1 ? tiles_ : std::max(u32(share * tiles_), 1u);
    }

    /// Progress in [0, 1] by whichever limit is nearer.
    double fraction(double done, double seconds) const {
        double fraction = done / double(target_);
        if (options_.time_seconds)
            fraction = std::max(fraction, seconds / *options_.time_seconds);
        return std::min(fraction, 1.0);
    }

private:
    const Options& options_;
    u32 tiles_;
    std::uint64_t target_ = 0;
};

/// Samples a pixel that every sum of the film can hold; a layer of paths has one for all replicates.
std::uint64_t film_capacity(const Options& options) {
    return FILM_SAMPLES_PER_REPLICATE * std::uint64_t(options.path_layers.empty() ? options.replicates : 1);
}

void check_film_capacity(const Options& options, std::uint64_t samples) {
    const std::uint64_t most = film_capacity(options);
    if (options.spp && samples > most)
        throw UsageError(fmt::format("--spp {}: the film holds at most {} samples a pixel with {}; "
                                     "render disjoint ranges with --first-sample",
                                     samples, most,
                                     options.path_layers.empty() ? fmt::format("--replicates {}", options.replicates)
                                                                 : "layers of paths"));
}

/// Runs all passes on a film buffer.
void run_passes(const Options& options, const RenderParams& params, Launcher& launcher, Progress& progress,
                Render& result) {
    const Schedule schedule(options, params.tile_count);
    const std::uint64_t most = film_capacity(options);
    const auto start = Clock::now();
    double pass_seconds = 0;
    while (result.passes < most) {
        const std::uint32_t samples = schedule.next_samples(result.passes, result.seconds);
        if (samples == 0)
            break;
        for (u32 tile = 0; tile < params.tile_count;) {
            const u32 end = std::min(params.tile_count, tile + schedule.launch_tiles(pass_seconds * samples));
            const auto launch = Clock::now();
            launcher.run(options.first_sample + std::uint32_t(result.passes), samples, tile, end);
            pass_seconds = seconds_since(launch) / samples * params.tile_count / (end - tile);
            tile = end;
            const double done = double(result.passes) + double(samples) * tile / params.tile_count;
            progress.update({"render", schedule.fraction(done, seconds_since(start)), std::uint64_t(done), -1});
        }
        result.passes += samples;
        result.seconds = seconds_since(start);
    }
    result.stop_signal = result.passes < schedule.target() ? stop_signal() : 0;
}

/// The auxiliary layers of the primary hits.
void render_layers(const Device& device, const Program& program, const SceneBuffers& buffers, const RenderParams& params,
                   const Options& options, Render& result) {
    const size_t floats = size_t(params.crop_width) * params.crop_height * HIT_LAYER_FLOATS;
    const cl::Buffer layers = create_buffer(device, "layers", floats * sizeof(float));
    Launcher launcher(device, program, "render_aov", params, buffers);
    launcher.kernel().set("layers", layers);
    result.layer_samples = std::uint32_t(std::min<std::uint64_t>(LAYER_SAMPLES, result.passes));
    launcher.run(options.first_sample, result.layer_samples, 0, params.tile_count);
    result.layers.resize(floats);
    check_opencl("reading the picture back", [&] {
        device.queue.enqueueReadBuffer(layers, CL_TRUE, 0, floats * sizeof(float), result.layers.data());
    });
}

/// The buffers that a render writes to.
struct Targets {
    cl::Buffer film, pixel_rays, counters;
};

/// `layers`: of paths; their sums lie behind the replicates'.
Targets create_targets(const Device& device, const RenderParams& params, size_t layers) {
    const size_t slots = film_slots(params);
    const size_t planes = params.film_replicates + layers;
    return {create_buffer(device, "film", slots * 3 * planes * sizeof(std::int64_t)),
            create_buffer(device, "pixel_rays", slots * PIXEL_RAYS_WORDS * sizeof(u32)),
            create_buffer(device, "counters", (COUNT_WORDS + 2 * REPLAY_CAPACITY) * sizeof(u32))};
}

template <class T>
std::vector<T> read_buffer(const Device& device, const cl::Buffer& buffer, size_t count) {
    std::vector<T> values(count);
    check_opencl("reading the picture back", [&] {
        device.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
    });
    return values;
}

/// Reads one replicate after the other, from plane `first` on, from the device's tiles into the film's rows.
void read_film(const RenderParams& params, const std::vector<std::int64_t>& tiles, size_t first, Film& film) {
    const size_t slots = film_slots(params);
    film.sums.resize(size_t(film.replicates) * film.width * film.height * 3);
    size_t out = 0;
    for (size_t r = first; r < first + size_t(film.replicates); ++r)
        for (u32 y = 0; y < params.crop_height; ++y)
            for (u32 x = 0; x < params.crop_width; ++x, out += 3) {
                const size_t tile = size_t(y / TILE_SIZE) * params.tiles_x + x / TILE_SIZE;
                const size_t slot = tile * TILE_PIXELS + (y % TILE_SIZE) * TILE_SIZE + x % TILE_SIZE;
                std::copy_n(&tiles[3 * (r * slots + slot)], 3, &film.sums[out]);
            }
}

void read_films(const Device& device, const RenderParams& params, const Targets& targets, size_t layers,
                Render& result) {
    const size_t planes = params.film_replicates + layers;
    const std::vector<std::int64_t> tiles =
        read_buffer<std::int64_t>(device, targets.film, film_slots(params) * 3 * planes);
    result.film.samples = result.passes;
    read_film(params, tiles, 0, result.film);
    Film layer = result.film;
    layer.replicates = 1;
    for (size_t i = 0; i < layers; ++i) {
        read_film(params, tiles, params.film_replicates + i, layer);
        result.path_layers.push_back(layer);
    }
}

void read_results(const Device& device, const RenderParams& params, const Targets& targets, Render& result) {
    result.counts = read_counts(read_buffer<u32>(device, targets.counters, COUNT_WORDS + 2 * REPLAY_CAPACITY));
    result.counts.primary = std::uint64_t(params.crop_width) * params.crop_height * result.passes;
    const size_t words = film_slots(params) * PIXEL_RAYS_WORDS;
    const std::vector<u32> rays = read_buffer<u32>(device, targets.pixel_rays, words);
    for (size_t i = 0; i < words; i += PIXEL_RAYS_WORDS) {
        result.counts.secondary += rays[i + PIXEL_RAYS_SECONDARY];
        result.counts.shadow += rays[i + PIXEL_RAYS_SHADOW];
    }
}

} // namespace

Render render(const Device& device, const RenderPrograms& programs, const SceneBuffers& buffers, const Scene& scene,
              const Options& options, Progress& progress) {
    check_film_capacity(options, options.spp.value_or(DEFAULT_SPP));
    Render result;
    Film& film = result.film;
    film.scale = film_scale(scene);
    RenderParams params = make_render_params(scene, options, film.scale);
    film.width = int(params.crop_width);
    film.height = int(params.crop_height);
    const size_t layers = programs.paths.layers.size();
    film.replicates = fitting_replicates(device, params, layers);
    film.first_sample = options.first_sample;
    params.film_replicates = u32(film.replicates);
    restrict_lights(programs.paths, params);

    const Targets targets = create_targets(device, params, layers);
    Launcher launcher(device, programs.picture, std::string("render_") + integrator_name(options.integrator), params,
                      buffers);
    launcher.kernel().set("film", targets.film);
    launcher.kernel().set("pixel_rays", targets.pixel_rays);
    launcher.kernel().set("counters", targets.counters);

    // A launch without samples makes the driver finish its compilation.
    progress.update({"compile", -1, 0, -1});
    const auto start = Clock::now();
    launcher.run(0, 0, 0, 0);
    result.first_launch_seconds = seconds_since(start);

    run_passes(options, params, launcher, progress, result);
    read_films(device, params, targets, layers, result);
    read_results(device, params, targets, result);
    if (programs.layers && result.passes > 0)
        render_layers(device, *programs.layers, buffers, params, options, result);
    return result;
}

Render render_nothing(const Scene& scene, const Options& options) {
    const Crop window = render_window(options);
    Render result;
    Film& film = result.film;
    film.scale = film_scale(scene);
    film.width = window.x1 - window.x0;
    film.height = window.y1 - window.y0;
    film.first_sample = options.first_sample;
    film.sums.resize(size_t(film.width) * film.height * 3);
    result.path_layers.assign(options.path_layers.size(), film);
    return result;
}

} // namespace clrt
