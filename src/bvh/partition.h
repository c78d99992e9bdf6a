// SPDX-License-Identifier: Apache-2.0
// Reordering a range of items in place, large ranges by several threads.
#pragma once

#include "bvh/box.h"

#include <algorithm>
#include <tbb/parallel_for.h>
#include <vector>

namespace clrt {

constexpr u32 PARALLEL_ITEMS = 1u << 16; ///< that repay the use of several threads
constexpr u32 ITEM_CHUNK = 1u << 14;     ///< items of a thread at a time: 512 KiB, about a second-level cache

/// Runs of items that are to change places.
struct Exchange {
    u32 left_item, right_item, count;
};

/// Chunk by chunk the left items are in front. Pairs the left items that lie behind `left_count`, the number
/// of all, with the right items before it.
std::vector<Exchange> misplaced_items(const std::vector<SplitSides>& chunks, u32 count, u32 left_count);

template <class Sorter>
SplitSides partition_chunk(BuildItem* items, u32 count, const Sorter& is_left) {
    SplitSides sides;
    BuildItem* front = items;
    for (BuildItem* item = items; item != items + count; ++item) {
        const BuildItem moved = *item;
        // Swap without a branch: which side an item takes cannot be predicted.
        *item = *front;
        *front = moved;
        front += is_left(moved, sides);
    }
    sides.left_count = u32(front - items);
    return sides;
}

/// Moves the items for which `is_left(item, sides)` holds before the others; the call may extend the bounds
/// of either side. The new order is the same for any number of threads.
template <class Sorter>
SplitSides partition_items(BuildItem* items, u32 count, const Sorter& is_left) {
    if (count < PARALLEL_ITEMS)
        return partition_chunk(items, count, is_left);
    // Partition fixed chunks side by side, then exchange what lies on the wrong side of the whole.
    std::vector<SplitSides> chunks((count + ITEM_CHUNK - 1) / ITEM_CHUNK);
    tbb::parallel_for(size_t(0), chunks.size(), [&](size_t i) {
        const u32 begin = u32(i) * ITEM_CHUNK;
        chunks[i] = partition_chunk(items + begin, std::min(ITEM_CHUNK, count - begin), is_left);
    });
    SplitSides sides;
    for (const SplitSides& chunk : chunks) {
        sides.left_count += chunk.left_count;
        sides.left.extend(chunk.left);
        sides.right.extend(chunk.right);
    }
    const std::vector<Exchange> exchanges = misplaced_items(chunks, count, sides.left_count);
    tbb::parallel_for(size_t(0), exchanges.size(), [&](size_t i) {
        const Exchange& e = exchanges[i];
        std::swap_ranges(items + e.left_item, items + e.left_item + e.count, items + e.right_item);
    });
    return sides;
}

} // namespace clrt
