// SPDX-License-Identifier: Apache-2.0
// Moving subtrees makes trees better, keeps every leaf, and never makes them too deep.
#include "bvh/reinsertion.h"
#include "host/bvh_support.h"

#include <gtest/gtest.h>
#include <numeric>
#include <tbb/global_control.h>

namespace clrt {
namespace {

constexpr LeafCost COST{0, 1, 4, 1.0f};
constexpr int ROUNDS = 4;

double inner_area(const BinaryTree& tree) {
    double sum = 0;
    for (u32 i = 0; i < tree.node_count; ++i)
        sum += tree.nodes[i].child != 0 ? half_area(tree.nodes[i]) : 0;
    return sum;
}

struct Subtree {
    u32 count;
    int depth;
};

// Checks counts and boxes; gives what the root must say.
Subtree check_subtree(const BinaryTree& tree, u32 node) {
    const BinaryNode& n = tree.nodes[node];
    if (n.child == 0)
        return {n.count, 1};
    const Subtree left = check_subtree(tree, n.child), right = check_subtree(tree, n.child + 1);
    EXPECT_EQ(n.count, left.count + right.count);
    for (int axis = 0; axis < 3; ++axis) {
        const BinaryNode &a = tree.nodes[n.child], &b = tree.nodes[n.child + 1];
        EXPECT_EQ(n.lower[axis], std::min(a.lower[axis], b.lower[axis]));
        EXPECT_EQ(n.upper[axis], std::max(a.upper[axis], b.upper[axis]));
    }
    return {n.count, 1 + std::max(left.depth, right.depth)};
}

void check_tree(const BinaryTree& tree, u32 triangles) {
    const Subtree root = check_subtree(tree, 0);
    EXPECT_EQ(root.count, tree.order.size());
    EXPECT_EQ(root.depth, tree.depth);
    EXPECT_LE(tree.depth, BVH_MAX_DEPTH);
    std::vector<u32> sorted = tree.order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<u32> all(triangles);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(sorted, all);
}

// Fits the boxes to the triangles of the leaves.
void refit(const Mesh& mesh, BinaryTree& tree, u32 node, u32 begin) {
    BinaryNode& n = tree.nodes[node];
    std::fill_n(n.lower, 3, INFINITY);
    std::fill_n(n.upper, 3, -INFINITY);
    const auto extend = [&](int axis, float lower, float upper) {
        n.lower[axis] = std::min(n.lower[axis], lower);
        n.upper[axis] = std::max(n.upper[axis], upper);
    };
    for (u32 i = begin; n.child == 0 && i < begin + n.count; ++i)
        for (const Point& corner : triangle_of(mesh, tree.order[i]).corners)
            for (int axis = 0; axis < 3; ++axis)
                extend(axis, float(corner[size_t(axis)]), float(corner[size_t(axis)]));
    if (n.child == 0)
        return;
    refit(mesh, tree, n.child, begin);
    refit(mesh, tree, n.child + 1, begin + tree.nodes[n.child].count);
    for (u32 child : {n.child, n.child + 1})
        for (int axis = 0; axis < 3; ++axis)
            extend(axis, tree.nodes[child].lower[axis], tree.nodes[child].upper[axis]);
}

TEST(Reinsertion, ShrinksInnerNodesOfGoodTrees) {
    for (const Mesh& mesh : {random_soup(20000, 0.2f, 1), random_soup(20000, 0.01f, 2)}) {
        BinaryTree tree = build_binary_tree(mesh.positions, mesh.triangles, COST, TreeEffort{});
        const double before = inner_area(tree);
        reinsert_subtrees(tree, ROUNDS);
        check_tree(tree, u32(mesh.triangles.size()));
        EXPECT_LT(inner_area(tree), before);
    }
}

TEST(Reinsertion, RepairsTreesWithMisplacedLeaves) {
    const Mesh mesh = random_soup(20000, 0.01f, 3);
    BinaryTree tree = build_binary_tree(mesh.positions, mesh.triangles, COST, TreeEffort{});
    const double good = inner_area(tree);
    std::mt19937 random(3);
    for (int i = 0; i < 100; ++i)
        std::swap(tree.order[random() % tree.order.size()], tree.order[random() % tree.order.size()]);
    refit(mesh, tree, 0, 0);
    const double bad = inner_area(tree);
    EXPECT_GT(bad, 1.5 * good);
    reinsert_subtrees(tree, ROUNDS);
    check_tree(tree, u32(mesh.triangles.size()));
    EXPECT_LT(inner_area(tree), good + 0.5 * (bad - good));
}

TEST(Reinsertion, SmallTreesAndEqualBoxesStayWhole) {
    Mesh mesh;
    for (int count = 1; count < 60; ++count) {
        mesh.add({0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0.5f, 0});
        BinaryTree tree = build_binary_tree(mesh.positions, mesh.triangles, COST, TreeEffort{});
        reinsert_subtrees(tree, ROUNDS);
        check_tree(tree, u32(count));
    }
}

// Stopping a refit where a box stays as it was must leave no ancestor behind.
TEST(Reinsertion, BoxesAreTheUnionsOfTheirChildrenAfterManyRounds) {
    for (const bool spatial : {false, true}) {
        const Mesh mesh = random_soup(30000, 0.2f, 7);
        BinaryTree tree =
            build_binary_tree(mesh.positions, mesh.triangles, COST, TreeEffort{spatial, 3 * ROUNDS});
        EXPECT_EQ(check_subtree(tree, 0).count, tree.order.size());
    }
}

TEST(Reinsertion, GivesTheSameTreeForAnyThreads) {
    const Mesh mesh = random_soup(50000, 0.1f, 4);
    std::vector<std::vector<u32>> orders;
    for (size_t threads : {1, 2, 5}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        orders.push_back(
            build_binary_tree(mesh.positions, mesh.triangles, COST, TreeEffort{true, ROUNDS}).order);
    }
    EXPECT_EQ(orders[0], orders[1]);
    EXPECT_EQ(orders[0], orders[2]);
}

} // namespace
} // namespace clrt
