// SPDX-License-Identifier: Apache-2.0
// What remains to be exchanged after every chunk was partitioned.
#include "bvh/partition.h"

namespace clrt {

std::vector<Exchange> misplaced_items(const std::vector<SplitSides>& chunks, u32 count, u32 left_count) {
    std::vector<Exchange> exchanges;
    size_t source = 0;
    u32 used = 0; // items of chunk `source` already paired
    for (size_t i = 0; i < chunks.size(); ++i) {
        // The right items of chunk i that lie in the left part of the range.
        u32 begin = u32(i) * ITEM_CHUNK + chunks[i].left_count;
        const u32 end = std::min({(u32(i) + 1) * ITEM_CHUNK, count, left_count});
        while (begin < end) {
            // The left items of chunk `source` that lie in the right part.
            const u32 source_begin = std::max(u32(source) * ITEM_CHUNK, left_count) + used;
            const u32 source_end = u32(source) * ITEM_CHUNK + chunks[source].left_count;
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

} // namespace clrt
