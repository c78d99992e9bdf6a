// SPDX-License-Identifier: Apache-2.0
#include "render/ledger_pairs.h"

#include <cmath>

namespace clrt {

namespace {

/// f(picture's run, other's run) of every pair.
template <typename F>
LedgerValue estimate(const LedgerPairs& pairs, const F& f) {
    std::vector<double> values;
    for (size_t i = 0; i < pairs.size(); ++i)
        values.push_back(f(pairs.picture[i], pairs.other[i]));
    return paired_estimate(values);
}

} // namespace

LedgerValue LedgerPairs::log_ratio() const {
    return estimate(*this,
                    [](const LedgerRun& a, const LedgerRun& b) { return std::log(b.seconds / a.seconds); });
}

LedgerValue LedgerPairs::light_share() const {
    return estimate(*this, [](const LedgerRun& a, const LedgerRun& b) {
        return a.light > 0 ? 1 - b.light / a.light : 0;
    });
}

LedgerPairs take_pairs(const RunVariant& picture, const RunVariant& other,
                       const std::function<bool()>& has_time) {
    LedgerPairs pairs;
    while (pairs.size() < FEWEST_PAIRS || (pairs.size() < MOST_PAIRS && has_time())) {
        if (is_look(pairs.size()) && is_narrow(pairs.log_ratio()))
            break;
        const auto pair = std::uint32_t(pairs.size());
        const bool is_picture_first = pair % 2 == 0;
        const LedgerRun first = is_picture_first ? picture(pair) : other(pair);
        const LedgerRun second = is_picture_first ? other(pair) : picture(pair);
        pairs.picture.push_back(is_picture_first ? first : second);
        pairs.other.push_back(is_picture_first ? second : first);
    }
    return pairs;
}

} // namespace clrt
