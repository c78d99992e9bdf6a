// SPDX-License-Identifier: Apache-2.0
#include "bench/measure.h"

#include <gtest/gtest.h>

namespace clrt {

TEST(Measure, SpreadIsMedianAndQuartiles) {
    const Spread spread = spread_of({5, 1, 3, 2, 4});
    EXPECT_EQ(spread.median, 3);
    EXPECT_EQ(spread.low, 2);
    EXPECT_EQ(spread.high, 4);
    EXPECT_EQ(spread_of({1, 2}).median, 1.5);
    EXPECT_EQ(spread_of({7}).low, 7);
}

TEST(Measure, CountsWallAndCpuSeconds) {
    volatile double sum = 0;
    const Cost cost = measure([&] {
        for (int i = 0; i < 3000000; ++i)
            sum = sum + i;
    });
    EXPECT_GT(cost.wall, 0);
    EXPECT_GT(cost.cpu, 0);
    // One thread works: it cannot have used more than what passed, but for the clocks' steps.
    EXPECT_LE(cost.cpu, cost.wall + 0.01);
}

} // namespace clrt
