// SPDX-License-Identifier: Apache-2.0
// Choosing one of n things by weight in constant time (Walker 1977; Vose 1991), with integer thresholds.
#pragma once

#include "kernels/shared/types.h"

#include <vector>

namespace clrt {

/// Choose i uniformly among the entries, draw a 32-bit word: i is kept where the word is below `threshold`,
/// else `alias` is taken. An entry that is always kept has alias = i.
struct AliasEntry {
    u32 alias = 0, threshold = 0;
};

struct AliasTable {
    std::vector<AliasEntry> entries;
    /// What the integers of the table choose, exactly: it differs from weight / sum by rounding to
    /// 1 / (n 2^32), is 0 where the weight is 0 and only there.
    std::vector<double> probability;
};

/// Builds the table in double. Weights are finite and not negative, at least one is positive; their number is
/// below 2^32. No weights give an empty table.
AliasTable build_alias_table(const std::vector<double>& weights);

} // namespace clrt
