// SPDX-License-Identifier: Apache-2.0
#include "render/render_params.h"

#include "options/summed_layers.h"
#include "scene/camera_params.h"
#include "scene/casters.h"
#include "scene/light_tables.h"
#include "scene/slabs.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <stdexcept>

namespace clrt {

namespace {

/// No path is as long.
constexpr u32 NO_ROULETTE = UINT32_MAX;
constexpr double RADIANS = 3.14159265358979323846 / 180;

void set_lights(const Scene& scene, LightSampler sampler, RenderParams& params) {
    const Environment& sky = scene.environment;
    params.environment = to_vec4(sky.radiance);
    LIGHT_TREE_IS_USED(params) = scene.light_tree.nodes.empty() ? 0 : 1;
    if (scene.background) {
        params.background = to_vec4(*scene.background);
        BACKGROUND_IS_SEEN(params) = 1;
    }
    params.environment_width = sky.texels.empty() ? 0 : u32(sky.width);
    params.environment_format = sky.texel_format;
    params.environment_height = sky.texels.empty() ? 0 : u32(sky.height);
    params.environment_cos = float(std::cos(sky.rotation_degrees * RADIANS));
    params.environment_sin = float(std::sin(sky.rotation_degrees * RADIANS));
    params.portal_count = u32(sky.portals.size());
    params.portal_share = float(sky.portal_share);
    params.emitter_count = u32(scene.emitters.size());
    params.light_count = u32(scene.lights.size());
    const KindShares shares = kind_shares(sampler, scene);
    params.choose_emitter = float(shares.emitters);
    params.choose_environment = float(shares.environment);
    params.choose_light = float(shares.lights);
}

/// Where light paths start.
void set_emission(const Scene& scene, Connections connections, RenderParams& params) {
    const EmissionPlan plan = plan_emission(scene, connections == Connections::NO_LIGHT);
    params.emit_emitter = float(plan.kinds.emitters);
    params.emit_environment = float(plan.kinds.environment);
    params.emit_light = float(plan.kinds.lights);
    params.emission_radius = float(emission_radius(scene));
    params.caster_count = u32(scene.casters.size());
    const double paths = plan.aimed * params.width * params.height;
    params.light_path_count = std::max(1u, u32(std::lround(paths)));
    params.caster_squares = float(caster_squares(scene.casters));
}

/// A stride near the golden section of the tile count that has no factor in common with it.
u32 tile_stride(u32 tiles) {
    u32 stride = u32(0.6180339887 * tiles) | 1u;
    while (std::gcd(stride, tiles) != 1)
        ++stride;
    return stride;
}

void set_window(const Options& options, RenderParams& params) {
    const Crop window = render_window(options.film);
    params.width = u32(options.film.size.x);
    params.height = u32(options.film.size.y);
    params.crop_x = u32(window.x0);
    params.crop_y = u32(window.y0);
    params.crop_width = u32(window.x1 - window.x0);
    params.crop_height = u32(window.y1 - window.y0);
    params.tiles_x = (params.crop_width + TILE_SIZE - 1) / TILE_SIZE;
    params.tile_count = params.tiles_x * ((params.crop_height + TILE_SIZE - 1) / TILE_SIZE);
    params.tile_stride = tile_stride(params.tile_count);
}

void set_filter(const Options& options, RenderParams& params) {
    switch (options.film.filter) {
    case Filter::BOX:
        params.filter = FILTER_BOX;
        params.filter_radius = float(options.film.filter_radius.value_or(0.5));
        break;
    case Filter::TENT:
        params.filter = FILTER_TENT;
        params.filter_radius = float(options.film.filter_radius.value_or(1.0));
        break;
    case Filter::GAUSSIAN:
        params.filter = FILTER_GAUSSIAN;
        params.filter_radius = float(options.film.filter_radius.value_or(1.5));
        break;
    }
}

/// Whether the environment map has a table for an integrator: that of the radiance is one for all of them.
bool fits(const Environment& sky, const IntegratorRow& integrator) {
    return sky.sampling == SkySampling::BY_TABLE || (sky.sampling && integrator.sky != SkySampling::BY_TABLE);
}

/// The logarithm of the power of two that is at most so many light samples.
u32 light_samples_log(int samples) {
    u32 log = 0;
    while ((2 << log) <= std::min(samples, MOST_LIGHT_SAMPLES))
        ++log;
    return log;
}

/// Whether camera rays for emission may go on at mirrors and smooth glass: where a path that meets emission
/// behind them does not tell what it has met, by an integrator that sees into them.
bool mirrors_show_emission(const Options& options) {
    return takes_option(options.transport.integrator, TAKES_EMISSION_RAYS) &&
           integrator_row(options.transport.integrator).connections == Connections::ONE_LIGHT &&
           options.transport.paths.empty() && summed_layers(options).empty();
}

u32 path_choices(const Scene& scene, const Options& options) {
    return (options.transport.path_reuse == Toggle::ON ? PATHS_ARE_SHARED : 0) |
           (crosses_slabs(scene, options) ? SLABS_ARE_CROSSED : 0) |
           (mirrors_show_emission(options) ? MIRRORS_SHOW_EMISSION : 0) |
           light_samples_log(light_samples(scene, options)) << LIGHT_SAMPLES_SHIFT |
           (takes_option(options.transport.integrator, TAKES_EMISSION_RAYS)
                ? u32(options.transport.emission_rays) << EMISSION_RAYS_SHIFT
                : 0);
}

} // namespace

Crop render_window(const FilmOptions& film) {
    return film.crop.value_or(Crop{0, 0, film.size.x, film.size.y});
}

bool crosses_slabs(const Scene& scene, const Options& options) {
    return connects_through_slabs(options.transport.integrator) && options.transport.paths.empty() &&
           options.output.path_layers.empty() && has_slabs_before_the_sky(scene);
}

int light_samples(const Scene& scene, const Options& options) {
    const bool can =
        takes_option(options.transport.integrator, TAKES_LIGHT_SAMPLES) && !scene.light_tree.nodes.empty();
    return can ? std::max(options.transport.light_samples, 1) : 1;
}

RenderParams make_render_params(const Scene& scene, const Options& options, const FilmScale& scale) {
    if (!scene.environment.texels.empty() &&
        !fits(scene.environment, integrator_row(options.transport.integrator)))
        throw std::logic_error("the environment map has no table for this integrator: tabulate_sky");
    RenderParams params{};
    params.camera = make_camera_params(scene.camera, scene.normalisation, options.film.size);
    set_lights(scene, options.sampling.light_sampler, params);
    const IntegratorRow& integrator = integrator_row(options.transport.integrator);
    set_window(options, params);
    if (integrator.film == FilmAccess::SPLAT)
        set_emission(scene, integrator.connections, params);
    set_filter(options, params);
    params.seed = options.sampling.seed;
    params.replicates = u32(options.sampling.replicates);
    params.dealt_replicates = u32(options.sampling.replicates);
    params.film_replicates = u32(options.sampling.replicates);
    params.max_depth = u32(effective_max_depth(options.transport));
    params.min_contribution = float(options.transport.min_contribution);
    params.roulette_depth =
        integrator.takes & TAKES_ROULETTE_DEPTH ? u32(options.transport.roulette_depth) : NO_ROULETTE;
    params.texture_filter =
        options.scene.texture_filter == TextureFilter::FOOTPRINT && (integrator.takes & TAKES_TEXTURE_FILTER);
    params.path_choices = path_choices(scene, options);
    params.shadow_rays = u32(options.transport.shadow_rays);
    params.gloss_rays = u32(options.transport.gloss_rays);
    params.translucent_rays = u32(options.transport.translucent_rays);
    params.scene_extent = std::max(scene.extent, scene.ground_extent);
    params.quantum = float(scale.quantum);
    params.inverse_quantum = float(1 / scale.quantum);
    params.largest_contribution = float(std::min(scale.largest, double(FLT_MAX)));
    return params;
}

void restrict_to_paths(const PathPlan& paths, RenderParams& params) {
    if (paths.segments)
        params.max_depth = std::min(params.max_depth, u32(*paths.segments));
    const unsigned kinds = accepted_kinds(paths);
    if (!(kinds & KIND_AREA))
        params.choose_emitter = 0.0f;
    if (!(kinds & KIND_SKY))
        params.choose_environment = 0.0f;
    if (!(kinds & (KIND_POINT | KIND_SUN)))
        params.choose_light = 0.0f;
    const float sum = params.choose_emitter + params.choose_environment + params.choose_light;
    if (paths.is_filter && sum > 0.0f) {
        params.choose_emitter /= sum;
        params.choose_environment /= sum;
        params.choose_light /= sum;
    }
}

} // namespace clrt
