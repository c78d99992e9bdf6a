// SPDX-License-Identifier: Apache-2.0
#include "render/paired_estimate.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace clrt {

namespace {

/// Half of the 1 % at which DESIGN draws the line: costs below half of it and above one and a half are told
/// from it.
constexpr double NARROW_SHARE = 0.005;
/// Of a large cost, two digits are enough.
constexpr double NARROW_PART = 0.05;
/// Looks are so far apart that each has much to say that the one before had not.
constexpr double LOOK_GROWTH = 1.5;

/// Means of all pairs of values, each with itself included, in order (Walsh 1949).
std::vector<double> sorted_means(const std::vector<double>& values) {
    std::vector<double> means;
    means.reserve(values.size() * (values.size() + 1) / 2);
    for (size_t i = 0; i < values.size(); ++i)
        for (size_t j = i; j < values.size(); ++j)
            means.push_back(0.5 * (values[i] + values[j]));
    std::sort(means.begin(), means.end());
    return means;
}

/// How many of the lowest means lie below the interval of `count` values: the most for which the signed-rank
/// sum is that small with a probability of at most (1 - LOOK_CONFIDENCE) / 2.
size_t means_below(size_t count) {
    // The distribution of the sum of those of 1 ... count whose coin shows heads.
    std::vector<double> probability(count * (count + 1) / 2 + 1, 0.0);
    probability[0] = 1;
    for (size_t rank = 1; rank <= count; ++rank)
        for (size_t sum = probability.size(); sum-- > 0;)
            probability[sum] = 0.5 * (probability[sum] + (sum >= rank ? probability[sum - rank] : 0));
    double below = 0;
    size_t sum = 0;
    while (below + probability[sum] <= (1 - LOOK_CONFIDENCE) / 2)
        below += probability[sum++];
    return sum;
}

} // namespace

LedgerValue paired_estimate(const std::vector<double>& values) {
    assert(!values.empty());
    const std::vector<double> means = sorted_means(values);
    const size_t half = means.size() / 2;
    const double median = means.size() % 2 ? means[half] : 0.5 * (means[half - 1] + means[half]);
    const size_t below = means_below(values.size());
    // Of k means below, the interval begins with the k-th (the sum k itself is turned down).
    const size_t first = below > 0 ? below - 1 : 0;
    return {median, means[first], means[means.size() - 1 - first]};
}

LedgerValue relative_change(const LedgerValue& logarithm) {
    return {std::expm1(logarithm.median), std::expm1(logarithm.low), std::expm1(logarithm.high)};
}

bool is_look(size_t pairs) {
    if (pairs >= MOST_PAIRS)
        return true;
    size_t look = FEWEST_PAIRS;
    while (look < pairs)
        look = size_t(double(look) * LOOK_GROWTH);
    return look == pairs;
}

bool is_narrow(const LedgerValue& logarithm) {
    const double reach = std::max(logarithm.high - logarithm.median, logarithm.median - logarithm.low);
    return reach <= std::max(NARROW_SHARE, NARROW_PART * std::fabs(logarithm.median));
}

} // namespace clrt
