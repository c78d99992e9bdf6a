// SPDX-License-Identifier: Apache-2.0
#include "effects/planned_scene.h"

#include "effects/take_out.h"
#include "scene/light_tables.h"
#include "scene/light_tree.h"
#include "scene/sky_table.h"

#include <utility>

namespace clrt {

std::shared_ptr<PlannedScene> plan_scene(Scene scene, Options options) {
    auto planned = std::make_shared<PlannedScene>();
    planned->scene = std::move(scene);
    planned->options = std::move(options);
    tabulate_sky(planned->scene.environment, integrator_row(planned->options.transport.integrator).sky);
    planned->effects = find_effects(planned->scene, planned->options);
    if (planned->effects.left_out) {
        take_out_effects(planned->effects.left_out, planned->scene, planned->options);
        planned->effects.paths = plan_paths(planned->scene, planned->options);
    }
    tabulate_lights(planned->options.sampling.light_sampler, planned->scene);
    if (planned->effects.needed & ~planned->effects.left_out & EFFECT_LIGHT_TREE)
        planned->scene.light_tree =
            build_light_tree(planned->scene, accepted_kinds(planned->effects.paths) &
                                                 light_tree_kinds(planned->options.transport.integrator));
    return planned;
}

} // namespace clrt
