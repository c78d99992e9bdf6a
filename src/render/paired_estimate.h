// SPDX-License-Identifier: Apache-2.0
// What pairs of measurements say about a difference, and when there are enough of them. No OpenCL here.
#pragma once

#include <cstddef>
#include <vector>

namespace clrt {

/// A location with its interval.
struct LedgerValue {
    double median = 0, low = 0, high = 0;
};

/// The probability with which the interval of a fixed number of pairs holds the location, at least.
constexpr double LOOK_CONFIDENCE = 0.96;
/// That of the intervals that a ledger prints: it looks several times and stops at the first that is narrow
/// enough, which favours those that are too narrow by chance (tests/host/ledger_pairs_test).
constexpr double LEDGER_CONFIDENCE = 0.95;

/// The fewest pairs that have an interval: of fewer, all on one side are no rare event.
constexpr size_t FEWEST_PAIRS = 8;
/// The most that are taken of one effect.
constexpr size_t MOST_PAIRS = 135;

/// The location of values that scatter evenly to both sides of it, independently, otherwise however they
/// like: the median of the means of all pairs of them, itself included (Hodges and Lehmann 1963), and the
/// interval that Wilcoxon's signed-rank test does not turn down (Tukey 1949; exact, without ties). The short
/// bursts of a busy machine move it little: where a tenth of the runs takes 10 % longer, Student's interval
/// needs three times as many pairs; without bursts it is 2 % narrower. Of six values or
/// fewer the interval holds all. `values` is not empty.
LedgerValue paired_estimate(const std::vector<double>& values);

/// The same of the value of exp(x) - 1.
LedgerValue relative_change(const LedgerValue& logarithm);

/// Whether so many pairs are a time to look: FEWEST_PAIRS, then half as many again.
bool is_look(size_t pairs);

/// Whether relative changes (logarithms of ratios) need no more pairs: the interval reaches not more than
/// half a per cent beyond the middle, or a twentieth of what the effect costs.
bool is_narrow(const LedgerValue& logarithm);

} // namespace clrt
