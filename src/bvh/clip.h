// SPDX-License-Identifier: Apache-2.0
// Cutting the box of a triangle's part in two at a plane (Stich, Friedrich and Dietrich 2009, "Spatial splits
// in bounding volume hierarchies", section 4.2).
#pragma once

#include "bvh/box.h"

namespace clrt {

/// The part of a cut on each side; empty where the triangle has no point there.
struct BoxParts {
    Box left, right;
};

inline bool is_empty(const Box& box) {
    const Int4 inverted = box.lower > box.upper;
    return (inverted[0] | inverted[1] | inverted[2]) != 0;
}

inline Float4 lane_abs(Float4 x) {
    return Float4(Int4(x) & 0x7fffffff);
}

/// Units of 2^-24 by which a crossing of edge and plane may be off, as a share of the larger coordinate m.
/// The edge d = b - a is within 2 m. Its parameter is off by a share of 3 units (two differences and a
/// quotient), times d by 5 (and one difference and one product): 10 m. The sum a + ... adds 1 m, moving it
/// outwards another.
constexpr float CUT_ROUNDINGS = 16.0f;
/// What products below the normal floats may lose on top.
constexpr float CUT_UNDERFLOW = 16 * std::numeric_limits<float>::denorm_min();

/// Cuts the part of the triangle `corners` that lies in `box` at `position` along `axis`. `box` must reach to
/// both sides of the plane and be within the triangle's own box.
///
/// Every point of the triangle within `box` is in one of the parts, so that all parts of a triangle together
/// cover it. That is all the traversal needs: a hit in the arithmetic of kernels/geometry/triangle.h belongs
/// to a point of the exact triangle (the corners weighted by the computed edge functions) from which the ray
/// passes at most the pad of kernels/geometry/box.h away. The point lies in some part, and the ray is found
/// to meet that part's box as it would be found to meet the whole triangle's.
///
/// Corners are floats and exact; where an edge crosses the plane is moved outwards by its error.
inline BoxParts cut_box(const Box& box, const Float4* corners, int axis, float position) {
    BoxParts parts;
    for (int i = 0; i < 3; ++i) {
        const Float4 a = corners[i], b = corners[i == 2 ? 0 : i + 1];
        const float from = a[axis], to = b[axis];
        if (from <= position)
            parts.left.extend(a);
        if (from >= position)
            parts.right.extend(a);
        if ((from < position && to > position) || (from > position && to < position)) {
            const Float4 crossing = a + splat((position - from) / (to - from)) * (b - a);
            const Float4 slack =
                splat(CUT_ROUNDINGS * 0x1p-24f) * lane_max(lane_abs(a), lane_abs(b)) + splat(CUT_UNDERFLOW);
            const Box around{crossing - slack, crossing + slack};
            parts.left.extend(around);
            parts.right.extend(around);
        }
    }
    parts.left.upper[axis] = std::min(parts.left.upper[axis], position);
    parts.right.lower[axis] = std::max(parts.right.lower[axis], position);
    // Adding +0 turns -0 into +0: which of the two a minimum takes depends on the order of its operands.
    parts.left.lower = lane_max(parts.left.lower, box.lower) + splat(0);
    parts.left.upper = lane_min(parts.left.upper, box.upper) + splat(0);
    parts.right.lower = lane_max(parts.right.lower, box.lower) + splat(0);
    parts.right.upper = lane_min(parts.right.upper, box.upper) + splat(0);
    return parts;
}

} // namespace clrt
