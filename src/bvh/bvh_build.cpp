// SPDX-License-Identifier: Apache-2.0
// From triangles to a device layout.
#include "bvh/binary_tree.h"
#include "bvh/bvh.h"
#include "bvh/layout.h"
#include "error.h"

#include <chrono>
#include <utility>

namespace clrt {
namespace {

// Reinsertion takes most of the overlap away that binned splits leave, in a few rounds: of a room of a
// million triangles a quarter of the cost for a third of the time.
constexpr TreeEffort OBJECT_SPLITS{false, 4};
constexpr TreeEffort MORE_ROUNDS{false, 8};
constexpr TreeEffort SPATIAL_SPLITS{true, 8};

/// A tree with cut triangles is kept if its cost is below this share of the other's.
constexpr double LARGEST_COST_SHARE = 0.95;

Bvh write_layout(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BinaryTree tree,
                 BvhLayout layout) {
    Bvh bvh;
    bvh.layout = layout;
    bvh.depth = tree.depth;
    bvh.triangle_count = tree.triangle_count;
    bvh.reference_count = tree.order.size();
    switch (layout) {
    case BvhLayout::BVH8:
        write_bvh8(positions, triangles, tree, bvh);
        break;
    case BvhLayout::BVH2:
        write_bvh2(positions, triangles, tree, bvh);
        break;
    case BvhLayout::CWBVH:
        write_cwbvh(positions, triangles, tree, bvh);
        break;
    }
    return bvh;
}

// Parts of a triangle that moves would have to be cut at every time; boxes are not cut.
BinaryTree build_high(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                      BvhLayout layout, const std::vector<vec4>& moves, const std::vector<Box>& boxes) {
    const LeafCost leaves = leaf_cost(layout);
    BinaryTree whole = build_binary_tree(positions, triangles, leaves, MORE_ROUNDS, moves, boxes);
    if (!moves.empty() || !boxes.empty())
        return whole;
    BinaryTree cut = build_binary_tree(positions, triangles, leaves, SPATIAL_SPLITS);
    const bool pays = cost_in_layout(cut, layout) <= LARGEST_COST_SHARE * cost_in_layout(whole, layout);
    return pays ? std::move(cut) : std::move(whole);
}

} // namespace

Bvh build_bvh(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BvhLayout layout,
              BvhQuality quality, const std::vector<vec4>& moves) {
    return build_bvh_with_boxes(positions, triangles, {}, layout, quality, moves);
}

Bvh build_bvh_with_boxes(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                         const std::vector<Box>& boxes, BvhLayout layout, BvhQuality quality,
                         const std::vector<vec4>& moves) {
    const auto start = std::chrono::steady_clock::now();
    // Indices of nodes and leaves have 31 bits, and each layout has at most one of either a triangle. The
    // builder rounds counts up to whole blocks in 32 signed bits.
    if (triangles.size() + boxes.size() > MOST_TRIANGLES)
        throw SceneError("scene", 0,
                         "expected at most " + std::to_string(MOST_TRIANGLES) + " triangles, found " +
                             std::to_string(triangles.size()) + "; split the scene or simplify its meshes");
    BinaryTree tree = quality == BvhQuality::HIGH ? build_high(positions, triangles, layout, moves, boxes)
                                                  : build_binary_tree(positions, triangles, leaf_cost(layout),
                                                                      OBJECT_SPLITS, moves, boxes);
    Bvh bvh = write_layout(positions, triangles, std::move(tree), layout);
    if (!moves.empty())
        write_leaf_moves(moves, triangles, bvh);
    bvh.quality = quality;
    bvh.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

} // namespace clrt
