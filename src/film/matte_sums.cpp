// SPDX-License-Identifier: Apache-2.0
#include "film/matte_sums.h"

#include "film/hit_sums.h"

namespace clrt {

std::vector<IndexShare> matte_shares(const HitSums& hits, const Film& film, size_t pixel, size_t kind) {
    std::vector<IndexShare> shares;
    for (size_t half = 0; half < hits.halves(); ++half) {
        const u32* slots = &hits.mattes[half][MATTE_WORDS * pixel + MATTE_KIND_WORDS * kind];
        const double weight = hits.half_weight(half), samples = hits.half_samples(film, half, pixel);
        for (size_t i = 0; i < MATTE_SLOTS; ++i) {
            const u32* slot = slots + MATTE_SLOT_WORDS * i;
            if (slot[MATTE_SAMPLES] > 0)
                shares.push_back({slot[MATTE_INDEX], weight * (slot[MATTE_SAMPLES] / samples)});
        }
    }
    return shares;
}

} // namespace clrt
