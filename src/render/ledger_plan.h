// SPDX-License-Identifier: Apache-2.0
// How a ledger keeps its time: what compiling and the rounds take by the wall clock, how many effects fit,
// and how many samples a round. No OpenCL here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace clrt {

/// What one variant took by the wall clock, when it was compiled and rendered once with one sample a pixel;
/// seconds.
struct VariantSeconds {
    double compile = 0; ///< what is done once
    double run = 0;     ///< of one rendering: the scene's way to the device and back,
    double pass = 0;    ///< and of one sample a pixel
};

/// Plans from the mean of the variants so far. Times are seconds since the ledger began.
class LedgerPlan {
public:
    /// `limit` is for all of it, compiling included; none: for the rounds alone, a minute. `samples` a pixel
    /// and round; none: as many as fit.
    LedgerPlan(std::optional<double> limit, std::optional<std::uint32_t> samples)
        : limit_(limit), samples_(samples) {}

    /// Another variant is compiled.
    void add(const VariantSeconds& seconds);
    /// The fewest seconds in which a ledger of so many variants is done, now being `now`.
    double needed(size_t variants, double now) const;
    /// How many of `variants` can be compiled and rendered in time; those that are compiled at least.
    size_t fitting(size_t variants, double now) const;
    /// Samples a pixel of the next round, when so many rounds of so many variants are left.
    std::uint32_t samples(size_t variants, int rounds_left, double now);

private:
    double round_seconds(double samples) const;

    std::optional<double> limit_;
    std::optional<std::uint32_t> samples_;
    VariantSeconds sum_;
    size_t compiled_ = 0;
};

} // namespace clrt
