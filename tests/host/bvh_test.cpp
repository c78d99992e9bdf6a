// SPDX-License-Identifier: Apache-2.0
// The trees are complete, exact and bounded for ordinary and for hostile input, in every layout.
#include "bvh/binary_tree.h"
#include "bvh/binned_split.h"
#include "bvh/layout.h"
#include "host/bvh_support.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace clrt {
namespace {

// What traversals reserve: for children in bvh8, for groups of children in cwbvh. bvh2 restarts where its
// stack is short.
size_t stack_entries(BvhLayout layout) {
    return layout == BvhLayout::BVH8   ? 7 * BVH_MAX_DEPTH + 1
           : layout == BvhLayout::BVH2 ? BVH_MAX_DEPTH
                                       : CWBVH_MAX_LEVELS;
}

size_t max_leaf(BvhLayout layout) {
    return layout == BvhLayout::BVH8   ? BVH8_WIDTH
           : layout == BvhLayout::BVH2 ? BVH2_LEAF_TRIANGLES
                                       : CWBVH_LEAF_TRIANGLES;
}

struct Bounds {
    double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY};
    void extend(const double* l, const double* u) {
        for (int axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], l[axis]);
            upper[axis] = std::max(upper[axis], u[axis]);
        }
    }
    void cut(const Bounds& other) {
        for (int axis = 0; axis < 3; ++axis) {
            lower[axis] = std::max(lower[axis], other.lower[axis]);
            upper[axis] = std::min(upper[axis], other.upper[axis]);
        }
    }
    double half_area() const {
        const double x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
        return x * y + y * z + z * x;
    }
};

struct TreeFacts {
    std::vector<int> seen; // how often each triangle is in a leaf
    size_t nodes = 0, leaves = 0;
    int levels = 0;
    size_t wrong_boxes = 0;     // not exactly the bounds of what is below, in cwbvh not around them
    size_t wrong_corners = 0;   // leaf triangles that differ from the mesh
    size_t unsorted_leaves = 0; // or with a triangle twice
    size_t oversized_leaves = 0;
    size_t most_pending = 0; // entries of a traversal that pushes what it does not visit at once
    double area_tested = 0;
    std::vector<std::vector<Bounds>>
        parts; // for each leaf with the triangle, what a ray must meet to get there
};

// Whether boxes are neither the triangles' nor those of the boxes below.
bool has_loose_boxes(const Bvh& bvh) {
    return bvh.layout == BvhLayout::CWBVH && bvh.quality == BvhQuality::HIGH;
}

// `reach` is what is in the leaf's box and in those of all nodes above.
Bounds check_leaf(const Mesh& mesh, const DecodedChild& child, size_t max_leaf, bool high,
                  const Bounds& reach, TreeFacts& facts) {
    Bounds bounds, box;
    box.extend(child.lower, child.upper);
    ++facts.leaves;
    facts.oversized_leaves += child.triangles.empty() || child.triangles.size() > max_leaf;
    std::int64_t previous = -1;
    for (const LeafTriangle& triangle : child.triangles) {
        facts.unsorted_leaves += triangle.index <= previous;
        previous = triangle.index;
        ++facts.seen.at(triangle.index);
        facts.parts.at(triangle.index).push_back(reach);
        const LeafTriangle expected = triangle_of(mesh, triangle.index);
        for (size_t corner = 0; corner < 3; ++corner) {
            facts.wrong_corners += triangle.corners[corner] != expected.corners[corner];
            bounds.extend(expected.corners[corner].data(), expected.corners[corner].data());
        }
    }
    return high ? box : bounds; // spatial splits cut the boxes; uncovered_points looks at those
}

Bounds check_node(const Mesh& mesh, const Bvh& bvh, u32 node, int level, size_t pending, const Bounds& reach,
                  TreeFacts& facts) {
    const bool quantised = bvh.layout == BvhLayout::CWBVH;
    ++facts.nodes;
    facts.levels = std::max(facts.levels, level);
    const std::vector<DecodedChild> children = decode_children(bvh, node);
    // A cwbvh traversal tests leaves at once, and keeps what is left of inner children as one entry.
    const size_t waiting = quantised ? size_t(std::count_if(children.begin(), children.end(),
                                                            [](const DecodedChild& c) { return !c.is_leaf; }))
                                     : children.size();
    const size_t left_behind = waiting > 0 ? waiting - 1 : 0;
    const size_t pushed = pending + (quantised ? std::min(left_behind, size_t(1)) : left_behind);
    facts.most_pending = std::max(facts.most_pending, pushed);
    Bounds all;
    for (const DecodedChild& child : children) {
        Bounds below;
        below.extend(child.lower, child.upper);
        below.cut(reach);
        const Bounds bounds =
            child.is_leaf
                ? check_leaf(mesh, child, max_leaf(bvh.layout), bvh.quality == BvhQuality::HIGH, below, facts)
                : check_node(mesh, bvh, child.node, level + 1, pushed, below, facts);
        for (int axis = 0; axis < 3 && !has_loose_boxes(bvh); ++axis)
            facts.wrong_boxes +=
                quantised
                    ? bounds.lower[axis] < child.lower[axis] || bounds.upper[axis] > child.upper[axis]
                    : bounds.lower[axis] != child.lower[axis] || bounds.upper[axis] != child.upper[axis];
        const double tests = child.is_leaf ? leaf_tests(bvh.layout, child.triangles.size()) : 1.0;
        facts.area_tested += tests * bounds.half_area();
        all.extend(bounds.lower, bounds.upper);
    }
    if (node == 0) {
        facts.area_tested = !children.empty() && all.half_area() > 0
                                ? facts.area_tested / all.half_area() + 1 // the root's own test
                                : 0;
    }
    return all;
}

// Whether the builder should keep a triangle.
bool is_usable(const Mesh& mesh, u32 index) {
    const LeafTriangle t = triangle_of(mesh, index);
    for (const Point& corner : t.corners)
        for (double x : corner)
            if (!(std::abs(x) <= BVH_EMPTY))
                return false;
    return t.corners[0] != t.corners[1] && t.corners[1] != t.corners[2] && t.corners[2] != t.corners[0];
}

// Points of the triangle that no leaf's boxes hold. Corners, points of the edges, others; double
// rounds them by far less than a cut could lose.
size_t uncovered_points(const Mesh& mesh, u32 index, const std::vector<Bounds>& parts) {
    const LeafTriangle t = triangle_of(mesh, index);
    std::mt19937 random(index);
    std::uniform_real_distribution<double> uniform(0, 1);
    size_t uncovered = 0;
    for (int i = 0; i < 30; ++i) {
        double weights[3] = {uniform(random), uniform(random), uniform(random)};
        weights[i % 3] = i < 15 ? 0 : weights[i % 3];
        weights[(i + 1) % 3] = i < 3 ? 0 : weights[(i + 1) % 3];
        const double sum = weights[0] + weights[1] + weights[2];
        bool covered = false;
        for (const Bounds& part : parts) {
            bool inside = true;
            for (size_t axis = 0; axis < 3; ++axis) {
                double x = 0, largest = 0;
                for (size_t corner = 0; corner < 3; ++corner) {
                    x += weights[corner] / sum * t.corners[corner][axis];
                    largest = std::max(largest, std::abs(t.corners[corner][axis]));
                }
                const double slack = 0x1p-49 * largest;
                inside = inside && x >= part.lower[axis] - slack && x <= part.upper[axis] + slack;
            }
            covered = covered || inside;
        }
        uncovered += !covered;
    }
    return uncovered;
}

TreeFacts check_tree(const Mesh& mesh, const Bvh& bvh) {
    const bool wide = bvh.layout == BvhLayout::BVH8, high = bvh.quality == BvhQuality::HIGH;
    SCOPED_TRACE(name_of(bvh.layout));
    SCOPED_TRACE(high ? "high" : "fast");
    TreeFacts facts;
    facts.seen.resize(mesh.triangles.size());
    facts.parts.resize(mesh.triangles.size());
    Bounds everywhere;
    std::swap(everywhere.lower, everywhere.upper);
    check_node(mesh, bvh, 0, 1, 0, everywhere, facts);
    size_t usable = 0, wrongly_seen = 0, entries = 0, uncovered = 0;
    for (u32 i = 0; i < mesh.triangles.size(); ++i) {
        const int expected = is_usable(mesh, i) ? 1 : 0;
        usable += size_t(expected);
        wrongly_seen += high ? std::min(facts.seen[i], 1) != expected : facts.seen[i] != expected;
        entries += size_t(facts.seen[i]);
        if (facts.seen[i] > 1 || (facts.seen[i] == 1 && has_loose_boxes(bvh)))
            uncovered += uncovered_points(mesh, i, facts.parts[i]);
    }
    EXPECT_EQ(wrongly_seen, 0u);
    EXPECT_EQ(uncovered, 0u);
    EXPECT_EQ(bvh.triangle_count, usable);
    EXPECT_LE(entries, bvh.reference_count); // parts of a triangle that met in a block are one entry
    EXPECT_LE(double(bvh.reference_count), (high ? MOST_REFERENCES : 1.0) * double(mesh.triangles.size()));
    EXPECT_EQ(facts.wrong_boxes, 0u);
    EXPECT_EQ(facts.wrong_corners, 0u);
    EXPECT_EQ(facts.unsorted_leaves, 0u);
    EXPECT_EQ(facts.oversized_leaves, 0u);
    EXPECT_EQ(facts.nodes * node_words(bvh.layout), bvh.nodes.size());
    EXPECT_EQ(wide ? facts.leaves * BVH8_BLOCK_WORDS : entries * LEAF_TRIANGLE_WORDS, bvh.leaves.size());
    EXPECT_LE(bvh.depth, BVH_MAX_DEPTH);
    EXPECT_LE(facts.levels, std::max(bvh.depth, 1));
    EXPECT_LT(facts.most_pending, stack_entries(bvh.layout));
    if (bvh.layout == BvhLayout::CWBVH) {
        EXPECT_LE(facts.levels, CWBVH_MAX_LEVELS);
    }
    if (!has_loose_boxes(bvh)) {
        EXPECT_NEAR(bvh.sah_cost, facts.area_tested, 1e-6 * facts.area_tested);
    }
    return facts;
}

constexpr BvhQuality BOTH_QUALITIES[] = {BvhQuality::FAST, BvhQuality::HIGH};

TreeFacts check_layout(const Mesh& mesh, BvhLayout layout, BvhQuality quality = BvhQuality::FAST) {
    return check_tree(mesh, build_bvh(mesh.positions, mesh.triangles, layout, quality));
}

void check_all(const Mesh& mesh) {
    for (BvhLayout layout : ALL_LAYOUTS)
        for (BvhQuality quality : BOTH_QUALITIES)
            check_layout(mesh, layout, quality);
}

// A triangle of size 2^-k near 2^-k on the diagonal.
void add_link(Mesh& mesh, int k) {
    const float x = std::ldexp(1.0f, -k);
    mesh.add({x, x, x, 0}, {1.5f * x, x, x, 0}, {x, 1.5f * x, 1.25f * x, 0});
}

// Long thin triangles in all directions.
Mesh needles(int count, unsigned seed) {
    Mesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(-1, 1);
    for (int i = 0; i < count; ++i) {
        const float x = uniform(random), y = uniform(random), z = uniform(random);
        const float length = 0.4f * uniform(random);
        mesh.add({x, y, z, 0}, {x + 1e-3f, y, z, 0},
                 {x + length, y + length * uniform(random), z + length * uniform(random), 0});
    }
    return mesh;
}

TEST(Bvh, NeedlesAreCompleteAndExact) {
    check_all(needles(50000, 12));
}

TEST(Bvh, BallIsCompleteAndExact) {
    check_all(bumpy_ball(150));
}

TEST(Bvh, SoupIsCompleteAndExact) {
    check_all(random_soup(100000, 0.03f, 1));
}

TEST(Bvh, SmallScenesOfEverySizeAreComplete) {
    for (int count = 1; count <= 70; ++count)
        check_all(random_soup(count, 0.3f, unsigned(count)));
}

TEST(Bvh, EmptySceneIsARootWithoutChildren) {
    for (BvhLayout layout : ALL_LAYOUTS) {
        const Bvh bvh = build_bvh({}, {}, layout);
        check_tree(Mesh{}, bvh);
        EXPECT_EQ(bvh.nodes.size(), node_words(layout));
        EXPECT_TRUE(decode_children(bvh, 0).empty());
        EXPECT_EQ(bvh.sah_cost, 0);
        EXPECT_EQ(bvh.depth, 0);
    }
}

TEST(Bvh, SingleTriangleIsALeafOfTheRoot) {
    Mesh mesh;
    mesh.add({0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0});
    check_all(mesh);
    const Bvh bvh = build_bvh(mesh.positions, mesh.triangles, BvhLayout::BVH8);
    EXPECT_EQ(decode_children(bvh, 0).size(), 1u);
    EXPECT_EQ(bvh.sah_cost, 2); // the root and one block
    EXPECT_EQ(bvh.depth, 1);
}

TEST(Bvh, FewTrianglesAreBlocksOfTheRoot) {
    // The inside of a box of 12 triangles with two smaller boxes in it, as many as a Cornell box has.
    Mesh mesh;
    const auto add_box = [&](float x, float y, float z, float size) {
        const u32 first = u32(mesh.positions.size());
        for (int i = 0; i < 8; ++i)
            mesh.positions.push_back(
                {x + (i & 1 ? size : 0), y + (i & 2 ? size : 0), z + (i & 4 ? size : 0), 0});
        for (const auto& face : {std::array<u32, 4>{0, 1, 3, 2},
                                 {4, 5, 7, 6},
                                 {0, 1, 5, 4},
                                 {2, 3, 7, 6},
                                 {0, 2, 6, 4},
                                 {1, 3, 7, 5}}) {
            mesh.add(first + face[0], first + face[1], first + face[2]);
            mesh.add(first + face[0], first + face[2], first + face[3]);
        }
    };
    add_box(-1, -1, -1, 2);
    add_box(-0.7f, -1, -0.5f, 0.6f);
    add_box(0.2f, -1, 0.1f, 0.6f);
    const TreeFacts facts = check_layout(mesh, BvhLayout::BVH8);
    EXPECT_EQ(facts.nodes, 1u);
    EXPECT_LE(facts.leaves, 8u);
}

void expect_same_bits_for_any_threads(const Mesh& mesh, BvhLayout layout, BvhQuality quality) {
    std::vector<Bvh> trees;
    for (size_t threads : {1, 2, 5}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        trees.push_back(build_bvh(mesh.positions, mesh.triangles, layout, quality));
    }
    for (const Bvh& tree : trees) {
        EXPECT_TRUE(tree.nodes == trees[0].nodes);
        EXPECT_TRUE(tree.leaves == trees[0].leaves);
        EXPECT_EQ(tree.sah_cost, trees[0].sah_cost);
    }
    check_tree(mesh, trees[0]);
}

TEST(Bvh, BitsDoNotDependOnTheNumberOfThreads) {
    const Mesh mesh = random_soup(300000, 0.02f, 3);
    for (BvhLayout layout : ALL_LAYOUTS)
        expect_same_bits_for_any_threads(mesh, layout, BvhQuality::FAST);
}

TEST(Bvh, BitsOfSpatialSplitsDoNotDependOnTheNumberOfThreads) {
    // The first splits, which several threads share, are spatial.
    const Mesh mesh = needles(100000, 3);
    for (BvhLayout layout : ALL_LAYOUTS)
        expect_same_bits_for_any_threads(mesh, layout, BvhQuality::HIGH);
}

void expect_same_tree_at_any_scale(const Mesh& mesh, BvhLayout layout, BvhQuality quality) {
    const Bvh original = build_bvh(mesh.positions, mesh.triangles, layout, quality);
    for (int exponent : {-90, -20, 23, 55}) {
        Mesh scaled = mesh;
        const float scale = std::ldexp(1.0f, exponent);
        for (vec4& p : scaled.positions)
            p = {p.x * scale, p.y * scale, p.z * scale, 0};
        const Bvh bvh = build_bvh(scaled.positions, scaled.triangles, layout, quality);
        check_tree(scaled, bvh);
        ASSERT_EQ(bvh.nodes.size(), original.nodes.size());
        EXPECT_EQ(bvh.sah_cost, original.sah_cost);
    }
}

TEST(Bvh, ScalingByAPowerOfTwoKeepsTheTree) {
    const Mesh mesh = random_soup(3000, 0.1f, 4);
    for (BvhLayout layout : ALL_LAYOUTS)
        for (BvhQuality quality : BOTH_QUALITIES)
            expect_same_tree_at_any_scale(mesh, layout, quality);
}

TEST(Bvh, SpatialSplitsCutLongTriangles) {
    const Mesh mesh = needles(20000, 11);
    for (BvhLayout layout : ALL_LAYOUTS) {
        const Bvh fast = build_bvh(mesh.positions, mesh.triangles, layout);
        const Bvh high = build_bvh(mesh.positions, mesh.triangles, layout, BvhQuality::HIGH);
        EXPECT_EQ(fast.reference_count, fast.triangle_count);
        EXPECT_GT(high.reference_count, high.triangle_count * 11 / 10);
        EXPECT_LT(high.sah_cost, 0.95 * fast.sah_cost) << name_of(layout);
    }
}

TEST(Bvh, UnusableTrianglesAreLeftOut) {
    Mesh mesh = random_soup(2000, 0.1f, 5);
    const float nan = std::nanf(""), inf = INFINITY;
    for (float bad : {nan, inf, -inf, 2e18f}) {
        mesh.add({bad, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0});
        mesh.add({0, 0, 0, 0}, {1, bad, 0, 0}, {0, 1, 0, 0});
        mesh.add({0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, bad, 0});
    }
    mesh.add({1, 2, 3, 0}, {1, 2, 3, 0}, {0, 1, 0, 0}); // a corner twice
    mesh.add({1, 2, 3, 0}, {1, 2, 3, 0}, {1, 2, 3, 0});
    mesh.add(0, 1, 1);
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    check_all(mesh);
    EXPECT_EQ(build_bvh(mesh.positions, mesh.triangles, BvhLayout::BVH8).triangle_count, 2000u);
}

TEST(Bvh, OnlyUnusableTrianglesGiveAnEmptyTree) {
    Mesh mesh;
    for (int i = 0; i < 20; ++i)
        mesh.add({0, 0, 0, 0}, {1, float(i), 0, 0}, {0, 0, 0, 0});
    check_all(mesh);
}

TEST(Bvh, CornersInLineAreKept) {
    Mesh mesh, axis;
    for (int count = 1; count <= 100; ++count) {
        const float x = float(count);
        mesh.add({0, 0, 0, 0}, {1, x, 1, 0}, {2, 2 * x, 2, 0});
        axis.add({0, 0, 0, 0}, {x, 0, 0, 0}, {2 * x, 0, 0, 0}); // boxes without surface
        if (count < 20 || count == 100) {
            check_all(mesh);
            check_all(axis);
        }
    }
    axis.triangles.insert(axis.triangles.end(), 20000, axis.triangles[7]);
    check_all(axis);
    EXPECT_EQ(build_bvh(mesh.positions, mesh.triangles, BvhLayout::BVH8).triangle_count, 100u);
}

TEST(Bvh, ShrinkingChainsStayWithinTheStack) {
    // Each size is alone, twice and many times; ascending, descending and mixed.
    for (int copies : {1, 2, 100}) {
        Mesh mesh;
        for (int i = 0; i < copies; ++i)
            for (int k = 0; k <= 120; ++k)
                add_link(mesh, k);
        check_all(mesh);
        std::reverse(mesh.triangles.begin(), mesh.triangles.end());
        check_all(mesh);
        std::stable_sort(mesh.triangles.begin(), mesh.triangles.end(),
                         [&](const Triangle& a, const Triangle& b) {
                             return mesh.positions[a.v0].x < mesh.positions[b.v0].x;
                         });
        check_all(mesh);
        std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(7));
        check_all(mesh);
    }
}

TEST(Bvh, DepthLimitHoldsWhereTheHeuristicWouldExceedIt) {
    // Chains of slivers along all axes over the whole range of floats, and many triangles where they meet:
    // peeling the chains alone would take some hundred levels.
    Mesh mesh;
    const float thin = std::ldexp(1.0f, -141);
    for (int axis = 0; axis < 3; ++axis)
        for (int k = -59; k <= 140; ++k) {
            const float x = std::ldexp(1.0f, -k);
            float corners[3][3] = {};
            for (int corner = 0; corner < 3; ++corner)
                corners[corner][axis] = corner == 1 ? 1.5f * x : x;
            corners[2][(axis + 1) % 3] = thin;
            mesh.add({corners[0][0], corners[0][1], corners[0][2], 0},
                     {corners[1][0], corners[1][1], corners[1][2], 0},
                     {corners[2][0], corners[2][1], corners[2][2], 0});
        }
    const Triangle tip = mesh.triangles.back();
    mesh.triangles.insert(mesh.triangles.end(), 20000, tip);
    check_all(mesh);
    const TreeFacts wide = check_layout(mesh, BvhLayout::BVH8);
    // As it is before reinsertion, which flattens it.
    const BinaryTree binary =
        build_binary_tree(mesh.positions, mesh.triangles, leaf_cost(BvhLayout::BVH2), TreeEffort{});
    EXPECT_EQ(binary.depth, BVH_MAX_DEPTH);
    EXPECT_GT(wide.levels, 5);
}

TEST(BinnedSplit, SeparatesTwoClustersInSmallAndLargeRanges) {
    // Large ranges are binned and partitioned by several threads.
    for (u32 count : {10u, 200u, 300000u}) {
        std::mt19937 random(10);
        std::uniform_real_distribution<float> uniform(0, 1);
        const u32 left_count = count * 3 / 10;
        std::vector<BuildItem> items;
        ItemBounds bounds;
        for (u32 i = 0; i < count; ++i) {
            const float y = (i < left_count ? 0.0f : 10.0f) + uniform(random);
            Box box;
            box.extend(Float4{uniform(random), y, uniform(random), 0});
            box.extend(Float4{uniform(random), y, uniform(random), 0});
            bounds.extend(box);
            items.emplace_back(box, i);
        }
        std::shuffle(items.begin(), items.end(), random);
        const BinMap map(bounds.centres, count);
        const BinnedSplit split = find_split(items.data(), count, bounds, map, LeafCost{0, 1, 4, 1.0f});
        EXPECT_EQ(split.axis, 1);
        ASSERT_EQ(split.left_count, left_count);
        const SplitSides sides = apply_split(items.data(), count, map, split);
        EXPECT_EQ(sides.left_count, left_count);
        EXPECT_LT(sides.left.box.upper[1], 2);
        EXPECT_GT(sides.right.centres.lower[1], 2);
        std::vector<int> seen(count);
        u32 misplaced = 0;
        for (u32 i = 0; i < count; ++i) {
            ++seen[items[i].triangle()];
            misplaced += (items[i].triangle() < left_count) != (i < left_count);
        }
        EXPECT_EQ(misplaced, 0u);
        EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(count));
    }
}

TEST(Bvh, AllCentresOnALine) {
    Mesh diagonal, axis;
    for (int i = 0; i < 50000; ++i) {
        const float x = float(i);
        diagonal.add({x, x, x, 0}, {x + 1, x, x, 0}, {x, x + 1, x, 0});
        axis.add({x, 0, 0, 0}, {x + 1, 0, 0, 0}, {x, 0, 1, 0});
    }
    check_all(diagonal);
    check_all(axis);
}

} // namespace
} // namespace clrt
