// SPDX-License-Identifier: Apache-2.0
#include "render/ledger_plan.h"

#include "render/ledger.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// For all rounds together, unless --time says otherwise.
constexpr double DEFAULT_SECONDS = 60;
/// More samples a round make no interval narrower than the machine's own unrest.
constexpr double MOST_LEDGER_SAMPLES = 64;
/// Of the time that is left, what a plan counts on: rounds differ.
constexpr double PLANNED_SHARE = 0.9;
/// Below this a clock tells nothing, seconds.
constexpr double SHORTEST_ROUND = 1e-6;

} // namespace

void LedgerPlan::add(const VariantSeconds& seconds) {
    sum_.compile += seconds.compile;
    sum_.run += seconds.run;
    sum_.pass += seconds.pass;
    ++compiled_;
}

/// Of one variant.
double LedgerPlan::round_seconds(double samples) const {
    return (sum_.run + samples * sum_.pass) / double(std::max<size_t>(compiled_, 1));
}

double LedgerPlan::needed(size_t variants, double now) const {
    const double compile = (sum_.compile + sum_.run + sum_.pass) / double(std::max<size_t>(compiled_, 1));
    return now + compile * double(variants - compiled_) +
           LEDGER_ROUNDS * double(variants) * round_seconds(samples_.value_or(1));
}

size_t LedgerPlan::fitting(size_t variants, double now) const {
    if (!limit_)
        return variants;
    size_t count = variants;
    while (count > compiled_ && needed(count, now) > *limit_)
        --count;
    return count;
}

std::uint32_t LedgerPlan::samples(size_t variants, int rounds_left, double now) {
    if (samples_)
        return *samples_;
    if (!limit_)
        limit_ = now + DEFAULT_SECONDS;
    const double seconds = PLANNED_SHARE * (*limit_ - now) / (double(rounds_left) * double(variants));
    const double fitting =
        (seconds - round_seconds(0)) / std::max(round_seconds(1) - round_seconds(0), SHORTEST_ROUND);
    return std::uint32_t(std::clamp(std::floor(fitting), 1.0, MOST_LEDGER_SAMPLES));
}

} // namespace clrt
