// SPDX-License-Identifier: Apache-2.0
// Which objects and materials the samples of pixels see first, and how many samples each. No OpenCL here.
#pragma once

#include "film/film.h"
#include "kernels/shared/aov_types.h"

#include <array>
#include <vector>

namespace clrt {

struct HitSums;

/// What an object or material has of a pixel.
struct IndexShare {
    u32 index = 0;
    double coverage = 0; ///< above 0
};

/// Slots of the pixels of a window, of each half of the replicates where tiles have samples of their own,
/// else in the first place only. Samples come in order and keep what they find, so that launches of any size
/// give the same bits.
using MatteSlots = std::array<std::vector<u32>, 2>; ///< MATTE_WORDS a pixel; empty: none are asked for

/// The shares of a pixel by kind, MATTE_OBJECTS or MATTE_MATERIALS; each half weighs as much as it does in
/// the film's picture, and an index may be there once of each.
std::vector<IndexShare> matte_shares(const HitSums& hits, const Film& film, size_t pixel, size_t kind);

} // namespace clrt
