// SPDX-License-Identifier: Apache-2.0
// A scene on a device, ready for kernels: the one place where plan, tree, buffers and programs come together.
//
//     const auto planned = plan_scene(load_scene(options, progress), options); // no device yet
//     const PreparedScene prepared = prepare_render(device, planned); // tree and programs side by side
//     const Render first = render(prepared, progress);
//     planned->scene.camera = other; // nothing is made anew
//     const Render second = render(prepared, progress);
//     Replay replay(prepared, Precision::DOUBLE); // a program of its own, the same tree
//     const PreparedScene there = prepare_render(other_device, planned, {prepared.tree, nullptr});
#pragma once

#include "effects/planned_scene.h"
#include "guide/guide_progress.h"
#include "kernels/shared/render_types.h"
#include "render/kernels.h"
#include "render/scene_buffers.h"
#include "render/scene_tree.h"

#include <memory>

namespace clrt {

/// A scene on a device. Its parts may be shared with other prepared scenes and none of them is global:
/// several may be alive, on one device or many, each used by a thread of its own.
///
/// Whoever made the plan may change its camera, window, seed and samples between renders; what tree, buffers
/// and programs are made from must stay.
struct PreparedScene {
    const Device& device; ///< must outlive it
    std::shared_ptr<const PlannedScene> planned;
    std::shared_ptr<const SceneTree> tree;
    SceneBuffers buffers;
    std::shared_ptr<const RenderPrograms> programs; ///< null: for kernels of one's own, such as a replay's
    /// What pictures begin with; null: they find it out themselves.
    std::shared_ptr<const GuideProgress> guide;
};

/// What is there already and need not be made again.
struct PreparedParts {
    std::shared_ptr<const SceneTree> tree; ///< over the same triangles; in another layout it is not taken
    std::shared_ptr<const RenderPrograms> programs; ///< for the same device, effects, paths and tree's layout
    std::shared_ptr<const GuideProgress> guide = nullptr; ///< by choose_guide (render/guide_choice.h)
    /// Path's that reuse paths and do without, too: by prepare_path_pilot (render/reuse_choice.h).
    std::shared_ptr<const RenderPrograms> reusing = nullptr;
};

/// The tree of a plan in the layout that its options name, or that is the device's own.
std::shared_ptr<const SceneTree> plan_tree(const DeviceInfo& device, const PlannedScene& planned);

/// Has the program of the picture compiled ahead, or the one that guides its paths, if the device does so.
void expect_program(const Device& device, const PlannedScene& planned, bool is_guided = false);

/// Likewise the program of a pilot (render/pilot.h). `options`: the plan's, but of the pilot's integrator.
void expect_pilot(const Device& device, const PlannedScene& planned, const Options& options);

/// Of all that is compiled ahead so far, nothing but the program of the picture is wanted any more.
void expect_no_other(const Device& device, const PlannedScene& planned);

/// Compiles what renders a plan: for its effects, its paths and the layout of its tree.
std::shared_ptr<const RenderPrograms> plan_programs(const Device& device, const PlannedScene& planned);

/// Builds the tree, if it is not there, and uploads; compiles nothing. Throws SceneError and DeviceError.
PreparedScene prepare_scene(const Device& device, std::shared_ptr<const PlannedScene> planned,
                            PreparedParts parts = {});

/// The same with the programs of the picture, which are compiled while the tree is built. Throws what
/// prepare_scene throws, and KernelBuildError.
PreparedScene prepare_render(const Device& device, std::shared_ptr<const PlannedScene> planned,
                             PreparedParts parts = {});

/// Compiles the same integrator so that it guides paths.
Program build_guided_program(const PreparedScene& prepared);

/// Compiles what finds ways out of the scene.
Program build_escape_program(const PreparedScene& prepared);

/// Compiles the integrator, path+light or bdpt, so that it sums the moments of its samples.
Program build_pilot_program(const PreparedScene& prepared);

/// Compiles the same integrator so that it records what single samples do, in a precision of its own.
Program build_replay_program(const PreparedScene& prepared, Precision precision);

/// The constants of a launch of the whole picture in all its replicates.
RenderParams launch_params(const PlannedScene& planned);

} // namespace clrt
