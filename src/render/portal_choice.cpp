// SPDX-License-Identifier: Apache-2.0
#include "render/portal_choice.h"

#include "colour.h"
#include "console/signals.h"
#include "device/buffer_values.h"
#include "kernels/shared/escape_types.h"
#include "kernels/shared/path_types.h"
#include "render/launcher.h"
#include "render/pilot.h"
#include "render/render_params.h"
#include "render/reuse_choice.h"
#include "scene/rectified_sky.h"
#include "scene/sky_portals.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <spdlog/spdlog.h>
#include <utility>
#include <vector>

namespace clrt {

namespace {

/// Smaller frames are not worth a program more.
constexpr double FEWEST_PIXELS = 96 * 72;
/// Paths that are followed.
constexpr u32 ESCAPES = 32768;
constexpr u32 ESCAPE_SEED = 0x65736370u;

/// How many times less squared error portals must have. Light samples through them take up to twice the time
/// of a path, for all of them are weighed at each vertex, and few shadow rays end early. Where other lights
/// are sampled, too, most of that is spent anyway, but for searching a map. Pilots reuse no paths, whose
/// noise hides some of the gain.
double worthwhile_gain(bool is_map, bool is_alone) {
    return is_alone ? 2 : is_map ? 1.5 : 1.05;
}

/// How portals are used: their share of the light samples of the sky, and how much of what they let in counts
/// where a light is chosen. Others may shine in fewer places, but brightly, as the sun does.
struct PortalUse {
    double share, weight;
};

/// Those that are tried: a map with a sun wants its table, too, a constant sky has none. A tree alone asks
/// for the weight.
std::vector<PortalUse> portal_uses(bool is_map, bool has_tree) {
    std::vector<PortalUse> uses;
    for (const double share : is_map ? std::vector<double>{0.5, 0.9} : std::vector<double>{1})
        for (const double weight : has_tree ? std::vector<double>{1, 0.125} : std::vector<double>{1})
            uses.push_back({share, weight});
    return uses;
}

/// Whether the sky is a light that portals can help to find.
bool may_have_portals(const PlannedScene& planned) {
    const auto& [scene, options, effects] = planned;
    const bool shines = clrt::luminance(scene.environment.radiance) > 0;
    const Integrator integrator = options.transport.integrator;
    const bool can_sample = integrator == Integrator::PATH || integrator == Integrator::PATH_LIGHT ||
                            integrator == Integrator::BDPT;
    return shines && can_sample && !effects.paths.is_empty && (accepted_kinds(effects.paths) & KIND_SKY) &&
           options.output.path_layers.empty() &&
           double(options.film.size.x) * double(options.film.size.y) >= FEWEST_PIXELS;
}

/// Follows paths out of the scene.
std::vector<Escape> find_escapes(const PreparedScene& prepared) {
    const Device& device = prepared.device;
    const Program program = build_escape_program(prepared);
    Kernel kernel(program, "find_escapes");
    bind_scene(prepared.buffers, kernel);
    RenderParams params = launch_params(*prepared.planned);
    params.seed = ESCAPE_SEED;
    const cl::Buffer escapes = create_buffer(device, "escapes", ESCAPES * sizeof(Escape));
    kernel.set("params", params);
    kernel.set("count", ESCAPES);
    kernel.set("escapes", escapes);
    const char* const doing = "looking for ways out of the scene";
    run_groups(device, kernel, (ESCAPES + TILE_PIXELS - 1) / TILE_PIXELS, doing);
    return read_values<Escape>(device, doing, escapes, 0, ESCAPES);
}

/// Portals, and what they let in.
struct Windows {
    std::vector<SkyPortal> portals;
    SkyThroughPortals let_in;
};

/// Gives the plan portals, or none.
void set_portals(Windows windows, PlannedScene& planned) {
    Environment& sky = planned.scene.environment;
    sky.portals = std::move(windows.portals);
    sky.portal_share = 0;
    sky.let_in = windows.let_in;
    rectify_sky(sky);
    plan_light_tree(planned);
}

/// Decides between no portals and these, used in each of several ways, for path.
void decide(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts,
            Windows windows) {
    Scene& scene = planned->scene;
    Environment& sky = scene.environment;
    const PilotSize size = *sky_pilot_size(planned->options);
    const auto error_of = [&] { return path_pilot_error(prepare_path_pilot(device, planned, parts), size); };
    const bool is_map = !sky.texels.empty(), is_alone = scene.emitters.empty() && scene.lights.empty();
    const double usual = error_of(), let_in = windows.let_in.irradiance;
    double least = usual / worthwhile_gain(is_map, is_alone);
    PortalUse best{0, 0};
    const auto use = [&](PortalUse how) {
        sky.portal_share = how.share;
        sky.let_in.irradiance = let_in * how.weight;
        plan_light_tree(*planned);
    };
    set_portals(std::move(windows), *planned);
    for (const PortalUse& how : portal_uses(is_map, !scene.light_tree.nodes.empty())) {
        use(how);
        if (const double error = error_of(); error < least && !stop_signal()) {
            least = error;
            best = how;
        }
    }
    if (best.share == 0)
        return set_portals({}, *planned);
    use(best);
    spdlog::info("sky: light samples through {} window{} have {:.2f} times less squared error, by pilots of "
                 "{} x {} pixels, {} spp",
                 sky.portals.size(), sky.portals.size() == 1 ? "" : "s", usual / least, size.width,
                 size.height, size.spp);
}

/// The same where another integrator renders: all choose alike, so that it does not matter to the picture
/// whether its integrator was named or chosen (render/integrator_choice.h).
void decide_as_path(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts,
                    Windows windows) {
    const Integrator integrator = planned->options.transport.integrator;
    if (integrator == Integrator::PATH)
        return decide(device, planned, parts, std::move(windows));
    parts.programs.reset();
    take_integrator(Integrator::PATH, *planned);
    decide(device, planned, parts, std::move(windows));
    take_integrator(integrator, *planned);
    parts.programs.reset(); // path's
}

} // namespace

void choose_portals(const Device& device, const std::shared_ptr<PlannedScene>& planned, PreparedParts& parts,
                    Progress& progress) {
    if (!may_have_portals(*planned))
        return;
    progress.update({"pilot", -1, 0, -1, -1});
    const std::optional<Crop> crop = std::exchange(planned->options.film.crop, std::nullopt);
    const PreparedScene prepared = prepare_scene(device, planned, {parts.tree, nullptr});
    parts.tree = prepared.tree;
    const std::vector<Escape> escapes = find_escapes(prepared);
    Windows windows{find_portals(escapes, scene_axes(planned->scene)), {}};
    windows.let_in = light_through(windows.portals, escapes);
    if (!windows.portals.empty())
        decide_as_path(device, planned, parts, std::move(windows));
    planned->options.film.crop = crop;
    progress.finish();
}

} // namespace clrt
