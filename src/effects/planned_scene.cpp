// SPDX-License-Identifier: Apache-2.0
#include "effects/planned_scene.h"

#include "effects/take_out.h"
#include "scene/casters.h"
#include "scene/light_tables.h"
#include "scene/light_tree.h"
#include "scene/sky_table.h"
#include "scene/slabs.h"

#include <algorithm>
#include <fmt/format.h>
#include <utility>

namespace clrt {

namespace {

/// The paths that light paths find best, and often alone.
const char* const CAUSTICS = "L(S|G)+(D|G)E";

bool casts_caustics(const Scene& scene, Options options) {
    options.transport.paths = CAUSTICS;
    options.output.path_layers.clear();
    return has_casters(scene) && !plan_paths(scene, options).is_empty;
}

/// Without caustics light paths find nothing that others do not find with less work.
void leave_out_light_paths(Scene& scene, Options& options) {
    if (options.transport.integrator != Integrator::PATH_LIGHT)
        return;
    if (casts_caustics(scene, options))
        return;
    options.transport.integrator = Integrator::PATH;
    scene.notices.push_back(
        fmt::format("no mirror, smooth glass or sharp reflection casts light on a surface ({}): {} is {}",
                    CAUSTICS, name_of(Integrator::PATH_LIGHT), name_of(Integrator::PATH)));
}

/// Finds what casts caustics, of what is left of the scene, for those that aim light paths at it.
void aim_emission(PlannedScene& planned) {
    planned.scene.casters.clear();
    if (planned.options.transport.integrator == Integrator::PATH_LIGHT)
        planned.scene.casters = find_casters(planned.scene);
}

} // namespace

std::shared_ptr<PlannedScene> plan_scene(Scene scene, Options options) {
    auto planned = std::make_shared<PlannedScene>();
    planned->scene = std::move(scene);
    planned->options = std::move(options);
    leave_out_light_paths(planned->scene, planned->options);
    tabulate_sky(planned->scene.environment, integrator_row(planned->options.transport.integrator).sky);
    mark_slabs(planned->scene);
    planned->effects = find_effects(planned->scene, planned->options);
    if (planned->effects.left_out) {
        take_out_effects(planned->effects.left_out, planned->scene, planned->options);
        mark_slabs(planned->scene);
        planned->effects.paths = plan_paths(planned->scene, planned->options);
    }
    aim_emission(*planned);
    tabulate_lights(planned->options.sampling.light_sampler, planned->scene);
    plan_light_tree(*planned);
    return planned;
}

void plan_light_tree(PlannedScene& planned) {
    const unsigned kinds =
        accepted_kinds(planned.effects.paths) & light_tree_kinds(planned.options.transport.integrator);
    if (planned.effects.needed & ~planned.effects.left_out & EFFECT_LIGHT_TREE)
        planned.scene.light_tree = build_light_tree(planned.scene, kinds);
}

bool has_caustics(const PlannedScene& planned) {
    return casts_caustics(planned.scene, planned.options);
}

bool path_connects_to_caustics(const PlannedScene& planned) {
    const Scene& scene = planned.scene;
    const bool has_points = std::any_of(scene.lights.begin(), scene.lights.end(),
                                        [](const Light& light) { return light.kind == LIGHT_POINT; });
    return !has_points && has_slabs_before_lamps(scene) &&
           std::all_of(scene.triangles.begin(), scene.triangles.end(), [&](const Triangle& triangle) {
               const Material& material = scene.materials[triangle.material];
               return (material.flags & MATERIAL_SLAB) || !is_caster(material);
           });
}

void take_integrator(Integrator integrator, PlannedScene& planned) {
    planned.options.transport.integrator = integrator;
    tabulate_sky(planned.scene.environment, integrator_row(integrator).sky);
    planned.effects.paths = plan_paths(planned.scene, planned.options);
    aim_emission(planned);
}

} // namespace clrt
