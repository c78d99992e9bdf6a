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

} // namespace clrt
