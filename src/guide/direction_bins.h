// SPDX-License-Identifier: Apache-2.0
// A distribution of directions: rectangles of equal probability in the square of an octahedral map, the
// leaves of a complete tree of splits (kernels/path/guide_bins.h). No OpenCL here.
#pragma once

#include "kernels/shared/guide_types.h"

#include <array>
#include <cstdint>

namespace clrt {

/// Where each inner node divides its rectangle, in multiples of 2^-16: the root, its two children, ...;
/// levels 0, 2, ... across x, the others across y.
using DirectionSplits = std::array<std::uint16_t, GUIDE_BINS - 1>;

/// All rectangles are equal.
DirectionSplits even_splits();

/// What is known of a distribution, beside its shape.
struct DirectionWeight {
    double sum = 0;   ///< of the records of light
    double count = 0; ///< how many they are
};

/// The splits after an epoch: of the distribution `old`, which weighs `weight`, together with what the epoch
/// has found in its bins (GUIDE_BINS sums as in kernels/shared/guide_types.h), evenly spread in each. Nodes
/// hold half of the probability on either side as if every one of them had one more record, evenly spread:
/// few records make no peaks.
DirectionSplits learn_splits(const DirectionSplits& old, const DirectionWeight& weight,
                             const std::uint64_t* sums);

/// What the sums of an epoch's bins hold.
DirectionWeight weight_of_sums(const std::uint64_t* sums);

/// The same splits as a cell on the device holds them.
void pack_splits(const DirectionSplits& splits, GuideCell& cell);

} // namespace clrt
