// SPDX-License-Identifier: Apache-2.0
// Long renders get the better tree, short ones do not, and nothing but options and triangles decides.
#include "render/bvh_quality.h"

#include "host/bvh_support.h"

#include <gtest/gtest.h>

namespace clrt {
namespace {

BvhQuality choose(const Options& options, size_t triangles) {
    return choose_bvh_quality(options, triangles).quality;
}

TEST(BvhQuality, ChoiceOfTheUserStands) {
    Options options;
    options.bvh.quality = BvhQuality::HIGH;
    options.sampling.spp = 1;
    EXPECT_EQ(choose(options, 10000000), BvhQuality::HIGH);
    EXPECT_EQ(choose_bvh_quality(options, 10000000).reason, "as chosen");
    options.bvh.quality = BvhQuality::FAST;
    options.sampling.spp = 100000;
    EXPECT_EQ(choose(options, 100), BvhQuality::FAST);
}

TEST(BvhQuality, MoreSamplesPixelsOrDepthCanOnlyRaiseIt) {
    Options options;
    options.sampling.spp = 1;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
    options.sampling.spp = 4096;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::HIGH);
    options.film.size = {80, 60};
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
    options.film.size = {8000, 6000};
    options.film.crop = Crop{0, 0, 80, 60};
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
    options.film.crop.reset();
    options.film.size = {800, 600};
    options.sampling.spp = 64;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::HIGH);
    options.transport.max_depth = 1;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
}

TEST(BvhQuality, SmallMeshesGetTheBetterTreeAtOnce) {
    Options options;
    EXPECT_EQ(choose(options, 1000), BvhQuality::HIGH);
    EXPECT_EQ(choose(options, 100000000), BvhQuality::FAST);
    EXPECT_EQ(choose(options, 0), BvhQuality::HIGH);
}

TEST(BvhQuality, TimeBoundsThePrediction) {
    Options options;
    options.sampling.time_seconds = 1;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
    options.sampling.time_seconds = 600;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::HIGH);
    options.sampling.spp = 1; // ends long before
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
    options.sampling.spp = 100000;
    options.sampling.time_seconds = 1;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
}

// How long a target takes is unknown; it counts as longer than the default, unless --spp or --time says
// otherwise.
TEST(BvhQuality, AnErrorTargetCountsAsALongRender) {
    Options options;
    options.film.size = {512, 512};
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
    options.sampling.error = 0.02;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::HIGH);
    options.sampling.spp = 16;
    EXPECT_EQ(choose(options, 1000000), BvhQuality::FAST);
}

// Long thin triangles are worth cutting, those of an even mesh are not.
TEST(BvhQuality, TrianglesAreCutOnlyWhereItPays) {
    const Mesh even = bumpy_ball(60);
    Mesh needles;
    for (int i = 0; i < 4000; ++i) {
        const float x = float(i % 63) / 63, y = float(i / 63) / 63;
        needles.add({x, y, 0, 0}, {y, 1 - x, 1, 0}, {x + 1e-3f, y, 0, 0});
    }
    for (BvhLayout layout : ALL_LAYOUTS) {
        const Bvh whole = build_bvh(even.positions, even.triangles, layout, BvhQuality::HIGH);
        EXPECT_EQ(whole.reference_count, whole.triangle_count);
        const Bvh cut = build_bvh(needles.positions, needles.triangles, layout, BvhQuality::HIGH);
        EXPECT_GT(cut.reference_count, cut.triangle_count);
        EXPECT_LT(cut.sah_cost, 0.95 * build_bvh(needles.positions, needles.triangles, layout).sah_cost);
    }
}

} // namespace
} // namespace clrt
