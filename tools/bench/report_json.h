// SPDX-License-Identifier: Apache-2.0
// Parts that the JSON of several modes shares.
#pragma once

#include "bench/bench_options.h"
#include "bench/measure.h"
#include "device/device.h"

#include <nlohmann/json.hpp>

namespace clrt {

using Json = nlohmann::ordered_json;

/// What every JSON starts with: version, command, device.
Json run_json(const BenchOptions& bench, const DeviceInfo& device);

/// Median and quartiles.
Json spread_json(const Spread& spread);

} // namespace clrt
