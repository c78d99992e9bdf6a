// SPDX-License-Identifier: Apache-2.0
#include "render/pilot.h"

#include "console/signals.h"
#include "film/error_measure.h"
#include "film/film_buffers.h"
#include "kernels/shared/moment_types.h"
#include "options/summed_layers.h"
#include "render/guiding.h"
#include "render/launch_size.h"
#include "render/launcher.h"
#include "render/light_outlines.h"
#include "render/render_params.h"
#include "seconds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

namespace clrt {

namespace {

/// Of the pilot's samples, whatever --seed is: pictures of all seeds are rendered alike and can be merged,
/// and hardly any of them uses these samples again.
constexpr std::uint32_t PILOT_SEED = 0x70696c6fu;

/// Their spread is what splats and paths together scatter by; fewer samples each are no net.
constexpr int PILOT_REPLICATES = 4;

/// The options of the pilot's picture: the same view, coarser, without a pixel filter.
Options pilot_options(const Options& options, const PilotSize& size) {
    Options pilot = options;
    const Crop window = render_window(options.film);
    const double scale_x = double(size.width) / (window.x1 - window.x0);
    const double scale_y = double(size.height) / (window.y1 - window.y0);
    const auto scaled = [](int x, double scale) { return int(std::lround(x * scale)); };
    pilot.film.size = {std::max(scaled(options.film.size.x, scale_x), size.width),
                       std::max(scaled(options.film.size.y, scale_y), size.height)};
    if (options.film.crop) {
        const int x = std::min(scaled(window.x0, scale_x), pilot.film.size.x - size.width);
        const int y = std::min(scaled(window.y0, scale_y), pilot.film.size.y - size.height);
        pilot.film.crop = Crop{x, y, x + size.width, y + size.height};
    }
    pilot.film.filter = Filter::BOX;
    pilot.film.filter_radius.reset();
    pilot.sampling.seed = PILOT_SEED;
    pilot.sampling.replicates = PILOT_REPLICATES;
    return pilot;
}

/// A pilot that is done: its film, with its moments as layers, and its light paths a sample.
struct PilotRender {
    RenderProgress render;
    double light_paths = 0;
};

/// Of the sides of a pilot's patches, the share that is left out between them: samples keep to pixels
/// as large as the picture's, because what varies within larger ones, such as the edges of lamps, would count
/// as noise of all integrators and hide how they differ. Splats fall on the whole, of which they tell the
/// mean.
double patch_gap(const Options& options, const PilotSize& size) {
    const Crop window = render_window(options.film);
    return std::max(1 - double(size.width) / (window.x1 - window.x0), 0.0);
}

/// The film of a pilot before its samples, and the constants of its launch.
RenderParams begin_pilot(const PreparedScene& prepared, const PilotSize& size, Film& film) {
    const PlannedScene& planned = *prepared.planned;
    film.scale = film_scale(planned.scene);
    RenderParams params = make_render_params(planned.scene, pilot_options(planned.options, size), film.scale);
    params.patch_gap = float(patch_gap(planned.options, size));
    params.patch_last = u32(size.patch - 1);
    restrict_to_paths(planned.effects.paths, params);
    film.width = int(params.crop_width);
    film.height = int(params.crop_height);
    film.replicates = PILOT_REPLICATES;
    film.sums.resize(PILOT_REPLICATES * film_plane(film));
    film.shown.assign(film_plane(film) / 3, 0);
    return params;
}

Launcher pilot_launcher(const PreparedScene& prepared, const Program& program, const RenderParams& params) {
    return Launcher(prepared.device, program,
                    integrator_kernel(prepared.planned->options.transport.integrator), params,
                    prepared.buffers);
}

/// Renders samples from `begin` to `end` of all pixels, until a signal stops it.
void launch_samples(Launcher& launcher, const RenderParams& params, u32 begin, u32 end,
                    LaunchSize& launch_size) {
    for (u32 first = 0, tiles = 0; first < params.tile_count && !stop_signal(); first += tiles) {
        tiles = launch_size.tiles(end - begin, params.tile_count - first);
        const auto start = std::chrono::steady_clock::now();
        launcher.run(begin, end - begin, first, first + tiles);
        launch_size.took(tiles, end - begin, seconds_since(start));
    }
}

/// Renders all samples by a program, with so many layers.
void launch_pilot(const PreparedScene& prepared, const Program& program, const RenderParams& params,
                  const PilotSize& size, size_t layers, RenderProgress& render) {
    const FilmBuffers buffers(prepared.device, params, layers);
    buffers.write_emission(find_light_outlines(prepared.planned->scene, params));
    Launcher launcher = pilot_launcher(prepared, program, params);
    buffers.bind(launcher.kernel());
    LaunchSize launch_size(prepared.device.info.compute_units);
    launch_samples(launcher, params, 0, size.spp, launch_size);
    buffers.read_sums(render);
    buffers.read_shown(render.film);
    render.film.ranges = {{0, size.spp}};
    render.counts = buffers.read_counts();
    render.counts.primary = size.samples();
}

/// Layers of paths that the picture's programs sum, a pilot's own among them.
size_t layers_of(const PreparedScene& prepared) {
    return summed_layers(prepared.planned->options).size();
}

PilotRender render_pilot(const PreparedScene& prepared, const PilotSize& size) {
    PilotRender pilot;
    RenderProgress& render = pilot.render;
    Film& film = render.film;
    const RenderParams params = begin_pilot(prepared, size, film);
    render.path_layers.assign(MOMENTS_PLANES, film_layer(film));
    for (Film& layer : render.path_layers)
        layer.sums.resize(film_plane(film));
    launch_pilot(prepared, build_pilot_program(prepared), params, size, MOMENTS_PLANES, render);
    pilot.light_paths = double(params.light_path_count) / (double(film.width) * double(film.height));
    return pilot;
}

/// Means a sample of a value of the film.
class Means {
public:
    explicit Means(const RenderProgress& render)
        : render_(render), samples_(double(film_samples(render.film))), quantum_(render.film.scale.quantum) {}
    double radiance(size_t i) const {
        double sum = 0;
        for (size_t at = i; at < render_.film.sums.size(); at += film_plane(render_.film))
            sum += double(render_.film.sums[at]);
        return sum / samples_ * quantum_;
    }
    /// Of a layer of radiance.
    double of(size_t layer, size_t i) const { return of_layer(layer, i) * quantum_; }
    double square(size_t layer, size_t i) const {
        return of_layer(layer, i) * MOMENT_UNIT * quantum_ * quantum_;
    }

private:
    double of_layer(size_t layer, size_t i) const {
        return double(render_.path_layers[layer].sums[i]) / samples_;
    }
    const RenderProgress& render_;
    double samples_, quantum_;
};

/// Mean radiance over the pixels that show the scene, and channels.
double scene_mean(const Film& film) {
    const PixelChoice choice(film, ErrorPixels::SCENE);
    const std::vector<float> picture = film_mean(film);
    double sum = 0, count = 0;
    for (size_t i = 0; i < picture.size(); ++i)
        if (choice.has(i / 3)) {
            sum += double(picture[i]);
            count += 1;
        }
    return count > 0 ? sum / count : 0;
}

/// Squared errors of a sample by a measure, over the pixels that show the scene. The integrator's are what
/// its replicates scatter by; by how much more path's would, its moments tell.
void set_errors(const RenderProgress& render, ErrorMeasure measure, PilotResult& result) {
    const Film& film = render.film;
    const PixelChoice choice(film, ErrorPixels::SCENE);
    const ErrorWeights weights(film, choice, measure);
    const Means means(render);
    const double n = double(film_samples(film));
    double more = 0, mean = 0, count = 0;
    for (size_t i = 0; i < film_plane(film); ++i) {
        if (!choice.has(i / 3))
            continue;
        // A squared mean is too large by the variance of a sample over their number. Splats are many and
        // rare: the variance of their sum is the sum of their squares.
        const double gathered = means.of(MOMENTS_GATHERED, i), radiance = means.radiance(i);
        const double with = (means.square(MOMENTS_SPLATTED, i) - gathered * gathered) * n / (n - 1);
        const double without = means.square(MOMENTS_ALONE, i) - radiance * radiance + with / n;
        more += weights.of(i) * (without - with);
        mean += radiance;
        count += 1;
    }
    const std::optional<FilmError> error = film_error(film, ErrorPixels::SCENE, measure);
    result.is_black = !error;
    if (!error)
        return;
    const double errors = error->relative_rmse * error->relative_rmse * n;
    result.mean = mean / count;
    result.own[size_t(measure)] = errors;
    result.path[size_t(measure)] = errors + more * count / (mean * mean);
}

/// The film with what only hits find behind slabs, as path finds it, of which its samples may lack nearly
/// all.
Film film_with_hidden(const RenderProgress& render) {
    Film film = render.film;
    const std::vector<std::int64_t>& hidden = render.path_layers[MOMENTS_HIDDEN].sums;
    for (size_t i = 0; i < hidden.size(); ++i)
        film.sums[i] += hidden[i];
    return film;
}

/// Squared error of a sample by what only hits find behind slabs.
double missed_error(const RenderProgress& render, const Film& film, ErrorMeasure measure) {
    const PixelChoice choice(film, ErrorPixels::SCENE);
    const ErrorWeights weights(film, choice, measure);
    const Means means(render);
    double missed = 0, mean = 0, count = 0;
    for (size_t i = 0; i < film_plane(film); ++i) {
        if (!choice.has(i / 3))
            continue;
        missed += weights.of(i) * means.square(MOMENTS_MISSED, i);
        mean += means.radiance(i) + means.of(MOMENTS_HIDDEN, i);
        count += 1;
    }
    return mean > 0 ? missed * count / (mean * mean) : 0;
}

/// Rays and light paths of a sample.
void count_rays(const PilotRender& pilot, PilotResult& result) {
    const std::vector<std::int64_t>& sums = pilot.render.path_layers[MOMENTS_RAYS].sums;
    const double samples = double(pilot.render.counts.primary);
    for (size_t i = 0; i < sums.size(); i += 3) {
        result.light_rays += double(sums[i] + sums[i + 1]) / samples;
        result.inner_rays += double(sums[i + 2]) / samples;
    }
    result.eye_rays = double(pilot.render.counts.rays()) / samples - result.light_rays - result.inner_rays;
    result.light_paths = pilot.light_paths;
}

} // namespace

double deciding_error(const SquaredErrors& errors, const Options& options) {
    const SamplingOptions& sampling = options.sampling;
    const bool is_named = sampling.has_target() || sampling.adaptive;
    return errors[size_t(is_named ? sampling.measure() : ErrorMeasure::RELATIVE)];
}

PathPilot run_path_pilot(const PreparedScene& prepared, const PilotSize& size, bool reuses_paths) {
    RenderProgress render;
    RenderParams params = begin_pilot(prepared, size, render.film);
    params.path_choices &= ~PATHS_ARE_SHARED;
    params.path_choices |= reuses_paths ? PATHS_ARE_SHARED : 0;
    launch_pilot(prepared, prepared.programs->picture, params, size, layers_of(prepared), render);
    PathPilot pilot{{HUGE_VAL, HUGE_VAL}, double(render.counts.rays()) / double(render.counts.primary)};
    if (film_error(render.film))
        for (const ErrorMeasure measure : {ErrorMeasure::MSE, ErrorMeasure::RELATIVE})
            pilot.errors[size_t(measure)] = sample_error(render.film, measure);
    pilot.trimmed = trimmed_sample_error(render.film);
    pilot.mean = scene_mean(render.film);
    return pilot;
}

GuideProgress run_guide_pilot(const PreparedScene& prepared, const PilotSize& size, double error) {
    PreparedScene teaching = prepared;
    teaching.guide = std::make_shared<GuideProgress>(untaught_guide(PILOT_REPLICATES, error));
    Render render;
    const RenderParams params = begin_pilot(prepared, size, render.film);
    const FilmBuffers buffers(prepared.device, params, layers_of(prepared));
    buffers.write_emission(find_light_outlines(prepared.planned->scene, params));
    Guiding guiding(teaching, params, buffers, render);
    LaunchSize launch_size(prepared.device.info.compute_units);
    for (u32 begin = 0; begin < size.spp && guiding.launcher() && !stop_signal();) {
        const u32 end = u32(std::min<std::uint64_t>(guiding.end(), size.spp));
        launch_samples(*guiding.launcher(), params, begin, end, launch_size);
        buffers.read_shown(render.film);
        render.film.ranges = {{0, end}};
        render.counts = buffers.read_counts();
        render.counts.primary = std::uint64_t(size.width) * std::uint64_t(size.height) * end;
        guiding.advance(end, render.counts);
        begin = end;
    }
    return render.guide;
}

double path_pilot_error(const PreparedScene& prepared, const PilotSize& size) {
    return run_path_pilot(prepared, size).errors[size_t(ErrorMeasure::RELATIVE)];
}

PilotResult run_pilot(const PreparedScene& prepared, const PilotSize& size) {
    const PilotRender pilot = render_pilot(prepared, size);
    const RenderProgress& render = pilot.render;
    const Film with_hidden = film_with_hidden(render);
    PilotResult result;
    for (const ErrorMeasure measure : {ErrorMeasure::MSE, ErrorMeasure::RELATIVE}) {
        set_errors(render, measure, result);
        double& own = result.own[size_t(measure)];
        own = std::max(own, missed_error(render, with_hidden, measure));
    }
    result.trimmed = trimmed_sample_error(render.film);
    count_rays(pilot, result);
    return result;
}

} // namespace clrt
