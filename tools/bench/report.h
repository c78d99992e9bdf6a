// SPDX-License-Identifier: Apache-2.0
// What clrt-bench prints and writes.
#pragma once

#include "bench/speed.h"

#include <string>
#include <vector>

namespace clrt {

/// The table of a scene.
std::string format_speed(const SceneSpeed& scene, bool cpu_time);

/// The JSON of --stats. "ratio" holds one number a kind: the geometric mean over the scenes.
std::string speed_json(const BenchOptions& bench, const DeviceInfo& device,
                       const std::vector<SceneSpeed>& scenes);

} // namespace clrt
