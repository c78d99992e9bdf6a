// SPDX-License-Identifier: Apache-2.0
// Which effects a scene calls for under the given options, each with its witness: the proof that switches
// kernel code on or off (kernels/shared/effects.h).
#pragma once

#include "effects/effect_table.h"
#include "options/options.h"
#include "paths/path_plan.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// One effect and why it is present or absent.
struct Effect {
    EffectMask bit = 0; ///< EFFECT_*
    std::string name;   ///< as in messages and files, such as "rough refraction"
    bool present = false;
    std::string witness; ///< what calls for it, such as `material "glass" (room.mtl:12)`, or why nothing does
    SourcePlace place;   ///< the file and line that the witness names; line 0: none
};

/// All effects, in the order of their bits.
struct Effects {
    std::vector<Effect> list;
    /// What the scene calls for, all effects.
    EffectMask needed = 0;
    /// Bits to compile with: the needed ones, all with --effects all, or those of the list, without what is
    /// taken away.
    EffectMask mask = 0;
    /// What the scene calls for and --effects leaves out, with the effects that imply it: take_out.h.
    EffectMask left_out = 0;
    /// What --paths and layers of paths ask for, and its automaton.
    PathPlan paths;
};

/// Examines materials on triangles, lights, environment and options. Pure.
Effects find_effects(const Scene& scene, const Options& options);

/// The table of --explain, one line an effect.
std::string format_effects(const Effects& effects);

/// What becomes of the effects that are left out, one line each; empty if none is.
std::vector<std::string> describe_left_out(const Effects& effects);

} // namespace clrt
