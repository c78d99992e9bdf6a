// SPDX-License-Identifier: Apache-2.0
#include "bvh/layout.h"

namespace clrt {

void write_leaf_triangle(const std::vector<vec4>& positions, const Triangle& triangle, u32 index,
                         u32* words) {
    const u32 corners[3] = {triangle.v0, triangle.v1, triangle.v2};
    for (int corner = 0; corner < 3; ++corner) {
        const vec4& p = positions[corners[corner]];
        words[4 * corner + 0] = float_bits(p.x);
        words[4 * corner + 1] = float_bits(p.y);
        words[4 * corner + 2] = float_bits(p.z);
    }
    words[3] = index;
}

namespace {

void write_block_moves(const std::vector<vec4>& moves, const std::vector<Triangle>& triangles, Bvh& bvh) {
    for (size_t first = 0; first < bvh.leaves.size(); first += BVH8_BLOCK_WORDS) {
        const u32* const indices = &bvh.leaves[first + BVH8_BLOCK_ID_WORD];
        const u32 count = u32(std::find(indices, indices + BVH8_WIDTH, NO_INDEX) - indices);
        write_block(moves, triangles, indices, count, &bvh.leaf_moves[first]);
    }
}

} // namespace

void write_leaf_moves(const std::vector<vec4>& moves, const std::vector<Triangle>& triangles, Bvh& bvh) {
    bvh.leaf_moves.resize(bvh.leaves.size());
    if (bvh.layout == BvhLayout::BVH8)
        return write_block_moves(moves, triangles, bvh);
    for (size_t first = 0; first < bvh.leaves.size(); first += LEAF_TRIANGLE_WORDS) {
        const u32 index = bvh.leaves[first + 3];
        write_leaf_triangle(moves, triangles[index], index, &bvh.leaf_moves[first]);
    }
}

} // namespace clrt
