// SPDX-License-Identifier: Apache-2.0
// What clrt-bench prints and writes.
#pragma once

#include "bench/robustness.h"
#include "bench/speed.h"
#include "bench/trees.h"
#include "bench/watertight.h"

#include <string>
#include <vector>

namespace clrt {

/// The table of a scene.
std::string format_speed(const SceneSpeed& scene, bool cpu_time);

/// The JSON of --stats. "ratio" holds one number a kind: the geometric mean over the scenes.
std::string speed_json(const BenchOptions& bench, const DeviceInfo& device,
                       const std::vector<SceneSpeed>& scenes);

/// The table of --trees.
std::string format_trees(const SceneTrees& scene);

/// Its JSON.
std::string trees_json(const BenchOptions& bench, const DeviceInfo& device,
                       const std::vector<SceneTrees>& scenes);

/// The table of --watertight.
std::string format_watertight(const std::vector<WatertightCase>& cases);

/// Its JSON.
std::string watertight_json(const BenchOptions& bench, const DeviceInfo& device,
                            const std::vector<WatertightCase>& cases, double seconds);

/// The table of --robustness.
std::string format_robustness(const Robustness& robustness, bool cpu_time);

/// Its JSON.
std::string robustness_json(const BenchOptions& bench, const DeviceInfo& device,
                            const std::vector<Robustness>& scenes);

} // namespace clrt
