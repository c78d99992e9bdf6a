// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree.h"

#include "scene/emitter_parts.h"
#include "scene/light_parts.h"
#include "scene/lights.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// Nodes from the root on whose children tell most apart: the part that differs most is split until they are
/// as many as a node holds. That may be one split on a long way; below, where the least split part comes
/// first, it is three.
constexpr u32 NODES_BY_COST = 6;
static_assert(NODES_BY_COST + (LONGEST_SPLIT_WAY - NODES_BY_COST + 2) / 3 <= LIGHT_TRAIL_NODES);
static_assert(LIGHT_NODE_WIDTH == 1 << LIGHT_TRAIL_BITS);

/// Makes nodes of the parts.
class LightNodeWriter {
public:
    LightNodeWriter(const std::vector<LightLeaf>& leaves, const std::vector<LightPart>& parts,
                    LightTree& tree)
        : leaves_(leaves), parts_(parts), tree_(tree) {
        write(0, 0, 0);
    }

private:
    struct Child {
        u32 part = 0;
        u32 splits = 0; ///< from the node's part
    };

    /// How urgently a child is to be split; below 0: it is a leaf.
    float urgency(const Child& child, u32 depth) const {
        const LightPart& part = parts_[child.part];
        if (part.is_leaf())
            return -1;
        const float radius = part.bounds.radius();
        return depth < NODES_BY_COST ? part.bounds.power * radius * radius
                                     : float(LIGHT_NODE_WIDTH - child.splits);
    }

    std::vector<Child> children_of(u32 part, u32 depth) const {
        std::vector<Child> children = {{part, 0}};
        while (children.size() < LIGHT_NODE_WIDTH) {
            const auto next =
                std::max_element(children.begin(), children.end(), [&](const Child& a, const Child& b) {
                    return urgency(a, depth) < urgency(b, depth);
                });
            const LightPart& split = parts_[next->part];
            if (split.is_leaf())
                break;
            *next = {split.first, next->splits + 1};
            children.insert(next + 1, {split.second, next->splits});
        }
        return children;
    }

    /// Writes the nodes of a part to which `trail` leads from the root; gives the link.
    u32 write(u32 part, std::uint64_t trail, u32 depth) {
        const u32 number = u32(tree_.nodes.size());
        tree_.nodes.emplace_back();
        const std::vector<Child> children = children_of(part, depth);
        for (u32 i = 0; i < children.size(); ++i) {
            const LightPart& child = parts_[children[i].part];
            const std::uint64_t way = trail | std::uint64_t(i) << (LIGHT_TRAIL_BITS * depth);
            const u32 link =
                child.is_leaf() ? place(leaves_[child.first], way) : write(children[i].part, way, depth + 1);
            write_child(child.bounds, link, i, tree_.nodes[number]);
        }
        write_ends(children, tree_.nodes[number]);
        return number;
    }

    u32 place(const LightLeaf& leaf, std::uint64_t trail) {
        for (u32 light = leaf.first; light < leaf.first + leaf.count; ++light) {
            tree_.places[light].trail_low = u32(trail);
            tree_.places[light].trail_high = u32(trail >> 32);
        }
        return leaf.first | LIGHT_LINK_LEAF;
    }

    static void write_child(const LightBounds& bounds, u32 link, u32 at, LightNode& node) {
        const glm::vec3 centre = bounds.centre();
        node.x[at] = centre.x, node.y[at] = centre.y, node.z[at] = centre.z;
        node.radius[at] = bounds.radius();
        node.axis_x[at] = bounds.axis.x, node.axis_y[at] = bounds.axis.y, node.axis_z[at] = bounds.axis.z;
        node.chord[at] = std::sqrt(std::max(2 - 2 * bounds.cos_spread, 0.0f));
        node.power[at] = bounds.power;
        node.link[at] = link | (bounds.both_sides ? LIGHT_LINK_BOTH_SIDES : 0u);
    }

    /// Every child has a share, so the ends rise by at least 1.
    void write_ends(const std::vector<Child>& children, LightNode& node) const {
        std::fill(std::begin(node.end), std::end(node.end), LIGHT_SHARES);
        double all = 0, sum = 0;
        for (const Child& child : children)
            all += double(parts_[child.part].bounds.power);
        const i32 count = i32(children.size());
        for (i32 i = 0, least = 1; i < count - 1; ++i) {
            sum += double(parts_[children[size_t(i)].part].bounds.power);
            node.end[i] = std::clamp(i32(sum / all * LIGHT_SHARES), least, LIGHT_SHARES - (count - 1 - i));
            least = node.end[i] + 1;
        }
    }

    const std::vector<LightLeaf>& leaves_;
    const std::vector<LightPart>& parts_;
    LightTree& tree_;
};

/// Shares of the lights of a leaf: by area, since they shine alike.
void write_shares(const Scene& scene, const LightLeaf& leaf, std::vector<LightPlace>& places) {
    const u32 last = leaf.first + leaf.count - 1;
    places[last].end = LIGHT_LEAF_END;
    for (u32 light = leaf.first; light <= last; ++light)
        places[light].density = light < scene.emitters.size() ? float(1 / emitter_area(scene, light)) : 1.0f;
    double all = 0, sum = 0;
    if (leaf.count > 1)
        for (u32 light = leaf.first; light <= last; ++light)
            all += emitter_area(scene, light);
    for (u32 light = leaf.first; light < last; ++light) {
        sum += emitter_area(scene, light);
        // Every light has some numbers, so the ends rise by at least 1.
        const double least = 1.0 + (light - leaf.first), most = double(LIGHT_LEAF_END) - (last - light);
        places[light].end = u32(std::clamp(sum / all * 4294967296.0, least, most));
    }
}

} // namespace

LightTree build_light_tree(const Scene& scene, unsigned kinds) {
    LightTree tree;
    if (!has_several_leaves(scene, kinds))
        return tree;
    std::vector<LightLeaf> leaves = light_leaves(scene, kinds);
    tree.places.resize(scene.emitters.size() + scene.lights.size() + 1);
    tbb::parallel_for(size_t(0), leaves.size(),
                      [&](size_t i) { write_shares(scene, leaves[i], tree.places); });
    const std::vector<LightPart> parts = split_lights(leaves);
    LightNodeWriter(leaves, parts, tree);
    return tree;
}

int light_tree_depth(const LightTree& tree) {
    std::vector<int> depths(tree.nodes.size(), 1); // a node comes before those below it
    int deepest = 0;
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        deepest = std::max(deepest, depths[i]);
        for (const u32 link : tree.nodes[i].link)
            if (link && !(link & LIGHT_LINK_LEAF)) // places without a child have 0, the root's link
                depths[link & LIGHT_LINK_INDEX] = depths[i] + 1;
    }
    return deepest;
}

} // namespace clrt
