// SPDX-License-Identifier: Apache-2.0
#include "effects/planned_scene.h"

#include "effects/take_out.h"
#include "scene/casters.h"
#include "scene/light_tables.h"
#include "scene/light_tree.h"
#include "scene/sky_table.h"

#include <fmt/format.h>
#include <utility>

namespace clrt {

namespace {

/// The paths that light paths find best, and often alone.
const char* const CAUSTICS = "LS+DE";

/// Without caustics light paths find nothing that others do not find with less work.
void leave_out_light_paths(Scene& scene, Options& options) {
    if (options.transport.integrator != Integrator::PATH_LIGHT)
        return;
    Options of_caustics = options;
    of_caustics.transport.paths = CAUSTICS;
    if (!plan_paths(scene, of_caustics).is_empty && !find_casters(scene).empty())
        return;
    options.transport.integrator = Integrator::PATH;
    scene.notices.push_back(fmt::format("no mirror or smooth glass casts light on a surface ({}): {} is {}",
                                        CAUSTICS, name_of(Integrator::PATH_LIGHT),
                                        name_of(Integrator::PATH)));
}

} // namespace

std::shared_ptr<PlannedScene> plan_scene(Scene scene, Options options) {
    auto planned = std::make_shared<PlannedScene>();
    planned->scene = std::move(scene);
    planned->options = std::move(options);
    leave_out_light_paths(planned->scene, planned->options);
    tabulate_sky(planned->scene.environment, integrator_row(planned->options.transport.integrator).sky);
    planned->effects = find_effects(planned->scene, planned->options);
    if (planned->effects.left_out) {
        take_out_effects(planned->effects.left_out, planned->scene, planned->options);
        planned->effects.paths = plan_paths(planned->scene, planned->options);
    }
    if (planned->options.transport.integrator == Integrator::PATH_LIGHT)
        planned->scene.casters = find_casters(planned->scene); // as they are left
    tabulate_lights(planned->options.sampling.light_sampler, planned->scene);
    if (planned->effects.needed & ~planned->effects.left_out & EFFECT_LIGHT_TREE)
        planned->scene.light_tree =
            build_light_tree(planned->scene, accepted_kinds(planned->effects.paths) &
                                                 light_tree_kinds(planned->options.transport.integrator));
    return planned;
}

} // namespace clrt
