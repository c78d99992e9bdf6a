// SPDX-License-Identifier: Apache-2.0
#include "render/ledger_plan.h"

#include "render/paired_estimate.h"

#include <algorithm>
#include <cmath>

namespace clrt {

namespace {

/// For all pairs together, unless --time says otherwise.
constexpr double DEFAULT_SECONDS = 60;
/// Of one run. The noise of longer ones is hardly less (0.8 % of 0.08 s of two threads on a busy machine,
/// 0.7 % of 0.3 s), so that many short ones tell more in the same time.
constexpr double RUN_SECONDS = 0.05;
/// A render doubles the samples of its launches, from one; work-items are faster with many at hand. A run of
/// so many is within 1 % of one of 64, where 3 samples hide a tenth of what an effect costs.
constexpr double USUAL_SAMPLES = 32;
/// But no run takes longer for their sake, seconds.
constexpr double LONGEST_RUN_SECONDS = 0.5;
/// Pictures of a few pixels render in less than it takes to start.
constexpr double MOST_RUN_SAMPLES = 4096;
/// Of the time that is left, what a plan counts on: runs differ.
constexpr double PLANNED_SHARE = 0.9;
/// Below this a clock tells nothing, seconds.
constexpr double SHORTEST_PASS = 1e-6;

} // namespace

void LedgerPlan::add(const VariantSeconds& seconds) {
    sum_.compile += seconds.compile;
    sum_.run += seconds.run;
    sum_.pass += seconds.pass;
    ++compiled_;
}

void LedgerPlan::add_pairs(double seconds) {
    pairs_ += seconds;
    ++paired_;
}

/// Of one variant.
double LedgerPlan::mean(double sum) const {
    return sum / double(std::max<size_t>(compiled_, 1));
}

/// Of one variant.
double LedgerPlan::fewest_pairs_seconds() const {
    return 2 * FEWEST_PAIRS * (mean(sum_.run) + double(samples()) * mean(sum_.pass));
}

double LedgerPlan::needed(size_t variants, double now) const {
    const double compile = mean(sum_.compile + sum_.run + sum_.pass);
    return now + compile * double(variants - compiled_) + double(variants - paired_) * fewest_pairs_seconds();
}

size_t LedgerPlan::fitting(size_t variants, double now) const {
    if (!limit_)
        return variants;
    size_t count = variants;
    while (count > compiled_ && needed(count, now) > *limit_)
        --count;
    return count;
}

double LedgerPlan::pair_seconds(size_t variants, double now) const {
    const size_t fit = fitting(variants, now);
    const double unpaired = double(fit - paired_);
    const double compile = double(fit - compiled_) * mean(sum_.compile + sum_.run + sum_.pass);
    const double left = limit_ ? PLANNED_SHARE * (*limit_ - now - compile) : DEFAULT_SECONDS - pairs_;
    return std::max(left, 0.0) / std::max(unpaired, 1.0);
}

std::uint32_t LedgerPlan::samples() const {
    if (samples_)
        return *samples_;
    const double pass = std::max(mean(sum_.pass), SHORTEST_PASS);
    const double usual = std::min(USUAL_SAMPLES, LONGEST_RUN_SECONDS / pass);
    const double wanted = std::max(usual, std::max(RUN_SECONDS, mean(sum_.run)) / pass);
    return std::uint32_t(std::clamp(std::ceil(wanted), 1.0, MOST_RUN_SAMPLES));
}

} // namespace clrt
