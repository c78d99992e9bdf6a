// SPDX-License-Identifier: Apache-2.0
// A scene as it is to be rendered: effects proved, what is not wanted taken out, paths planned. No device is
// needed.
#pragma once

#include "effects/effects.h"
#include "options/options.h"
#include "scene/scene.h"

#include <memory>

namespace clrt {

/// What a scene and its options come to. Several prepared scenes may share one (render/prepared_scene.h).
struct PlannedScene {
    Scene scene;     ///< without the effects that --effects leaves out,
    Options options; ///< and so are the options
    /// As the scene was given, witnesses included; but `paths` are planned for the scene as it is rendered.
    Effects effects;
};

/// Takes `path` for `path+light` where the scene has no caustics; tabulates the sky as the integrator samples
/// it, finds the effects, takes out those that are not wanted, plans the paths of what is left, and finds
/// what casts the caustics: the one order of these. Throws UsageError for path expressions that are wrong or
/// too large.
std::shared_ptr<PlannedScene> plan_scene(Scene scene, Options options);

/// Builds the tree that lights are chosen by, where the plan has one: again, where the sky has got portals or
/// lost them. Buffers that were prepared by then have the one before.
void plan_light_tree(PlannedScene& planned);

/// Whether the scene as it is rendered casts light by mirrors, smooth glass or sharp reflection on a surface
/// (L(S|G)+(D|G)E) within --max-depth.
bool has_caustics(const PlannedScene& planned);

/// Whether path is connected to the lamps whose light makes them: slabs alone cast any (scene/slabs.h), but for
/// what they reflect.
bool path_connects_to_caustics(const PlannedScene& planned);

/// Plans for another integrator of those that connect to one light, as if the options had named it: what is
/// prepared from the plan by then must not be used any more, but for the tree.
void take_integrator(Integrator integrator, PlannedScene& planned);

} // namespace clrt
