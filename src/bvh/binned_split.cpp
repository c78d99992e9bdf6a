// SPDX-License-Identifier: Apache-2.0
// Binning, sweeping and partitioning: the inner loops of the tree builder.
#include "bvh/binned_split.h"

#include "bvh/partition.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

constexpr u32 HALVED_RANGE = 128; // items that repay a second set of bins
constexpr u32 FEW_ITEMS = 16;
constexpr int FEW_BINS = 4;

struct Bins {
    Box boxes[MAX_BINS][3]; // by bin and axis
    Int4 counts[MAX_BINS];  // by bin; one lane an axis
    int size;

    explicit Bins(int bins) : size(bins) { std::fill_n(counts, bins, Int4{}); }

    void add(const BuildItem& item, const BinMap& map) {
        const Box box = item.box();
        const Int4 bin = map.bins_of(doubled_centre(box));
        for (int axis = 0; axis < 3; ++axis) {
            boxes[bin[axis]][axis].extend(box);
            ++counts[bin[axis]][axis];
        }
    }

    // Neighbours often fall into one bin, and each waits for the one before. Two halves with bins of their
    // own do not wait for each other.
    void add(const BuildItem* items, u32 count, const BinMap& map) {
        const u32 half = count < HALVED_RANGE ? 0 : count / 2;
        if (half > 0) {
            Bins second(size);
            for (u32 i = 0; i < half; ++i) {
                add(items[i], map);
                second.add(items[half + i], map);
            }
            merge(second);
        }
        for (u32 i = 2 * half; i < count; ++i)
            add(items[i], map);
    }

    void merge(const Bins& other) {
        for (int i = 0; i < size; ++i) {
            for (int axis = 0; axis < 3; ++axis)
                boxes[i][axis].extend(other.boxes[i][axis]);
            counts[i] += other.counts[i];
        }
    }
};

// Minima, maxima and integer sums do not depend on the order of merging: the bins are the same for any
// threads.
void fill_bins(Bins& bins, const BuildItem* items, u32 count, const BinMap& map) {
    if (count < PARALLEL_ITEMS) {
        bins.add(items, count, map);
        return;
    }
    std::mutex mutex;
    tbb::parallel_for(tbb::blocked_range<u32>(0, count, ITEM_CHUNK),
                      [&](const tbb::blocked_range<u32>& part) {
                          Bins own(bins.size);
                          own.add(items + part.begin(), u32(part.size()), map);
                          const std::lock_guard<std::mutex> lock(mutex);
                          bins.merge(own);
                      });
}

// Bins on one side of a boundary, for the boundaries of all axes at once.
struct SweptSide {
    Box boxes[3];
    Int4 counts{};

    void extend(const Bins& bins, int bin) {
        for (int axis = 0; axis < 3; ++axis)
            boxes[axis].extend(bins.boxes[bin][axis]);
        counts += bins.counts[bin];
    }

    // Half the surface times the blocks, one lane an axis. NaN, which is never the least, for an empty side.
    Float4 cost(Float4 scale, const LeafCost& leaf_cost) const {
        const Float4 a = boxes[0].upper - boxes[0].lower, b = boxes[1].upper - boxes[1].lower,
                     c = boxes[2].upper - boxes[2].lower;
        const Float4 ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
        const Float4 x = scale * __builtin_shufflevector(ab, c, 0, 1, 4, 4);
        const Float4 y = scale * __builtin_shufflevector(ab, c, 2, 3, 5, 5);
        const Float4 z =
            scale * __builtin_shufflevector(__builtin_shufflevector(a, b, 2, 6, 3, 7), c, 0, 1, 6, 6);
        return (x * y + y * z + z * x) * leaf_cost.blocks(counts);
    }
};

// Sweeps all axes from both ends and returns the cheapest boundary.
BinnedSplit sweep(const Bins& bins, float scale, const LeafCost& leaf_cost) {
    Float4 right_costs[MAX_BINS];
    SweptSide right;
    for (int i = bins.size - 1; i > 0; --i) {
        right.extend(bins, i);
        right_costs[i] = right.cost(splat(scale), leaf_cost);
    }
    SweptSide left;
    Float4 least = splat(INFINITE_FLOAT);
    Int4 least_bin{};
    for (int i = 1; i < bins.size; ++i) {
        left.extend(bins, i - 1);
        const Float4 cost = left.cost(splat(scale), leaf_cost) + right_costs[i];
        least_bin = cost < least ? Int4{} + i : least_bin;
        least = lane_min(cost, least);
    }
    BinnedSplit best;
    for (int axis = 0; axis < 3; ++axis)
        if (least[axis] < best.cost) {
            best.cost = least[axis];
            best.axis = axis;
            best.bin = least_bin[axis];
        }
    return best;
}

// Tells the sides of a binned split apart, and gathers the centres of both.
struct BinnedSorter {
    int axis, bin;
    float origin, scale, last;

    BinnedSorter(const BinMap& map, const BinnedSplit& split)
        : axis(split.axis), bin(split.bin), origin(map.origin[axis]), scale(map.scale[axis]),
          last(float(map.bins - 1)) {}

    bool operator()(const BuildItem& item, SplitSides& sides) const {
        const Float4 centre = doubled_centre(item.box());
        const float position = (centre[axis] - origin) * scale;
        const bool is_left = int(position < last ? position : last) < bin;
        // An all-ones lane is NaN: the centre extends one side only.
        const Int4 left_mask = Int4{} - i32(is_left);
        sides.left.centres.extend(Float4(Int4(centre) | ~left_mask));
        sides.right.centres.extend(Float4(Int4(centre) | left_mask));
        return is_left;
    }
};

} // namespace

BinMap::BinMap(const Box& centres, u32 count)
    : bins(count < FEW_ITEMS ? FEW_BINS : MAX_BINS), origin(centres.lower), scale(splat(0)) {
    for (int axis = 0; axis < 3; ++axis) {
        const float per_unit = float(bins) / (centres.upper[axis] - centres.lower[axis]);
        // Agreeing centres, or closer than a float's reciprocal reaches.
        if (std::isfinite(per_unit))
            scale[axis] = per_unit;
    }
    origin[3] = 0;
}

BinnedSplit find_split(const BuildItem* items, u32 count, const ItemBounds& bounds, const BinMap& map,
                       const LeafCost& leaf_cost) {
    // Relative edges: the areas of a tiny or a huge node neither vanish nor overflow.
    const Float4 edge = bounds.box.upper - bounds.box.lower;
    const float longest = std::max({edge[0], edge[1], edge[2]});
    const float scale = std::min(1.0f / longest, std::numeric_limits<float>::max());
    const float node_area = half_area(bounds.box, scale);

    Bins filled(map.bins);
    fill_bins(filled, items, count, map);
    BinnedSplit best = sweep(filled, scale, leaf_cost);
    best.cost += node_area * leaf_cost.node_cost;
    best.leaf_cost = node_area * leaf_cost.blocks(Int4{} + i32(count))[0];
    if (best.axis < 0)
        return best;
    for (int i = 0; i < map.bins; ++i) {
        (i < best.bin ? best.left : best.right).extend(filled.boxes[i][best.axis]);
        best.left_count += i < best.bin ? u32(filled.counts[i][best.axis]) : 0;
    }
    return best;
}

SplitSides apply_split(BuildItem* items, u32 count, const BinMap& map, const BinnedSplit& split) {
    SplitSides sides = partition_items(items, count, BinnedSorter(map, split));
    sides.left.box = split.left;
    sides.right.box = split.right;
    return sides;
}

SplitSides split_at_median(BuildItem* items, u32 count, const Box& centres) {
    const Float4 edge = centres.upper - centres.lower;
    const int axis = edge[0] >= edge[1] ? (edge[0] >= edge[2] ? 0 : 2) : (edge[1] >= edge[2] ? 1 : 2);
    SplitSides sides;
    sides.left_count = (count + 1) / 2;
    std::nth_element(
        items, items + sides.left_count, items + count, [axis](const BuildItem& a, const BuildItem& b) {
            const float position_a = a.lower[axis] + a.upper[axis],
                        position_b = b.lower[axis] + b.upper[axis];
            return position_a != position_b ? position_a < position_b : a.triangle() < b.triangle();
        });
    for (u32 i = 0; i < count; ++i)
        (i < sides.left_count ? sides.left : sides.right).extend(items[i].box());
    return sides;
}

} // namespace clrt
