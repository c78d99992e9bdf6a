// SPDX-License-Identifier: Apache-2.0
#include "render/chain_starts.h"

#include <numeric>

namespace clrt {

ChainStarts choose_starts(const float* scores, size_t paths, size_t count, double offset) {
    ChainStarts starts;
    starts.numbers.assign(count, NO_INDEX);
    starts.sum = std::accumulate(scores, scores + paths, 0.0);
    if (!(starts.sum > 0))
        return starts;
    double passed = 0;
    size_t chain = 0;
    u32 last = 0;
    for (size_t i = 0; i < paths; ++i) {
        if (!(scores[i] > 0))
            continue;
        passed += double(scores[i]);
        last = u32(i);
        for (; chain < count && (double(chain) + offset) / double(count) * starts.sum < passed; ++chain)
            starts.numbers[chain] = last;
    }
    for (; chain < count; ++chain) // what rounding has left
        starts.numbers[chain] = last;
    return starts;
}

} // namespace clrt
