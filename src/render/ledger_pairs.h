// SPDX-License-Identifier: Apache-2.0
// Pairs of runs: the picture and another variant of it, one right after the other. No OpenCL here.
#pragma once

#include "render/paired_estimate.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace clrt {

/// What one run of a variant took and gave.
struct LedgerRun {
    double seconds = 0; ///< of one sample a pixel, by the ledger's clock
    double light = 0;   ///< mean luminance
};

/// Runs of both sides, pair by pair.
struct LedgerPairs {
    std::vector<LedgerRun> picture, other;

    size_t size() const { return picture.size(); }
    /// The logarithm of the other's time over that of the picture.
    LedgerValue log_ratio() const;
    /// What the other lacks of the picture's light, as a share of it; 0 where the picture is black.
    LedgerValue light_share() const;
};

/// Renders a variant with the random numbers of this pair.
using RunVariant = std::function<LedgerRun(std::uint32_t pair)>;

/// Takes pairs, FEWEST_PAIRS at least, until their log_ratio is narrow, there is no time left, or there are
/// MOST_PAIRS. Every other pair is in the other order, so that neither what comes first nor a machine that
/// grows slower or faster favours one side.
LedgerPairs take_pairs(const RunVariant& picture, const RunVariant& other,
                       const std::function<bool()>& has_time);

} // namespace clrt
