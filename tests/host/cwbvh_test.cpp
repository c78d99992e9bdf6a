// SPDX-License-Identifier: Apache-2.0
// The compressed wide tree: lattices, places of children and triangles, levels.
#include "host/bvh_support.h"

#include <gtest/gtest.h>

namespace clrt {
namespace {

/// Compares a - b with `limit`, without an error: negative, 0 or positive.
int compare_difference(double a, double b, double limit) {
    const double value = a - b, b_rounded = a - value;
    const double error = (a - (value + b_rounded)) + (b_rounded - b);
    if (value != limit)
        return value < limit ? -1 : 1;
    return error < 0 ? -1 : error > 0 ? 1 : 0;
}

Bvh build(const Mesh& mesh, BvhQuality quality = BvhQuality::FAST) {
    return build_bvh(mesh.positions, mesh.triangles, BvhLayout::CWBVH, quality);
}

struct Bounds {
    float lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
    void extend(const Bounds& other) {
        for (int axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], other.lower[axis]);
            upper[axis] = std::max(upper[axis], other.upper[axis]);
        }
    }
};

Bounds bounds_of(const LeafTriangle& triangle) {
    Bounds bounds;
    for (const Point& corner : triangle.corners)
        for (size_t axis = 0; axis < 3; ++axis) {
            bounds.lower[axis] = std::min(bounds.lower[axis], float(corner[axis]));
            bounds.upper[axis] = std::max(bounds.upper[axis], float(corner[axis]));
        }
    return bounds;
}

struct LatticeFacts {
    size_t boxes = 0;
    size_t open = 0;    ///< planes that cut off a part of what is below
    size_t loose = 0;   ///< planes that are not the nearest of the lattice
    size_t coarse = 0;  ///< axes where half the step would do
    size_t origins = 0; ///< that are not the lower corner
};

/// Checks planes by the triangles below, with comparisons that do not round.
Bounds check_lattices(const Bvh& bvh, u32 index, LatticeFacts& facts) {
    const u32* node = &bvh.nodes.at(size_t(index) * CWBVH_NODE_WORDS);
    Bounds all;
    size_t slot = 0;
    for (const DecodedChild& child : decode_children(bvh, index)) {
        Bounds below;
        if (!child.is_leaf)
            below = check_lattices(bvh, child.node, facts);
        for (const LeafTriangle& triangle : child.triangles)
            below.extend(bounds_of(triangle));
        all.extend(below);
        while (byte_of(node + CWBVH_META_WORD, slot) == 0)
            ++slot;
        for (size_t axis = 0; axis < 3; ++axis) {
            const double origin = word_as_float(node[axis]), step = cwbvh_step(node, axis);
            const double lower = byte_of(node + CWBVH_LOWER_WORD + 2 * axis, slot);
            const double upper = byte_of(node + CWBVH_UPPER_WORD + 2 * axis, slot);
            facts.open += compare_difference(below.lower[axis], origin, lower * step) < 0;
            facts.open += compare_difference(below.upper[axis], origin, upper * step) > 0;
            facts.loose += compare_difference(below.lower[axis], origin, (lower + 1) * step) >= 0;
            facts.loose +=
                upper > 0 && compare_difference(below.upper[axis], origin, (upper - 1) * step) <= 0;
        }
        ++facts.boxes;
        ++slot;
    }
    for (size_t axis = 0; axis < 3; ++axis) {
        const double step = cwbvh_step(node, axis);
        facts.origins += all.lower[axis] != word_as_float(node[axis]);
        facts.coarse += step > std::ldexp(1.0, CWBVH_SMALLEST_EXPONENT) &&
                        compare_difference(all.upper[axis], all.lower[axis], 255 * step / 2) <= 0;
    }
    return all;
}

void expect_tight_lattices(const Mesh& mesh) {
    LatticeFacts facts;
    const Bvh bvh = build(mesh);
    check_lattices(bvh, 0, facts);
    EXPECT_GE(facts.boxes, mesh.triangles.size() / CWBVH_LEAF_TRIANGLES);
    EXPECT_EQ(facts.open, 0u);
    EXPECT_EQ(facts.loose, 0u);
    EXPECT_EQ(facts.coarse, 0u);
    EXPECT_EQ(facts.origins, 0u);
}

/// Levels of wide nodes below and with this one.
int levels(const Bvh& bvh, u32 node) {
    int deepest = 0;
    for (const DecodedChild& child : decode_children(bvh, node))
        if (!child.is_leaf)
            deepest = std::max(deepest, levels(bvh, child.node));
    return deepest + 1;
}

/// A path of 58 binary levels that shrinks to an eighth at each, beside which 64 triangles of much larger
/// area stand: the cheapest wide nodes spend their slots on those and take one level of the path at a time.
Mesh long_path() {
    Mesh mesh;
    for (int k = 0; k < 58; ++k)
        for (int i = 0; i < 64; ++i) {
            const float s = std::ldexp(1.0f, 58 - 3 * k), step = s / 8;
            const float y = float(i % 8) * step, z = float(i / 8) * step;
            mesh.add({0.9f * s, y, z, 0}, {s, y + step / 2, z, 0}, {0.95f * s, y, z + step / 2, 0});
        }
    return mesh;
}

} // namespace

TEST(Cwbvh, LatticesEncloseExactlyAndTightly) {
    expect_tight_lattices(bumpy_ball(100));
    expect_tight_lattices(random_soup(20000, 0.05f, 1));
}

// Coordinates whose differences no double holds: huge beside tiny, and either sign.
TEST(Cwbvh, LatticesEncloseExactlyWhereDifferencesRound) {
    Mesh mesh;
    std::mt19937 random(2);
    const auto coordinate = [&] {
        const float size = std::ldexp(1.0f + float(random() % 4096) / 4096, int(random() % 140) - 90);
        return random() & 1 ? size : -size;
    };
    for (int i = 0; i < 20000; ++i) {
        const vec4 a{coordinate(), coordinate(), coordinate(), 0},
            b{coordinate(), coordinate(), coordinate(), 0};
        mesh.add(a, b, {coordinate(), coordinate(), coordinate(), 0});
    }
    expect_tight_lattices(mesh);
}

void expect_children_by_slot(const Bvh& bvh) {
    std::vector<int> children_seen(bvh.nodes.size() / CWBVH_NODE_WORDS),
        triangles_seen(bvh.leaves.size() / LEAF_TRIANGLE_WORDS);
    for (u32 index = 0; index < children_seen.size(); ++index) {
        const u32* node = &bvh.nodes[size_t(index) * CWBVH_NODE_WORDS];
        u32 next_place = 0, child = node[CWBVH_CHILD_WORD];
        for (u32 slot = 0; slot < BVH8_WIDTH; ++slot) {
            const u32 meta = byte_of(node + CWBVH_META_WORD, slot);
            const bool is_inner = byte_of(node + CWBVH_EXPONENT_WORD, 3) >> slot & 1u;
            ASSERT_EQ(is_inner, meta == (CWBVH_INNER_META | slot));
            if (is_inner) {
                ++children_seen.at(child++);
            } else if (meta != 0) {
                const u32 unary = meta >> CWBVH_COUNT_SHIFT;
                ASSERT_TRUE(unary == 1 || unary == 3 || unary == 7);
                ASSERT_EQ(meta & 31u, next_place);
                for (u32 i = 0; unary >> i; ++i)
                    ++triangles_seen.at(node[CWBVH_TRIANGLE_WORD] + next_place++);
            } else {
                for (size_t plane = 0; plane < 6; ++plane)
                    EXPECT_EQ(byte_of(node + CWBVH_LOWER_WORD + 2 * plane, slot), 0u);
            }
        }
    }
    EXPECT_EQ(children_seen[0], 0);
    EXPECT_EQ(std::count(children_seen.begin() + 1, children_seen.end(), 1),
              std::ptrdiff_t(children_seen.size() - 1));
    EXPECT_EQ(std::count(triangles_seen.begin(), triangles_seen.end(), 1),
              std::ptrdiff_t(triangles_seen.size()));
}

TEST(Cwbvh, SiblingsAndTrianglesFollowEachOtherBySlot) {
    const Mesh mesh = random_soup(5000, 0.1f, 3);
    for (const BvhQuality quality : {BvhQuality::FAST, BvhQuality::HIGH})
        expect_children_by_slot(build(mesh, quality));
}

TEST(Cwbvh, LevelsStayWithinTheStackWhereTheCheapestTreeWouldNot) {
    const Mesh mesh = long_path();
    const Bvh bvh = build(mesh);
    EXPECT_GT(bvh.depth, 3 * CWBVH_MAX_LEVELS - 6);
    // At the least cost it would be deeper: the eight-wide tree of the same triangles, whose levels are free,
    // is.
    EXPECT_GT(levels(build_bvh(mesh.positions, mesh.triangles, BvhLayout::BVH8), 0), CWBVH_MAX_LEVELS);
    EXPECT_LE(levels(bvh, 0), CWBVH_MAX_LEVELS);
    EXPECT_GE(levels(bvh, 0), CWBVH_MAX_LEVELS - 2);
    EXPECT_LE(levels(build(mesh, BvhQuality::HIGH), 0), CWBVH_MAX_LEVELS);
}

TEST(Cwbvh, AnOrdinaryTreeIsTheCheapest) {
    // The bound on levels is far away.
    const Mesh mesh = random_soup(200000, 0.02f, 4);
    EXPECT_LE(levels(build(mesh), 0), CWBVH_MAX_LEVELS / 2);
}

} // namespace clrt
