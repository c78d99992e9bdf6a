// SPDX-License-Identifier: Apache-2.0
#include "bench/embree_builder.h"

#include "bvh/binary_tree.h"
#include "bvh/clip.h"
#include "bvh/layout.h"
#include "bvh/sah_cost.h"
#include "bvh/spatial_split.h"

#include <fmt/format.h>
#include <memory>
#include <stdexcept>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

constexpr size_t ALIGNMENT = 16; // of what the callbacks allocate, in bytes
constexpr u32 GRAIN = 4096;      // triangles prepared at a time

/// A node or a leaf as the builder's callbacks make it.
struct EmbreeNode {
    u32 triangles; ///< of a leaf, whose indices follow; 0: an inner node
    u32 children;
    RTCBounds bounds[BVH8_WIDTH];
    const EmbreeNode* child[BVH8_WIDTH];
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned children, void*) {
    auto* node = static_cast<EmbreeNode*>(rtcThreadLocalAlloc(allocator, sizeof(EmbreeNode), ALIGNMENT));
    node->triangles = 0;
    node->children = children;
    return node;
}

void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<EmbreeNode*>(node)->child[i] = static_cast<const EmbreeNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<EmbreeNode*>(node)->bounds[i] = *bounds[i];
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* items, size_t count, void*) {
    auto* words = static_cast<u32*>(rtcThreadLocalAlloc(allocator, (1 + count) * sizeof(u32), ALIGNMENT));
    words[0] = u32(count);
    for (size_t i = 0; i < count; ++i)
        words[1 + i] = items[i].primID;
    return words;
}

/// RTCBuildPrimitive and RTCBounds have the same six names.
template <class Bounds>
Box box_of(const Bounds& b) {
    return {Float4{b.lower_x, b.lower_y, b.lower_z, 0}, Float4{b.upper_x, b.upper_y, b.upper_z, 0}};
}

template <class Bounds>
void store(const Box& box, Bounds& b) {
    b.lower_x = box.lower[0], b.lower_y = box.lower[1], b.lower_z = box.lower[2];
    b.upper_x = box.upper[0], b.upper_y = box.upper[1], b.upper_z = box.upper[2];
}

/// Cuts an item as clrt's own builder does.
void split_item(const RTCBuildPrimitive* item, unsigned axis, float position, RTCBounds* left,
                RTCBounds* right, void* mesh) {
    const Box box = box_of(*item);
    Float4 corners[3];
    static_cast<const TriangleCorners*>(mesh)->load(item->primID, corners);
    BoxParts parts = cut_box(box, corners, int(axis), position);
    // Embree expects two parts; where the triangle has but one, its box has both.
    if (is_empty(parts.left) || is_empty(parts.right)) {
        parts = {box, box};
        parts.left.upper[axis] = parts.right.lower[axis] = position;
    }
    store(parts.left, *left);
    store(parts.right, *right);
}

struct BuildItems {
    std::unique_ptr<RTCBuildPrimitive[]> items;
    size_t count, capacity;
};

/// The boxes of all triangles that clrt's tree holds.
BuildItems make_items(const TriangleCorners& mesh) {
    const size_t total = mesh.triangles.size(), capacity = size_t(double(total) * MOST_REFERENCES);
    BuildItems result{std::unique_ptr<RTCBuildPrimitive[]>(new RTCBuildPrimitive[capacity]), total, capacity};
    tbb::parallel_for(tbb::blocked_range<u32>(0, u32(total), GRAIN), [&](const auto& part) {
        for (u32 i = part.begin(); i != part.end(); ++i) {
            Float4 corners[3];
            mesh.load(i, corners);
            Box box;
            for (const Float4& corner : corners)
                box.extend(corner);
            store(box, result.items[i]);
            const Triangle& t = mesh.triangles[i];
            const bool usable = can_be_hit(mesh.positions[t.v0], mesh.positions[t.v1], mesh.positions[t.v2]);
            result.items[i].geomID = 0;
            result.items[i].primID = usable ? i : NO_INDEX;
        }
    });
    RTCBuildPrimitive* const begin = result.items.get();
    result.count = size_t(std::remove_if(begin, begin + total,
                                         [](const RTCBuildPrimitive& p) { return p.primID == NO_INDEX; }) -
                          begin);
    return result;
}

RTCBuildArguments build_arguments(BvhLayout layout, RTCBuildQuality quality) {
    const LeafCost leaves = leaf_cost(layout);
    const LeafPrice price = leaf_price(layout);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = quality;
    arguments.maxBranchingFactor = layout == BvhLayout::BVH2 ? 2 : BVH8_WIDTH;
    arguments.maxDepth = BVH_MAX_DEPTH;
    // As Embree builds for its own blocks of triangles: what fits into one is not split. With smaller leaves
    // its trees cost up to 45 % more where blocks have eight triangles.
    arguments.sahBlockSize = arguments.minLeafSize = 1u << leaves.block_log2;
    arguments.maxLeafSize = leaves.max_leaf;
    arguments.traversalCost = 1;
    arguments.intersectionCost = price.leaf + price.triangle; // of a block: one of them is 0
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    arguments.splitPrimitive = split_item;
    return arguments;
}

/// Adds a subtree of so large a box to the cost and returns the entries in its leaves.
size_t add_subtree(const EmbreeNode& node, double half_area_of_box, SahSum& cost) {
    if (node.triangles > 0) {
        cost.add_leaf(half_area_of_box, node.triangles);
        return node.triangles;
    }
    cost.add_node(half_area_of_box);
    size_t entries = 0;
    for (u32 i = 0; i < node.children; ++i)
        entries +=
            add_subtree(*node.child[i], half_area(&node.bounds[i].lower_x, &node.bounds[i].upper_x), cost);
    return entries;
}

/// Half the surface of the box around all items.
double root_half_area(const BuildItems& items) {
    Box box;
    for (size_t i = 0; i < items.count; ++i)
        box.extend(box_of(items.items[i]));
    RTCBounds bounds;
    store(box, bounds);
    return half_area(&bounds.lower_x, &bounds.upper_x);
}

} // namespace

EmbreeTree build_embree_tree(const Scene& scene, BvhLayout layout, RTCBuildQuality quality, int threads) {
    const std::shared_ptr<RTCDeviceTy> device(
        rtcNewDevice(threads > 0 ? fmt::format("threads={}", threads).c_str() : nullptr), rtcReleaseDevice);
    const std::shared_ptr<RTCBVHTy> bvh(rtcNewBVH(device.get()), rtcReleaseBVH);
    TriangleCorners mesh{scene.positions, scene.triangles};
    RTCBuildArguments arguments = build_arguments(layout, quality);
    arguments.bvh = bvh.get();
    arguments.userPtr = &mesh;
    EmbreeTree tree;
    BuildItems items;
    tree.cost = measure([&] { items = make_items(mesh); });
    if (items.count == 0)
        return tree;
    const double root_area = root_half_area(items);
    arguments.primitives = items.items.get();
    arguments.primitiveCount = items.count;
    arguments.primitiveArrayCapacity = items.capacity;
    const EmbreeNode* root = nullptr;
    tree.cost += measure([&] { root = static_cast<const EmbreeNode*>(rtcBuildBVH(&arguments)); });
    if (!root)
        throw std::runtime_error(
            fmt::format("Embree's builder fails (error {})", int(rtcGetDeviceError(device.get()))));
    SahSum cost(layout);
    tree.references = add_subtree(*root, root_area, cost);
    tree.sah_cost = cost.relative_to(root_area);
    return tree;
}

RTCBuildQuality matching_quality(BvhQuality quality) {
    return quality == BvhQuality::HIGH ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
}

const char* quality_name(RTCBuildQuality quality) {
    switch (quality) {
    case RTC_BUILD_QUALITY_LOW:
        return "low";
    case RTC_BUILD_QUALITY_MEDIUM:
        return "medium";
    default:
        return "high";
    }
}

} // namespace clrt
