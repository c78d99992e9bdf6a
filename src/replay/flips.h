// SPDX-License-Identifier: Apache-2.0
// Flips between twins: samples that take another path in double precision than in single, on the same random
// numbers.
#pragma once

#include "replay/twins.h"

#include <map>
#include <utility>

namespace clrt {

/// One sample whose decisions differ.
struct Flip {
    SampleAddress address;
    u32 bounce = 0;                              ///< of the vertex where they differ first
    std::string decision;                        ///< decision_name
    std::array<double, 3> single{}, in_double{}; ///< radiance of the sample by either
};

struct FlipStatistics {
    std::uint64_t samples = 0; ///< that were compared
    std::vector<Flip> flips;   ///< in the order of their addresses
    /// Flips by decision and bounce.
    std::map<std::pair<std::string, u32>, std::uint64_t> counts() const;
    double share() const { return samples ? double(flips.size()) / double(samples) : 0; }
};

/// Runs samples first_sample .. first_sample + spp - 1 of every pixel of the options' window in both
/// precisions, compares a hash of the decisions, and replays those that differ. The scene may be prepared
/// without programs. Throws DeviceError where the device has no fp64.
FlipStatistics find_flips(const PreparedScene& prepared);

/// A table: share of samples that flip, by decision and bounce.
std::string format_flips(const FlipStatistics& flips);

} // namespace clrt
