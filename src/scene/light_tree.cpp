// SPDX-License-Identifier: Apache-2.0
#include "scene/light_tree.h"

#include "scene/lights.h"
#include "scene/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <limits>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

namespace clrt {
namespace {

constexpr size_t LIGHT_BINS = 12;
/// Subtrees of more leaves are built side by side.
constexpr size_t LEAVES_PER_TASK = 4096;
/// From this depth on sets are halved, so that a trail of 64 bits leads to every leaf.
constexpr u32 HALVING_DEPTH = 32;

using Leaves = std::vector<LightLeaf>::iterator;

/// Which leaves go to the first child: those in the bins below `bin` along an axis.
struct LightSplit {
    int axis = -1; ///< none: no plane parts the centres
    size_t bin = 0;
    float cost = std::numeric_limits<float>::max();
};

/// Bins of the centres of leaves.
class LightBins {
public:
    LightBins(Leaves begin, Leaves end) : count_(std::min(LIGHT_BINS, size_t(end - begin))) {
        low_ = high_ = begin->bounds.centre();
        for (Leaves leaf = begin; leaf != end; ++leaf) {
            low_ = glm::min(low_, leaf->bounds.centre());
            high_ = glm::max(high_, leaf->bounds.centre());
        }
    }

    size_t bin_of(const LightLeaf& leaf, int axis) const {
        const float at = (leaf.bounds.centre()[axis] - low_[axis]) / (high_[axis] - low_[axis]);
        return std::min(size_t(at * float(count_)), count_ - 1);
    }

    LightSplit best_split(Leaves begin, Leaves end) const {
        const glm::vec3 extent = high_ - low_;
        const float longest = std::max({extent.x, extent.y, extent.z});
        LightSplit best;
        for (int axis = 0; axis < 3; ++axis)
            if (extent[axis] > 0)
                try_axis(axis, longest / extent[axis], begin, end, best);
        return best;
    }

private:
    /// `slenderness` keeps splits from making needles.
    void try_axis(int axis, float slenderness, Leaves begin, Leaves end, LightSplit& best) const {
        std::array<LightSpread, LIGHT_BINS> bins;
        for (Leaves leaf = begin; leaf != end; ++leaf)
            bins[bin_of(*leaf, axis)].add(leaf->bounds);
        std::array<float, LIGHT_BINS> above{};
        LightSpread sum;
        for (size_t i = count_ - 1; i > 0; --i) {
            sum.add(bins[i]);
            above[i] = sum.cost();
        }
        LightSpread below;
        for (size_t i = 1; i < count_; ++i) {
            below.add(bins[i - 1]);
            const float cost = slenderness * (below.cost() + above[i]);
            if (cost < best.cost)
                best = {axis, i, cost};
        }
    }

    size_t count_;
    glm::vec3 low_, high_;
};

/// A built part of the tree, as its parent's pair describes it.
struct LightNode {
    LightBounds bounds;
    u32 link = 0;
};

class LightTreeBuilder {
public:
    LightTreeBuilder(std::vector<LightLeaf> leaves, LightTree& tree)
        : leaves_(std::move(leaves)), tree_(tree) {
        tree_.pairs.resize(leaves_.size() - 1);
        build(leaves_.begin(), leaves_.end(), 0, 0, 0);
    }

private:
    /// Builds the subtree over some leaves, whose pairs begin at `pair`. `trail` leads here from the root.
    LightNode build(Leaves begin, Leaves end, u32 pair, std::uint64_t trail, u32 depth) {
        if (end - begin == 1)
            return build_leaf(*begin, trail);
        const Leaves middle = split(begin, end, depth);
        LightNode first, second;
        const auto build_first = [&] { first = build(begin, middle, pair + 1, trail, depth + 1); };
        const auto build_second = [&] {
            second =
                build(middle, end, pair + u32(middle - begin), trail | std::uint64_t(1) << depth, depth + 1);
        };
        if (size_t(end - begin) > LEAVES_PER_TASK) {
            tbb::parallel_invoke(build_first, build_second);
        } else {
            build_first();
            build_second();
        }
        write_pair(first, second, tree_.pairs[pair]);
        return {united(first.bounds, second.bounds), pair};
    }

    LightNode build_leaf(const LightLeaf& leaf, std::uint64_t trail) {
        for (u32 light = leaf.first; light < leaf.first + leaf.count; ++light) {
            tree_.places[light].trail_low = u32(trail);
            tree_.places[light].trail_high = u32(trail >> 32);
        }
        return {leaf.bounds, leaf.first | LIGHT_LINK_LEAF};
    }

    /// Parts leaves in two sets that are not empty.
    static Leaves split(Leaves begin, Leaves end, u32 depth) {
        for (const LightRange range : {LightRange::SKY, LightRange::SUN}) {
            const Leaves middle =
                std::stable_partition(begin, end, [&](const LightLeaf& leaf) { return leaf.range == range; });
            if (middle != begin && middle != end)
                return middle;
        }
        const Leaves half = begin + (end - begin) / 2;
        if (end - begin == 2 || depth >= HALVING_DEPTH)
            return half;
        const LightBins bins(begin, end);
        const LightSplit best = bins.best_split(begin, end);
        if (best.axis < 0)
            return half;
        const Leaves middle = std::stable_partition(
            begin, end, [&](const LightLeaf& leaf) { return bins.bin_of(leaf, best.axis) < best.bin; });
        return middle == begin || middle == end ? half : middle;
    }

    static void write_pair(const LightNode& a, const LightNode& b, LightPair& pair) {
        const auto both = [&](const auto& of) { return vec2{of(a.bounds), of(b.bounds)}; };
        pair.x = both([](const LightBounds& n) { return n.centre().x; });
        pair.y = both([](const LightBounds& n) { return n.centre().y; });
        pair.z = both([](const LightBounds& n) { return n.centre().z; });
        pair.radius = both([](const LightBounds& n) { return n.radius(); });
        pair.axis_x = both([](const LightBounds& n) { return n.axis.x; });
        pair.axis_y = both([](const LightBounds& n) { return n.axis.y; });
        pair.axis_z = both([](const LightBounds& n) { return n.axis.z; });
        pair.cos_spread = both([](const LightBounds& n) { return n.cos_spread; });
        pair.power = both([](const LightBounds& n) { return n.power; });
        const auto link = [](const LightNode& n) {
            return n.link | (n.bounds.both_sides ? LIGHT_LINK_BOTH_SIDES : 0u);
        };
        pair.first = link(a);
        pair.second = link(b);
        const double share = double(a.bounds.power) / (double(a.bounds.power) + double(b.bounds.power));
        pair.first_share = u32(std::clamp(share * 16777216.0, 1.0, 16777215.0));
    }

    std::vector<LightLeaf> leaves_;
    LightTree& tree_;
};

double area_of(const Scene& scene, u32 emitter) {
    const Triangle& t = scene.triangles[scene.emitters[emitter].triangle];
    return triangle_area(scene.positions[t.v0], scene.positions[t.v1], scene.positions[t.v2]);
}

/// Shares of the lights of a leaf: by area, since they shine alike.
void write_shares(const Scene& scene, const LightLeaf& leaf, std::vector<LightPlace>& places) {
    const u32 last = leaf.first + leaf.count - 1;
    places[last].end = LIGHT_LEAF_END;
    for (u32 light = leaf.first; light <= last; ++light)
        places[light].density = light < scene.emitters.size() ? float(1 / area_of(scene, light)) : 1.0f;
    double all = 0, sum = 0;
    if (leaf.count > 1)
        for (u32 light = leaf.first; light <= last; ++light)
            all += area_of(scene, light);
    for (u32 light = leaf.first; light < last; ++light) {
        sum += area_of(scene, light);
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
    LightTreeBuilder(std::move(leaves), tree);
    return tree;
}

int light_tree_depth(const LightTree& tree) {
    std::vector<int> depths(tree.pairs.size(), 1); // a pair comes before those below it
    int deepest = 0;
    for (size_t i = 0; i < tree.pairs.size(); ++i) {
        deepest = std::max(deepest, depths[i]);
        for (const u32 link : {tree.pairs[i].first, tree.pairs[i].second})
            if (!(link & LIGHT_LINK_LEAF))
                depths[link & LIGHT_LINK_INDEX] = depths[i] + 1;
    }
    return deepest;
}

} // namespace clrt
