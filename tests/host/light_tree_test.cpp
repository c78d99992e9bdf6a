// SPDX-License-Identifier: Apache-2.0
// The light tree as the host builds it: leaves, trails, bounds, and the same bits on any number of threads.
#include "scene/light_tree.h"

#include "kernels/shared/path_types.h"
#include "support/lamps.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <set>
#include <tbb/global_control.h>

using namespace clrt;
using glm::dvec3;

namespace {

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// The way from the root to a light, child by child.
class Trail {
public:
    explicit Trail(const LightPlace& place)
        : left_(std::uint64_t(place.trail_high) << 32 | place.trail_low) {}

    size_t next() {
        const size_t child = left_ & (LIGHT_NODE_WIDTH - 1);
        left_ >>= LIGHT_TRAIL_BITS;
        return child;
    }
    bool is_at_end() const { return left_ == 0; }

private:
    std::uint64_t left_;
};

/// The leaf to which a light's trail leads: the number of its first light.
u32 leaf_of(const LightTree& tree, u32 light) {
    Trail trail(tree.places[light]);
    u32 link = 0;
    while (!(link & LIGHT_LINK_LEAF))
        link = tree.nodes.at(link & LIGHT_LINK_INDEX).link[trail.next()];
    EXPECT_TRUE(trail.is_at_end());
    return link & LIGHT_LINK_INDEX;
}

size_t leaf_count(const LightTree& tree) {
    size_t leaves = 0;
    for (const LightNode& node : tree.nodes)
        for (const u32 link : node.link)
            leaves += (link & LIGHT_LINK_LEAF) != 0;
    return leaves;
}

} // namespace

TEST(LightTree, AFlatPolygonIsOneLeafAndNothingToChoose) {
    Lamps lamps;
    lamps.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, dvec3(2));
    lamps.finish();
    EXPECT_EQ(fan_end(lamps.scene, 0), 2u);
    EXPECT_FALSE(has_several_leaves(lamps.scene, KINDS_ALL));
    EXPECT_TRUE(build_light_tree(lamps.scene, KINDS_ALL).nodes.empty());
    // Another object, another plane or no common vertex begins another leaf.
    lamps.quad({0, 0, 1}, {1, 0, 0}, {0, 1, 0}, dvec3(2));
    lamps.finish();
    EXPECT_EQ(fan_end(lamps.scene, 0), 2u);
    EXPECT_EQ(fan_end(lamps.scene, 2), 4u);
    EXPECT_EQ(leaf_count(build_light_tree(lamps.scene, KINDS_ALL)), 2u);
    lamps.scene.positions[2].z = 0.1f;
    EXPECT_EQ(fan_end(lamps.scene, 0), 1u) << "bent along the diagonal";
}

TEST(LightTree, OnlyKindsThatAreAskedForAreInIt) {
    Lamps lamps = random_lamps(3, 1);
    lamps.point({0, 0, 1}, dvec3(1));
    lamps.sun({0, 1, 0}, dvec3(1), 0);
    lamps.sky();
    EXPECT_EQ(leaf_count(build_light_tree(lamps.scene, KINDS_ALL)), 6u);
    EXPECT_EQ(leaf_count(build_light_tree(lamps.scene, KIND_AREA | KIND_SKY)), 4u);
    EXPECT_EQ(leaf_count(build_light_tree(lamps.scene, KIND_POINT | KIND_SUN)), 2u);
    EXPECT_TRUE(build_light_tree(lamps.scene, KIND_SUN).nodes.empty());
    const LightTree tree = build_light_tree(lamps.scene, KIND_AREA);
    EXPECT_EQ(tree.places[6].end, 0u) << "the point";
    EXPECT_EQ(tree.places[8].end, 0u) << "the sky";
    lamps.scene.environment.texels.clear();
    EXPECT_TRUE(build_light_tree(lamps.scene, KIND_SKY | KIND_SUN).nodes.empty()) << "constant: no candidate";
}

TEST(LightTree, TrailsLeadToEveryLight) {
    Lamps lamps = random_lamps(700, 2);
    lamps.point({0, 0, 0}, dvec3(1));
    lamps.sun({0, 1, 0}, dvec3(1), 0.01);
    lamps.sun({0, 1, 1}, dvec3(1), 0);
    lamps.sky();
    const LightTree tree = build_light_tree(lamps.scene, KINDS_ALL);
    std::set<u32> leaves;
    for (u32 light = 0; light < tree.places.size(); ++light) {
        const u32 first = leaf_of(tree, light);
        EXPECT_LE(light - first, 1u);
        leaves.insert(first);
    }
    EXPECT_EQ(leaves.size(), leaf_count(tree));
}

TEST(LightTree, NoTrailIsLongerThanItsBits) {
    // Ever closer and brighter lamps, which splits by cost peel off one by one; lamps of one place.
    Lamps chain, pile;
    for (int i = 0; i < 120; ++i)
        chain.point(dvec3(std::pow(0.7, i), 0, 0), dvec3(std::pow(1.5, i)));
    for (int i = 0; i < 5000; ++i)
        pile.point(dvec3(0.3, 0.2, 0.1), dvec3(1));
    for (const Lamps& lamps : {chain, pile}) {
        const LightTree tree = build_light_tree(lamps.scene, KINDS_ALL);
        EXPECT_LE(light_tree_depth(tree), LIGHT_TRAIL_NODES);
        for (u32 light = 0; light < lamps.scene.lights.size(); ++light)
            EXPECT_EQ(leaf_of(tree, light), light);
    }
}

TEST(LightTree, SpheresHoldAllLightsBelow) {
    const Lamps lamps = random_lamps(300, 3);
    const LightTree tree = build_light_tree(lamps.scene, KINDS_ALL);
    for (u32 light = 0; light < lamps.scene.emitters.size(); ++light) {
        const Triangle& t = lamps.scene.triangles[lamps.scene.emitters[light].triangle];
        const dvec3 p0 = to_dvec3(lamps.scene.positions[t.v0]), p1 = to_dvec3(lamps.scene.positions[t.v1]),
                    p2 = to_dvec3(lamps.scene.positions[t.v2]),
                    normal = glm::normalize(glm::cross(p1 - p0, p2 - p0));
        Trail trail(tree.places[light]);
        u32 link = 0;
        while (!(link & LIGHT_LINK_LEAF)) {
            const LightNode& node = tree.nodes[link & LIGHT_LINK_INDEX];
            const size_t at = trail.next();
            for (const dvec3& p : {p0, p1, p2})
                ASSERT_LE(glm::length(p - dvec3(node.x[at], node.y[at], node.z[at])), node.radius[at] + 1e-6);
            link = node.link[at];
            double cosine = glm::dot(normal, dvec3(node.axis_x[at], node.axis_y[at], node.axis_z[at]));
            if (link & LIGHT_LINK_BOTH_SIDES)
                cosine = std::abs(cosine);
            ASSERT_GE(cosine, 1 - 0.5 * std::pow(node.chord[at], 2) - 1e-5);
            ASSERT_GT(node.end[at], at == 0 ? 0 : node.end[at - 1]);
        }
    }
}

TEST(LightTree, ThreadsAndUnitsChangeNoBit) {
    Lamps lamps = random_lamps(20000, 4);
    const LightTree tree = build_light_tree(lamps.scene, KINDS_ALL);
    {
        tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        const LightTree alone = build_light_tree(lamps.scene, KINDS_ALL);
        EXPECT_TRUE(same_bytes(tree.nodes, alone.nodes) && same_bytes(tree.places, alone.places));
    }
    for (EmittedRadiance& emitted : lamps.scene.emitted)
        emitted.mean *= 1048576;
    const LightTree brighter = build_light_tree(lamps.scene, KINDS_ALL);
    EXPECT_TRUE(same_bytes(tree.nodes, brighter.nodes));
}

TEST(LightTree, SharesWithinALeafRiseToTheWhole) {
    Lamps lamps;
    lamps.quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, dvec3(2));
    lamps.point({0, 0, 3}, dvec3(1));
    lamps.finish();
    const LightTree tree = build_light_tree(lamps.scene, KINDS_ALL);
    EXPECT_EQ(tree.places[0].end, 0x80000000u);
    EXPECT_EQ(tree.places[1].end, LIGHT_LEAF_END);
    EXPECT_EQ(tree.places[2].end, LIGHT_LEAF_END);
    EXPECT_FLOAT_EQ(tree.places[0].density, 0.5f);
    EXPECT_EQ(tree.places[2].density, 1.0f);
}

namespace {

/// A cube of lamps of one object around the origin, its sides at `half`, shining inward or outward.
Lamps cube_of_lamps(double half, bool inward, int sides = 6) {
    Lamps lamps;
    for (int side = 0; side < sides; ++side) {
        dvec3 normal(0), u(0);
        normal[side / 2] = side % 2 ? 1 : -1;
        u[(side / 2 + 1) % 3] = half;
        const dvec3 v = glm::cross(inward ? -normal : normal, u);
        lamps.quad(half * normal, u, v, dvec3(1));
    }
    for (Triangle& t : lamps.scene.triangles)
        t.object = t.material = 0;
    lamps.finish();
    lamps.scene.radius = 1;
    return lamps;
}

} // namespace

TEST(LightTree, AGlowingDomeIsOneLampAllAround) {
    EXPECT_TRUE(is_glowing_dome(cube_of_lamps(0.6, true).scene, KINDS_ALL));
    EXPECT_FALSE(is_glowing_dome(cube_of_lamps(0.6, false).scene, KINDS_ALL)) << "a lamp seen from outside";
    EXPECT_FALSE(is_glowing_dome(cube_of_lamps(0.1, true).scene, KINDS_ALL)) << "the scene is around it";
    EXPECT_TRUE(is_glowing_dome(cube_of_lamps(0.6, true, 5).scene, KINDS_ALL)) << "open on one side";
    for (const int sides : {1, 2, 3, 4})
        EXPECT_FALSE(is_glowing_dome(cube_of_lamps(0.6, true, sides).scene, KINDS_ALL)) << sides;
    Lamps two = cube_of_lamps(0.6, true);
    two.scene.triangles.back().object = 1;
    EXPECT_FALSE(is_glowing_dome(two.scene, KINDS_ALL)) << "two objects";
    Lamps lit = cube_of_lamps(0.6, true);
    lit.point({0, 0, 0}, dvec3(1));
    EXPECT_FALSE(is_glowing_dome(lit.scene, KINDS_ALL)) << "and a point";
    EXPECT_TRUE(is_glowing_dome(lit.scene, KIND_AREA)) << "which nobody asks for";
}
