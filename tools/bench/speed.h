// SPDX-License-Identifier: Apache-2.0
// The same rays through the same triangles, by clrt and by Embree in turns.
#pragma once

#include "bench/arbitrate.h"
#include "bench/bench_options.h"
#include "bench/bench_rays.h"
#include "bench/clrt_side.h"
#include "bench/embree_builder.h"
#include "bench/measure.h"
#include "console/progress.h"
#include "device/device.h"

#include <string>
#include <vector>

namespace clrt {

/// One kind of rays.
struct KindSpeed {
    RayKind kind = RayKind::PRIMARY;
    size_t rays = 0, hits = 0;
    Spread ratio;        ///< clrt over Embree, round by round; above 1 clrt is faster
    Spread ratio_robust; ///< clrt over Embree's robust mode
    /// Rays a second, by the time that the ratio is taken of.
    Spread clrt, embree, embree_robust;
    Verdict verdict, verdict_robust; ///< on the hits of clrt and Embree, and of its robust mode
    Visits visits;                   ///< of clrt's tree
};

/// What building a tree took and gave.
struct TreeFigures {
    Cost cost;
    size_t bytes = 0;
};

/// A scene.
struct SceneSpeed {
    std::string path;
    size_t triangles = 0; ///< in the tree
    std::string layout;   ///< of clrt's tree
    double sah_cost = 0;  ///< of clrt's tree
    TreeFigures clrt, embree;
    RTCBuildQuality builder_quality = RTC_BUILD_QUALITY_MEDIUM; ///< the one that matches clrt's tree
    EmbreeTree embree_builder;                                  ///< its tree, for the SAH cost
    std::vector<KindSpeed> kinds;
};

/// True if clrt got some ray wrong.
bool is_wrong(const SceneSpeed& scene);

/// Loads a scene, makes the rays, and measures. Throws as loading and OpenCL do.
SceneSpeed compare_speed(const Device& device, const BenchOptions& bench, const std::string& scene,
                         Progress& progress);

} // namespace clrt
