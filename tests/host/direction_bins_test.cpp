// SPDX-License-Identifier: Apache-2.0
// Distributions of directions: even without records, dense where records are, and never so dense that a few
// of them decide.
#include "guide/direction_bins.h"
#include "guide/guide.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Of the directions whose first coordinate in the square is below x.
double probability_below(const DirectionSplits& splits, double x) {
    // Walk the x splits of the lowest y: with records that do not depend on y, all are alike.
    double below = 0, share = 1, low = 0, high = GUIDE_SIDE;
    const double at = x * GUIDE_SIDE;
    for (size_t node = 0, level = 0; level < GUIDE_LEVELS; ++level) {
        if (level % 2 == 1) {
            node = 2 * node + 1;
            continue;
        }
        const double split = splits[node];
        share *= 0.5;
        const bool is_right = at >= split;
        below += is_right ? share : 0;
        (is_right ? low : high) = split;
        node = 2 * node + (is_right ? 2 : 1);
    }
    return below + share * (at - low) / (high - low);
}

std::uint64_t records(std::uint64_t count, std::uint64_t sum) {
    return (count << GUIDE_SUM_BITS) + sum;
}

} // namespace

TEST(DirectionBins, AreEvenWithoutRecords) {
    const DirectionSplits splits = even_splits();
    EXPECT_EQ(splits[0], GUIDE_SIDE / 2);
    EXPECT_NEAR(probability_below(splits, 0.25), 0.25, 1e-3);
    EXPECT_NEAR(probability_below(splits, 0.7), 0.7, 1e-3);
}

TEST(DirectionBins, FollowManyRecords) {
    // All light in the lower quarter of x, evenly: bins of even splits are numbered by bits of x and y by
    // turns.
    std::vector<std::uint64_t> sums(GUIDE_SUMS);
    for (size_t bin = 0; bin < GUIDE_BINS / 2; ++bin)
        if ((bin & 0x20) == 0)
            sums[bin] = records(10000, 5000000);
    const DirectionWeight weight = weight_of_sums(sums.data());
    EXPECT_DOUBLE_EQ(weight.count, 64 * 10000);
    EXPECT_DOUBLE_EQ(weight.sum, 64 * 5e6);
    const DirectionSplits splits = learn_splits(even_splits(), {}, sums.data());
    EXPECT_GT(probability_below(splits, 0.25), 15.0 / 16); // the last of sixteen columns reaches to the end
    EXPECT_NEAR(probability_below(splits, 0.125), 0.5, 0.01);
}

TEST(DirectionBins, OneRecordMakesNoPeak) {
    std::vector<std::uint64_t> sums(GUIDE_SUMS);
    sums[0] = records(1, 1u << GUIDE_RECORD_BITS);
    const DirectionSplits splits = learn_splits(even_splits(), {}, sums.data());
    EXPECT_LT(probability_below(splits, 1.0 / 16), 0.6);
    EXPECT_GT(probability_below(splits, 1.0 / 16), 0.5);
}

TEST(DirectionBins, KeepRoomForEveryBin) {
    // All light in one bin, again and again: rectangles become small, never empty.
    DirectionSplits splits = even_splits();
    DirectionWeight weight;
    for (int epoch = 0; epoch < 20; ++epoch) {
        std::vector<std::uint64_t> sums(GUIDE_SUMS);
        sums[37] = records(100000, 100000000);
        splits = learn_splits(splits, weight, sums.data());
        weight = weight_of_sums(sums.data());
    }
    // Along x the first splits of the first y: strictly rising.
    EXPECT_LT(splits[3], splits[0]);
    EXPECT_GT(splits[3], 0);
    EXPECT_GT(splits[5], splits[0]);
}

TEST(Guide, DividesCellsWithManyRecordsAndFindsThem) {
    Guide guide;
    EXPECT_EQ(guide.lore().size(), size_t(GUIDE_SIDES));
    std::vector<std::uint64_t> sums(GUIDE_SIDES * GUIDE_SUMS);
    sums[0] = records(1600, 1600000);
    sums[GUIDE_SUM_VERTICES] = 3200;
    guide.learn(sums);
    // Halves of 1600 until at most 200 are left: 8 cells instead of one.
    EXPECT_EQ(guide.lore().size(), size_t(GUIDE_SIDES + 7));
    EXPECT_DOUBLE_EQ(guide.lore()[0].weight.count, 200);
    const std::vector<GuideCell> cells = guide.device_cells();
    EXPECT_NEAR(cells[0].radiance, 500, 1e-3);
    EXPECT_NEAR(cells[0].share, 0.7 * 200 / 264, 1e-6);
    EXPECT_EQ(cells[1].share, 0);
    // The grid's corners of the first side are in different cells.
    const std::vector<u32> links = guide.device_links();
    EXPECT_TRUE(links[0] & GUIDE_LEAF);
    EXPECT_NE(links[0], links[GUIDE_GRID * GUIDE_GRID * GUIDE_GRID - 1]);
    // What is known counts half as much an epoch later.
    guide.learn(std::vector<std::uint64_t>(guide.lore().size() * GUIDE_SUMS));
    EXPECT_DOUBLE_EQ(guide.lore()[0].weight.count, 100);
}

} // namespace clrt
