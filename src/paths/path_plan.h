// SPDX-License-Identifier: Apache-2.0
// --paths and the layers of paths against one scene: what can occur in it, the automaton, and what the kernel
// is told.
#pragma once

#include "kernels/shared/path_types.h"
#include "options/options.h"
#include "paths/automaton.h"
#include "paths/blind_spots.h"
#include "scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// A letter of the notation and what in the scene writes it.
struct PathLetter {
    std::string symbol;  ///< "D", "La", ...
    std::string witness; ///< such as `material "glass" (room.mtl:12)`; empty: nothing does
    SourcePlace place;   ///< the file and line that the witness names; line 0: none
};

/// What the options ask of the paths of a scene.
struct PathPlan {
    std::string expression;              ///< as given; empty: every path
    std::vector<PathLayerOption> layers; ///< as given
    std::vector<PathLetter> letters;     ///< all, in the order D G R T La Lp Ld Le
    PathAlphabet alphabet;               ///< those with a witness
    unsigned found_by_rays =
        0; ///< KIND_* of lights that a ray can meet: all but points and suns without a disc
    unsigned missed_by_rays = 0;         ///< KIND_* of lights that no ray meets; suns can be in both
    Automaton automaton;                 ///< empty where nothing was asked for
    bool is_asked = false;               ///< --paths or a layer was given
    bool is_filter = false;              ///< the kernel needs the automaton; else it changes nothing
    bool is_empty = false;               ///< no path of the scene is accepted within --max-depth
    std::optional<int> segments;         ///< most that an accepted path has; none: no bound but --max-depth
    std::vector<BlindSpot> blind_spots;  ///< what is asked for and cannot be sampled
    bool are_lamps_behind_slabs = false; ///< finds_lamps_behind_slabs
    HitPaths hit_paths; ///< what is asked for and hard to sample; nearly smooth lobes count as smooth
};

/// Examines materials on triangles and lights. Pure. Throws UsageError for expressions that are wrong or too
/// large.
PathPlan plan_paths(const Scene& scene, const Options& options);

/// Whether the integrator connects to lamps through slabs of glass (kernels/path/slab_bend.h).
bool finds_lamps_behind_slabs(const Scene& scene, const Options& options);

/// The automaton as the kernels take it (kernels/shared/path_types.h).
struct PathTables {
    std::vector<PathState> states; ///< rows by number; row 0 leads to the start
};

/// The tables of a plan; those of one state that accepts every path where it is no filter.
PathTables path_tables(const PathPlan& plan = {});

/// What a program is built with besides: the number of layers (kernels/path/layers.h), if there are any, and
/// whether lamps are connected to through slabs (kernels/path/slab_bend.h).
std::vector<std::string> path_defines(const PathPlan& plan);

/// KIND_* of lights that end some accepted path: next-event estimation leaves the others alone.
unsigned accepted_kinds(const PathPlan& plan);

} // namespace clrt
