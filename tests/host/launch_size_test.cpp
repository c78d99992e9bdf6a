// SPDX-License-Identifier: Apache-2.0
// Launches stay short whatever a path costs.
#include "render/launch_size.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Renders `passes` passes of `tiles` tiles whose samples cost seconds as `cost(tile)` says; returns the
/// longest launch and counts them.
template <class Cost>
double longest_launch(u32 tiles, int passes, const Cost& cost, int& launches) {
    LaunchSize size(2);
    double longest = 0;
    launches = 0;
    for (int pass = 0; pass < passes; ++pass)
        for (u32 tile = 0; tile < tiles; ++launches) {
            const u32 end = tile + size.tiles(1, tiles - tile);
            EXPECT_GT(end, tile);
            EXPECT_LE(end, tiles);
            double seconds = 0;
            for (u32 i = tile; i < end; ++i)
                seconds += cost(i);
            size.took(end - tile, 1, seconds);
            longest = std::max(longest, seconds);
            tile = end;
        }
    return longest;
}

} // namespace

TEST(LaunchSize, PathsOfThousandsOfSegmentsMakeShortLaunches) {
    // A tile of a closed white box takes half a second: 64 paths of 4096 segments.
    int launches = 0;
    EXPECT_LE(longest_launch(
                  7500, 1, [](u32) { return 0.5; }, launches),
              1.0);
    // Tiles of a usual scene: 0.3 ms.
    EXPECT_LE(longest_launch(
                  7500, 4, [](u32) { return 3e-4; }, launches),
              LAUNCH_SECONDS * 1.01);
    EXPECT_LE(launches, 5 * 4 + 7);
}

TEST(LaunchSize, WhatIsCheapAtFirstDoesNotMakeTheNextLaunchLong) {
    // The first tiles see the sky, one in three of the others a closed white box.
    int launches = 0;
    const auto cost = [](u32 tile) { return tile < 2 ? 1e-6 : tile % 3 == 0 ? 0.1 : 1e-5; };
    EXPECT_LE(longest_launch(7500, 1, cost, launches), LARGEST_LAUNCH_GROWTH * LAUNCH_SECONDS);
}

TEST(LaunchSize, NoLaunchIsTooSmallToBeTimed) {
    LaunchSize size(1);
    size.took(100, 1, 0.5); // 100 tiles fit
    EXPECT_EQ(size.tiles(1, 101), 51u);
    EXPECT_EQ(size.tiles(1, 50), 50u);
    EXPECT_EQ(size.tiles(2, 101), 34u);
    EXPECT_EQ(size.tiles(1000, 101), 1u);
}

TEST(LaunchSize, EveryComputeUnitHasATileAtFirst) {
    EXPECT_EQ(LaunchSize(2).tiles(1, 100), 2u);
    EXPECT_EQ(LaunchSize(0).tiles(1, 100), 1u);
    EXPECT_EQ(LaunchSize(128).tiles(1, 100), 100u);
}

} // namespace clrt
