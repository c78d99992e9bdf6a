// SPDX-License-Identifier: Apache-2.0
// Where the Markov chains of a replicate start: at paths drawn in proportion to their scores, so that in
// expectation a chain is everywhere as it will be after any number of steps.
#pragma once

#include "kernels/shared/types.h"

#include <cstddef>
#include <vector>

namespace clrt {

struct ChainStarts {
    double sum = 0;           ///< of all scores
    std::vector<u32> numbers; ///< of a path for each chain; NO_INDEX where no path has a score
};

/// Draws `count` of the paths with these scores, which are not negative: one from every count-th part of
/// their sum, `offset` in [0, 1) into it (systematic sampling). Sums in order, the same on every machine.
ChainStarts choose_starts(const float* scores, size_t paths, size_t count, double offset);

} // namespace clrt
