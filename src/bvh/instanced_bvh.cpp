// SPDX-License-Identifier: Apache-2.0
#include "bvh/instanced_bvh.h"

#include "bvh/binary_tree.h"
#include "bvh/instance_bounds.h"
#include "bvh/layout.h"
#include "error.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <utility>

namespace clrt {
namespace {

using Triangles = std::vector<Triangle>;

Triangles triangles_of(const Triangles& all, const Prototype& prototype) {
    const auto first = all.begin() + std::ptrdiff_t(prototype.first_triangle);
    return Triangles(first, first + std::ptrdiff_t(prototype.triangle_count));
}

// The sizes of a layout's nodes and leaves in words.
size_t node_words(BvhLayout layout) {
    return layout == BvhLayout::BVH8   ? BVH8_NODE_WORDS
           : layout == BvhLayout::BVH2 ? BVH2_NODE_WORDS
                                       : CWBVH_NODE_WORDS;
}
size_t leaf_words(BvhLayout layout) {
    return layout == BvhLayout::BVH8 ? BVH8_BLOCK_WORDS : LEAF_TRIANGLE_WORDS;
}

/// Moves what a prototype's tree names to where it will be: nodes, leaves and triangles by so many.
struct Relocation {
    u32 nodes, leaves, triangles;

    void child(u32& reference) const { reference += reference & BVH_LEAF_BIT ? leaves : nodes; }

    void node(BvhLayout layout, u32* words) const {
        if (layout == BvhLayout::CWBVH) {
            words[CWBVH_CHILD_WORD] += nodes;
            words[CWBVH_TRIANGLE_WORD] += leaves;
        } else if (layout == BvhLayout::BVH8) {
            std::for_each(words + BVH8_CHILD_WORD, words + BVH8_CHILD_WORD + BVH8_WIDTH,
                          [&](u32& reference) { child(reference); });
        } else {
            child(words[BVH2_CHILD_WORD]);
            child(words[BVH2_CHILD_WORD + 1]);
        }
    }

    void leaf(BvhLayout layout, u32* words) const {
        if (layout != BvhLayout::BVH8) {
            words[3] += triangles;
            return;
        }
        for (int lane = 0; lane < BVH8_WIDTH; ++lane)
            if (words[BVH8_BLOCK_ID_WORD + lane] != NO_INDEX)
                words[BVH8_BLOCK_ID_WORD + lane] += triangles;
    }
};

void append_tree(Bvh part, const Prototype& prototype, Bvh& bvh) {
    const size_t node = node_words(bvh.layout), leaf = leaf_words(bvh.layout);
    const Relocation to{u32(bvh.nodes.size() / node), u32(bvh.leaves.size() / leaf),
                        prototype.first_triangle};
    for (size_t i = 0; i < part.nodes.size(); i += node)
        to.node(bvh.layout, &part.nodes[i]);
    for (size_t i = 0; i < part.leaves.size(); i += leaf)
        to.leaf(bvh.layout, &part.leaves[i]);
    bvh.roots.push_back(to.nodes);
    bvh.nodes.insert(bvh.nodes.end(), part.nodes.begin(), part.nodes.end());
    bvh.leaves.insert(bvh.leaves.end(), part.leaves.begin(), part.leaves.end());
    bvh.depth = std::max(bvh.depth, part.depth);
    bvh.triangle_count += part.triangle_count;
    bvh.reference_count += part.reference_count;
}

std::vector<Box> boxes_of(const std::vector<Instance>& instances, const std::vector<PrototypeHull>& hulls) {
    std::vector<Box> boxes(instances.size() - 1);
    tbb::parallel_for(size_t(0), boxes.size(), [&](size_t i) {
        const Instance& instance = instances[i + 1];
        boxes[i] = hulls[instance.prototype].placed(instance);
    });
    return boxes;
}

void check_counts(size_t triangles, size_t instances) {
    if (std::max(triangles, instances) >= BVH_INSTANCE_BIT)
        throw SceneError("scene", 0,
                         fmt::format("expected fewer than {} triangles and instances each, found {} and {}; "
                                     "split the scene or simplify its meshes",
                                     BVH_INSTANCE_BIT, triangles, instances));
}

} // namespace

size_t own_triangle_count(const Triangles& triangles, const std::vector<Prototype>& prototypes) {
    return prototypes.empty() ? triangles.size() : prototypes.front().first_triangle;
}

Bvh build_instanced_bvh(const std::vector<vec4>& positions, const Triangles& triangles,
                        const std::vector<Prototype>& prototypes, const std::vector<Instance>& instances,
                        BvhLayout layout, BvhQuality quality, const std::vector<vec4>& moves) {
    if (prototypes.empty())
        return build_bvh(positions, triangles, layout, quality, moves);
    const auto start = std::chrono::steady_clock::now();
    check_counts(triangles.size(), instances.size());
    std::vector<PrototypeHull> hulls;
    std::vector<Bvh> parts;
    for (const Prototype& prototype : prototypes) {
        const Triangles shared = triangles_of(triangles, prototype);
        hulls.emplace_back(positions, shared);
        parts.push_back(build_bvh(positions, shared, layout, quality));
    }
    const auto own = std::ptrdiff_t(own_triangle_count(triangles, prototypes));
    Bvh bvh = build_bvh_with_boxes(positions, Triangles(triangles.begin(), triangles.begin() + own),
                                   boxes_of(instances, hulls), layout, quality, moves);
    for (size_t i = 0; i < parts.size(); ++i)
        append_tree(std::move(parts[i]), prototypes[i], bvh);
    if (!bvh.leaf_moves.empty())
        bvh.leaf_moves.resize(bvh.leaves.size());
    bvh.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return bvh;
}

} // namespace clrt
