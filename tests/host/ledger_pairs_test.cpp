// SPDX-License-Identifier: Apache-2.0
// The ledger's statistics on machines whose truth is known: quiet ones, noisy ones, and such that grow
// slower.
#include "render/ledger_pairs.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace clrt {

namespace {

/// Renders that take what they take, times what the machine adds.
struct Machine {
    double cost = 0;   ///< logarithm of the other's time over that of the picture
    double noise = 0;  ///< standard deviation of the logarithm of a run's time
    double bursts = 0; ///< how often a run is disturbed, by 10 % on average
    double drift = 0;  ///< growth of the logarithm from run to run
    double slower = 0; ///< by how much at once, after `slower_at` runs
    int slower_at = 0;
    double second = 0; ///< the second run of a pair is slower by this
};

/// Pairs of a machine; as many as they like to be.
LedgerPairs pairs_on(const Machine& machine, std::mt19937& random) {
    int runs = 0;
    const auto run = [&](double cost) {
        std::normal_distribution<double> noise(0, 1);
        std::uniform_real_distribution<double> chance(0, 1);
        std::exponential_distribution<double> burst(1 / 0.1);
        double log_seconds = cost + machine.noise * noise(random) + machine.drift * runs;
        const double disturbed = chance(random), by = burst(random);
        log_seconds += disturbed < machine.bursts ? by : 0;
        log_seconds += runs >= machine.slower_at ? machine.slower : 0;
        log_seconds += runs % 2 ? machine.second : 0;
        ++runs;
        return LedgerRun{0.01 * std::exp(log_seconds), 1};
    };
    return take_pairs([&](std::uint32_t) { return run(0); }, [&](std::uint32_t) { return run(machine.cost); },
                      [] { return true; });
}

struct Repetitions {
    double coverage = 0; ///< share of the intervals that hold the truth
    double pairs = 0;    ///< mean number
    double reach = 0;    ///< mean half of the interval
    double error = 0;    ///< mean of estimate less truth
};

Repetitions repeat(const Machine& machine, int times = 1000) {
    std::mt19937 random(1);
    Repetitions result;
    for (int i = 0; i < times; ++i) {
        const LedgerPairs pairs = pairs_on(machine, random);
        const LedgerValue value = pairs.log_ratio();
        result.coverage += value.low <= machine.cost && machine.cost <= value.high ? 1 : 0;
        result.pairs += double(pairs.size());
        result.reach += 0.5 * (value.high - value.low);
        result.error += value.median - machine.cost;
    }
    for (double* sum : {&result.coverage, &result.pairs, &result.reach, &result.error})
        *sum /= times;
    return result;
}

/// 1000 repetitions of a probability of 0.95 lie within these with one of 99.7 %.
void expect_nominal(const Repetitions& result, const char* machine) {
    EXPECT_GE(result.coverage, 0.93) << machine;
    EXPECT_LE(result.coverage, 0.985) << machine << ": wider than they need be";
}

} // namespace

TEST(PairedEstimate, IsTheMedianOfThePairwiseMeansWithWilcoxonsInterval) {
    // Hollander and Wolfe, Nonparametric Statistical Methods, table 3.1 (Hamilton's depression scale): the
    // estimate is -0.46; at nine pairs the interval of 96.1 % leaves 5 means out on either side.
    const std::vector<double> differences = {-0.952, 0.147,  -1.022, -0.430, -0.620,
                                             -0.590, -0.490, 0.080,  -0.010};
    const LedgerValue value = paired_estimate(differences);
    EXPECT_NEAR(value.median, -0.46, 1e-12);
    EXPECT_NEAR(value.low, -0.786, 1e-12);
    EXPECT_NEAR(value.high, -0.010, 1e-12);
}

TEST(PairedEstimate, FewValuesHoldAllInTheirInterval) {
    const LedgerValue one = paired_estimate({3});
    EXPECT_EQ(one.median, 3);
    EXPECT_EQ(one.low, 3);
    EXPECT_EQ(one.high, 3);
    const LedgerValue four = paired_estimate({4, 1, 3, 2});
    EXPECT_EQ(four.median, 2.5);
    EXPECT_EQ(four.low, 1);
    EXPECT_EQ(four.high, 4);
}

TEST(PairedEstimate, OneBurstMovesNeitherMiddleNorEndsFar) {
    std::vector<double> values(40);
    std::iota(values.begin(), values.end(), 1);
    const LedgerValue before = paired_estimate(values);
    values.back() = 1e6;
    const LedgerValue after = paired_estimate(values);
    EXPECT_NEAR(after.median, before.median, 1);
    EXPECT_NEAR(after.high, before.high, 2);
}

TEST(PairedEstimate, LooksAreHalfAsManyPairsApart) {
    std::vector<size_t> looks;
    for (size_t pairs = 0; pairs <= MOST_PAIRS; ++pairs)
        if (is_look(pairs))
            looks.push_back(pairs);
    EXPECT_EQ(looks, (std::vector<size_t>{8, 12, 18, 27, 40, 60, 90, 135}));
}

TEST(LedgerPairs, IntervalsHoldTheTruthOfNoisyMachines) {
    expect_nominal(repeat({0, 0.005}), "quiet, no cost");
    expect_nominal(repeat({0.03, 0.01}), "3 %");
    expect_nominal(repeat({0.01, 0.02}, 300), "noisy");
    expect_nominal(repeat({0.01, 0.007, 0.1}), "bursts");
    expect_nominal(repeat({0.3, 0.02, 0.05}), "a large cost");
}

TEST(LedgerPairs, NeitherDriftNorAStepNorTheOrderFavoursASide) {
    Machine drifting{0.01, 0.007};
    drifting.drift = 0.002;
    expect_nominal(repeat(drifting), "drift");
    Machine stepping{0.01, 0.007};
    stepping.slower = 0.5, stepping.slower_at = 7;
    expect_nominal(repeat(stepping), "a step within a pair");
    Machine ordered{0.01, 0.003};
    ordered.second = 0.02;
    const Repetitions result = repeat(ordered);
    EXPECT_GE(result.coverage, 0.93);
    EXPECT_NEAR(result.error, 0, 5e-4);
}

TEST(LedgerPairs, TheyEndWhenTheIntervalIsNarrow) {
    EXPECT_EQ(repeat({0, 0.0005}, 50).pairs, double(FEWEST_PAIRS));
    const Repetitions small = repeat({0.01, 0.007}, 100), large = repeat({0.3, 0.007}, 100);
    EXPECT_LE(small.reach, 0.0055);
    EXPECT_LT(large.pairs, 0.75 * small.pairs) << "two digits are enough";
    EXPECT_EQ(repeat({0, 0.2}, 20).pairs, double(MOST_PAIRS));
}

TEST(LedgerPairs, WithoutTimeTheFewestAreTaken) {
    int calls = 0;
    const RunVariant run = [&](std::uint32_t pair) {
        ++calls;
        return LedgerRun{1 + 0.1 * ((pair * 7) % 3), 1};
    };
    const LedgerPairs pairs = take_pairs(run, run, [] { return false; });
    EXPECT_EQ(pairs.size(), FEWEST_PAIRS);
    EXPECT_EQ(calls, 2 * int(FEWEST_PAIRS));
}

TEST(LedgerPairs, BothOfAPairHaveTheSameSamplesAndTakeTurnsInBeingFirst) {
    std::vector<std::pair<char, std::uint32_t>> calls;
    const auto side = [&](char name, double light) {
        return [&calls, name, light](std::uint32_t pair) {
            calls.emplace_back(name, pair);
            return LedgerRun{1, light};
        };
    };
    const LedgerPairs pairs = take_pairs(side('p', 2), side('o', 1.5), [] { return true; });
    ASSERT_GE(calls.size(), 4u);
    calls.resize(4);
    EXPECT_EQ(calls, (std::vector<std::pair<char, std::uint32_t>>{{'p', 0}, {'o', 0}, {'o', 1}, {'p', 1}}));
    EXPECT_EQ(pairs.light_share().median, 0.25);
    EXPECT_EQ(pairs.picture[1].light, 2);
}

TEST(LedgerPairs, ABlackPictureLacksNoLight) {
    const RunVariant black = [](std::uint32_t) { return LedgerRun{1, 0}; };
    EXPECT_EQ(take_pairs(black, black, [] { return true; }).light_share().high, 0);
}

} // namespace clrt
