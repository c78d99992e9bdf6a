// SPDX-License-Identifier: Apache-2.0
#include "scene/light_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <tbb/parallel_invoke.h>

namespace clrt {
namespace {

constexpr size_t LIGHT_BINS = 12;
/// Subtrees of more leaves are built side by side.
constexpr size_t LEAVES_PER_TASK = 4096;
/// From this depth on sets are halved, of which a link can count 2^30.
constexpr u32 HALVING_DEPTH = LONGEST_SPLIT_WAY - 30;

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
        bins_per_length_ = float(count_) / (high_ - low_);
    }

    size_t bin_of(const LightLeaf& leaf, int axis) const {
        const float at = (leaf.bounds.centre()[axis] - low_[axis]) * bins_per_length_[axis];
        return std::min(size_t(at), count_ - 1);
    }

    LightSplit best_split(Leaves begin, Leaves end) const {
        const glm::vec3 extent = high_ - low_;
        const float longest = std::max({extent.x, extent.y, extent.z});
        LightSplit best;
        for (int axis = 0; axis < 3; ++axis)
            if (std::isfinite(bins_per_length_[axis]))
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
    glm::vec3 bins_per_length_; ///< infinite along an axis that parts no centres
};

/// Parts leaves in two sets that are not empty.
Leaves split(Leaves begin, Leaves end, u32 depth) {
    const LightRange range = begin->range; // they are sorted by range
    if ((end - 1)->range != range)
        return std::find_if(begin, end, [&](const LightLeaf& leaf) { return leaf.range != range; });
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

class LightSplitter {
public:
    LightSplitter(std::vector<LightLeaf>& leaves, std::vector<LightPart>& parts)
        : leaves_(leaves), parts_(parts) {
        build(leaves_.begin(), leaves_.end(), 0, 0);
    }

private:
    /// Fills the parts from number `part` on with a set of leaves; they are twice as many less one.
    void build(Leaves begin, Leaves end, u32 part, u32 depth) {
        if (end - begin == 1) {
            parts_[part] = {begin->bounds, u32(begin - leaves_.begin()), 0};
            return;
        }
        const Leaves middle = split(begin, end, depth);
        const u32 first = part + 1, second = part + 2 * u32(middle - begin);
        const auto build_first = [&] { build(begin, middle, first, depth + 1); };
        const auto build_second = [&] { build(middle, end, second, depth + 1); };
        if (size_t(end - begin) > LEAVES_PER_TASK) {
            tbb::parallel_invoke(build_first, build_second);
        } else {
            build_first();
            build_second();
        }
        parts_[part] = {united(parts_[first].bounds, parts_[second].bounds), first, second};
    }

    std::vector<LightLeaf>& leaves_;
    std::vector<LightPart>& parts_;
};

} // namespace

std::vector<LightPart> split_lights(std::vector<LightLeaf>& leaves) {
    std::stable_sort(leaves.begin(), leaves.end(),
                     [](const LightLeaf& a, const LightLeaf& b) { return a.range < b.range; });
    std::vector<LightPart> parts(2 * leaves.size() - 1);
    LightSplitter(leaves, parts);
    return parts;
}

} // namespace clrt
