// SPDX-License-Identifier: Apache-2.0
// How a ledger keeps its time: what compiling and the pairs take by the wall clock, how many effects fit, how
// long each may take, and how many samples a run. No OpenCL here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace clrt {

/// What a variant of the picture took by the wall clock, when it was compiled and rendered once with one
/// sample a pixel; seconds.
struct VariantSeconds {
    double compile = 0; ///< what is done once, for the picture beside it too
    double run = 0;     ///< of one rendering: the scene's way to the device and back,
    double pass = 0;    ///< and of one sample a pixel
};

/// Plans from the mean of the variants so far. Times are seconds since the ledger began.
class LedgerPlan {
public:
    /// `limit` is for all of it, compiling included; none: for the pairs alone, a minute. `samples` a pixel
    /// and run; none: as many as make a run long enough for the clock.
    LedgerPlan(std::optional<double> limit, std::optional<std::uint32_t> samples)
        : limit_(limit), samples_(samples) {}

    /// Another variant is compiled.
    void add(const VariantSeconds& seconds);
    /// Pairs of a variant are taken, and took this long.
    void add_pairs(double seconds);
    /// The fewest seconds in which a ledger of so many variants is done, now being `now`.
    double needed(size_t variants, double now) const;
    /// How many of `variants` can be compiled and paired in time; those that are compiled at least.
    size_t fitting(size_t variants, double now) const;
    /// Seconds for the pairs of the next variant: its even share of what is left, when `fitting` are.
    double pair_seconds(size_t variants, double now) const;
    /// Samples a pixel of each run: 32 where they take half a second at most, and enough for a twentieth of a
    /// second and for what has to be done once a run.
    std::uint32_t samples() const;

private:
    double mean(double sum) const;
    double fewest_pairs_seconds() const;

    std::optional<double> limit_;
    std::optional<std::uint32_t> samples_;
    VariantSeconds sum_;
    size_t compiled_ = 0, paired_ = 0;
    double pairs_ = 0; ///< seconds that all pairs took
};

} // namespace clrt
