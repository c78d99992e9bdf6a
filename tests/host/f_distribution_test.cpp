// SPDX-License-Identifier: Apache-2.0
// Fisher's F distribution against closed forms and published tables.
#include "film/f_distribution.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace clrt {

TEST(FDistribution, TwoDegreesAboveHaveAClosedForm) {
    for (const double below : {1.0, 2.5, 7.0, 300.0, 1e5})
        for (const double value : {1e-6, 0.01, 0.9, 1.0, 1.1, 5.0, 40.0}) {
            const double above = std::exp(-0.5 * below * std::log1p(2 * value / below));
            EXPECT_NEAR(f_probability(value, 2, below), 1 - above, 1e-10) << value << " " << below;
        }
}

TEST(FDistribution, TheRatioTurnedRoundHasTheOtherSide) {
    for (const double above : {1.0, 3.3, 40.0, 2e4})
        for (const double below : {1.0, 9.9, 1000.0})
            for (const double value : {0.05, 0.7, 1.0, 1.3, 12.0})
                EXPECT_NEAR(f_probability(value, above, below), 1 - f_probability(1 / value, below, above),
                            1e-10);
}

TEST(FDistribution, QuantilesAreThoseOfTheTables) {
    // Pearson and Hartley, Biometrika tables for statisticians, table 18: upper 2.5 %.
    EXPECT_NEAR(f_quantile(0.975, 1, 7), 8.0727, 5e-5);
    EXPECT_NEAR(f_quantile(0.975, 10, 30), 2.5112, 5e-5);
    EXPECT_NEAR(f_quantile(0.975, 60, 120), 1.5299, 5e-5);
    EXPECT_NEAR(f_quantile(0.025, 30, 10), 1 / 2.5112, 5e-5);
    // One degree above is the square of Student's t.
    EXPECT_NEAR(f_quantile(0.95, 1, 7), 2.364624 * 2.364624, 1e-5);
}

TEST(FDistribution, QuantilesTurnProbabilitiesRound) {
    for (const double above : {1.0, 1.7, 26.0, 1e3, 1e5})
        for (const double times : {3.0, 7.0, 63.0})
            for (const double probability : {0.025, 0.5, 0.975}) {
                const double value = f_quantile(probability, above, times * above);
                EXPECT_NEAR(f_probability(value, above, times * above), probability, 1e-7) << above;
            }
}

TEST(FDistribution, ManyDegreesAreNormal) {
    const double half_width = 1.959964 * std::sqrt(2 / 1e5 * (1 + 1 / 7.0));
    EXPECT_NEAR(f_quantile(0.975, 1e5, 7e5), 1 + half_width, 3e-5);
    EXPECT_NEAR(f_quantile(0.025, 1e5, 7e5), 1 - half_width, 3e-5);
}

TEST(FDistribution, NothingIsBelowZero) {
    EXPECT_EQ(f_probability(0, 3, 4), 0);
    EXPECT_EQ(f_probability(-1, 3, 4), 0);
    EXPECT_EQ(f_probability(std::numeric_limits<double>::quiet_NaN(), 3, 4), 0);
}

} // namespace clrt
