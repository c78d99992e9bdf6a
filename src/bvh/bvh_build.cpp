// SPDX-License-Identifier: Apache-2.0
// From triangles to a device layout.
#include "bvh/binary_tree.h"
#include "bvh/bvh.h"
#include "bvh/layout.h"
#include "error.h"

#include <chrono>

namespace clrt {
namespace {

/// A tree of high quality is kept if its cost is below this share of the fast one's. Measured with eight-wide
/// nodes on PoCL: at 0.98 to 1.01 (a bunny, a sphere) rays take up to 10 % longer in it, for the memory that
/// cut triangles take; at 0.88 to 0.91 (three rooms) diffuse rays gain 0 to 10 %, while camera and shadow
/// rays gain or lose as much.
constexpr double LARGEST_COST_SHARE = 0.95;

} // namespace

Bvh build_bvh(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BvhLayout layout,
              BvhQuality quality) {
    const auto start = std::chrono::steady_clock::now();
    // Indices of nodes and leaves have 31 bits, and each layout has at most one of either a triangle. The
    // builder rounds counts up to whole blocks in 32 signed bits.
    if (triangles.size() > MOST_TRIANGLES)
        throw SceneError("scene", 0,
                         "expected at most " + std::to_string(MOST_TRIANGLES) + " triangles, found " +
                             std::to_string(triangles.size()) + "; split the scene or simplify its meshes");
    BinaryTree tree = build_binary_tree(positions, triangles, leaf_cost(layout), quality);
    Bvh bvh;
    bvh.layout = layout;
    bvh.depth = tree.depth;
    bvh.quality = quality;
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
    bvh.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

Bvh build_better_bvh(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                     BvhLayout layout) {
    Bvh fast = build_bvh(positions, triangles, layout, BvhQuality::FAST);
    Bvh high = build_bvh(positions, triangles, layout, BvhQuality::HIGH);
    const double seconds = fast.seconds + high.seconds;
    Bvh better = high.sah_cost <= LARGEST_COST_SHARE * fast.sah_cost ? std::move(high) : std::move(fast);
    better.seconds = seconds;
    return better;
}

} // namespace clrt
