// SPDX-License-Identifier: Apache-2.0
// Binning, sweeping and partitioning: the inner loops of the tree builder.
#include "bvh/binned_split.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <vector>

namespace clrt {
namespace {

constexpr u32 PARALLEL_RANGE = 1u << 16; // items that repay the use of several threads
constexpr u32 CHUNK = 1u << 14;          // items of a thread at a time: 512 KiB, about a second-level cache
constexpr u32 HALVED_RANGE = 128;        // items that repay a second set of bins
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
    if (count < PARALLEL_RANGE) {
        bins.add(items, count, map);
        return;
    }
    std::mutex mutex;
    tbb::parallel_for(tbb::blocked_range<u32>(0, count, CHUNK), [&](const tbb::blocked_range<u32>& part) {
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

SplitSides apply_split_serial(BuildItem* items, u32 count, const BinMap& map, const BinnedSplit& split) {
    const int axis = split.axis;
    const float origin = map.origin[axis], scale = map.scale[axis], last = float(map.bins - 1);
    SplitSides sides;
    BuildItem* front = items;
    for (BuildItem* item = items; item != items + count; ++item) {
        const BuildItem moved = *item;
        const Float4 centre = doubled_centre(moved.box());
        const float position = (centre[axis] - origin) * scale;
        const bool is_left = int(position < last ? position : last) < split.bin;
        // Swap without a branch: which side an item takes cannot be predicted.
        *item = *front;
        *front = moved;
        front += is_left;
        // An all-ones lane is NaN: the centre extends one side only.
        const Int4 left_mask = Int4{} - i32(is_left);
        sides.left.centres.extend(Float4(Int4(centre) | ~left_mask));
        sides.right.centres.extend(Float4(Int4(centre) | left_mask));
    }
    sides.left_count = u32(front - items);
    return sides;
}

struct Exchange {
    u32 left_item, right_item, count;
};

// Pairs the left items that chunks left behind `left_count` with the right items before it.
std::vector<Exchange> misplaced_items(const std::vector<SplitSides>& chunks, u32 count, u32 left_count) {
    std::vector<Exchange> exchanges;
    size_t source = 0;
    u32 used = 0; // items of chunk `source` already paired
    for (size_t i = 0; i < chunks.size(); ++i) {
        // The right items of chunk i that lie in the left part of the range.
        u32 begin = u32(i) * CHUNK + chunks[i].left_count;
        const u32 end = std::min({(u32(i) + 1) * CHUNK, count, left_count});
        while (begin < end) {
            // The left items of chunk `source` that lie in the right part.
            const u32 source_begin = std::max(u32(source) * CHUNK, left_count) + used;
            const u32 source_end = u32(source) * CHUNK + chunks[source].left_count;
            if (source_begin >= source_end) {
                ++source;
                used = 0;
                continue;
            }
            const u32 moved = std::min(end - begin, source_end - source_begin);
            exchanges.push_back({source_begin, begin, moved});
            begin += moved;
            used += moved;
        }
    }
    return exchanges;
}

// Partitions fixed chunks side by side, then exchanges what lies on the wrong side of the whole.
SplitSides apply_split_parallel(BuildItem* items, u32 count, const BinMap& map, const BinnedSplit& split) {
    std::vector<SplitSides> chunks((count + CHUNK - 1) / CHUNK);
    tbb::parallel_for(size_t(0), chunks.size(), [&](size_t i) {
        const u32 begin = u32(i) * CHUNK;
        chunks[i] = apply_split_serial(items + begin, std::min(CHUNK, count - begin), map, split);
    });
    SplitSides sides;
    for (const SplitSides& chunk : chunks) {
        sides.left_count += chunk.left_count;
        sides.left.centres.extend(chunk.left.centres);
        sides.right.centres.extend(chunk.right.centres);
    }
    const std::vector<Exchange> exchanges = misplaced_items(chunks, count, sides.left_count);
    tbb::parallel_for(size_t(0), exchanges.size(), [&](size_t i) {
        const Exchange& e = exchanges[i];
        std::swap_ranges(items + e.left_item, items + e.left_item + e.count, items + e.right_item);
    });
    return sides;
}

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
    SplitSides sides = count < PARALLEL_RANGE ? apply_split_serial(items, count, map, split)
                                              : apply_split_parallel(items, count, map, split);
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
