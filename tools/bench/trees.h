// SPDX-License-Identifier: Apache-2.0
// The trees of clrt's builder and of Embree's over the same triangles: their costs and what building takes.
#pragma once

#include "bench/bench_options.h"
#include "bench/measure.h"
#include "bvh/bvh.h"
#include "console/progress.h"

#include <string>
#include <vector>

namespace clrt {

/// A builder in one of its qualities.
struct BuiltTree {
    std::string builder;   ///< "clrt fast", "Embree high", ...
    double sah_cost = 0;   ///< as Bvh::sah_cost
    size_t references = 0; ///< entries in leaves
    Spread wall, cpu;      ///< seconds of the rounds; clrt's with the device layout, Embree's without
};

/// A scene.
struct SceneTrees {
    std::string path;
    size_t triangles = 0; ///< in the trees
    BvhLayout layout = BvhLayout::BVH8;
    std::vector<BuiltTree> trees;
};

/// Loads a scene and builds every tree once to warm up and once a round, in turns. Throws as loading does.
SceneTrees compare_trees(const BenchOptions& bench, const std::string& path, BvhLayout layout,
                         Progress& progress);

} // namespace clrt
