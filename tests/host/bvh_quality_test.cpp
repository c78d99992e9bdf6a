// SPDX-License-Identifier: Apache-2.0
// Long renders get the better tree, short ones do not, and nothing but options and triangles decides.
#include "render/bvh_quality.h"

#include "bvh/binary_tree.h"
#include "bvh/layout.h"
#include "host/bvh_support.h"

#include <gtest/gtest.h>

namespace clrt {
namespace {

// Long and thin, in all directions.
Mesh thin_triangles() {
    Mesh mesh;
    for (int i = 0; i < 4000; ++i) {
        const float x = float(i % 63) / 63, y = float(i / 63) / 63;
        mesh.add({x, y, 0, 0}, {y, 1 - x, 1, 0}, {x + 1e-3f, y, 0, 0});
    }
    return mesh;
}

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
    const Mesh needles = thin_triangles();
    for (BvhLayout layout : ALL_LAYOUTS) {
        const Bvh whole = build_bvh(even.positions, even.triangles, layout, BvhQuality::HIGH);
        EXPECT_EQ(whole.reference_count, whole.triangle_count);
        const Bvh cut = build_bvh(needles.positions, needles.triangles, layout, BvhQuality::HIGH);
        EXPECT_GT(cut.reference_count, cut.triangle_count);
        EXPECT_LT(cut.sah_cost, 0.95 * build_bvh(needles.positions, needles.triangles, layout).sah_cost);
    }
}

// A room whose walls are two triangles each, full of small ones: cutting the walls at every level, as spatial
// splits by themselves do, costs more than it gives.
TEST(BvhQuality, HighNeverCostsMoreThanFast) {
    Mesh room = random_soup(4000, 0.02f, 21);
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.2f, 1.2f}) {
            vec4 corners[4];
            for (int i = 0; i < 4; ++i) {
                float p[3];
                p[axis] = side;
                p[(axis + 1) % 3] = i & 1 ? 1.2f : -1.2f;
                p[(axis + 2) % 3] = i & 2 ? 1.2f : -1.2f;
                corners[i] = {p[0], p[1], p[2], 0};
            }
            room.add(corners[0], corners[1], corners[3]);
            room.add(corners[0], corners[3], corners[2]);
        }
    for (const Mesh& mesh : {room, bumpy_ball(60), thin_triangles()})
        for (const BvhLayout layout : ALL_LAYOUTS)
            EXPECT_LE(build_bvh(mesh.positions, mesh.triangles, layout, BvhQuality::HIGH).sah_cost,
                      1.001 * build_bvh(mesh.positions, mesh.triangles, layout).sah_cost)
                << name_of(layout);
}

// The choice between two trees is made before either is written.
TEST(BvhQuality, CostsAreKnownBeforeALayoutIsWritten) {
    for (const Mesh& mesh : {bumpy_ball(40), random_soup(3, 0.3f, 1), random_soup(5000, 0.1f, 2)})
        for (const BvhLayout layout : ALL_LAYOUTS) {
            const BinaryTree tree =
                build_binary_tree(mesh.positions, mesh.triangles, leaf_cost(layout), TreeEffort{false, 4});
            const double written = build_bvh(mesh.positions, mesh.triangles, layout).sah_cost;
            EXPECT_NEAR(cost_in_layout(tree, layout), written, 1e-5 * written) << name_of(layout);
        }
    EXPECT_EQ(cost_in_layout(BinaryTree{}, BvhLayout::BVH8), 0);
}

} // namespace
} // namespace clrt
