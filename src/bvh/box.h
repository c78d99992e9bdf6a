// SPDX-License-Identifier: Apache-2.0
// Boxes of the tree builder. Four lanes hold x, y, z and a spare, so that one instruction handles all axes.
#pragma once

#include "kernels/shared/types.h"

#include <algorithm>
#include <limits>

namespace clrt {

/// GCC's and Clang's portable vector types: arithmetic, comparison and ?: work lane by lane.
typedef float Float4 __attribute__((vector_size(16)));
typedef i32 Int4 __attribute__((vector_size(16)));

constexpr float INFINITE_FLOAT = std::numeric_limits<float>::infinity();

inline Float4 splat(float x) {
    return Float4{x, x, x, x};
}
/// A point. Adding +0 turns -0 into +0, so that the bits of a box do not depend on the order of its corners.
inline Float4 box_corner(const vec4& p) {
    return Float4{p.x, p.y, p.z, 0} + splat(0);
}
/// The smaller and the larger lanes; `b` where one is NaN.
inline Float4 lane_min(Float4 a, Float4 b) {
    return a < b ? a : b;
}
inline Float4 lane_max(Float4 a, Float4 b) {
    return a > b ? a : b;
}

/// An axis-aligned box; empty until extended. The fourth lane means nothing.
struct Box {
    Float4 lower = splat(INFINITE_FLOAT);
    Float4 upper = splat(-INFINITE_FLOAT);

    /// A NaN leaves its lane as it was.
    void extend(Float4 point) {
        lower = lane_min(point, lower);
        upper = lane_max(point, upper);
    }
    void extend(const Box& other) {
        lower = lane_min(other.lower, lower);
        upper = lane_max(other.upper, upper);
    }
};

/// Half the surface of a box whose edges are multiplied by `scale` first; the box must not be empty.
inline float half_area(const Box& box, float scale) {
    const Float4 edge = (box.upper - box.lower) * splat(scale);
    const Float4 face = edge * __builtin_shufflevector(edge, edge, 1, 2, 0, 3);
    return face[0] + face[1] + face[2];
}

/// A triangle or a part of one on its way into the tree: its box, and the triangle's index as bits in the
/// fourth lane of `lower`.
struct BuildItem {
    Float4 lower;
    Float4 upper; ///< fourth lane: a side's mark while a spatial split is applied

    BuildItem() = default; // uninitialised
    BuildItem(const Box& box, u32 triangle) : lower(box.lower), upper(box.upper) {
        Int4 bits = Int4(lower);
        bits[3] = i32(triangle);
        lower = Float4(bits);
    }
    u32 triangle() const { return u32(Int4(lower)[3]); }
    Box box() const { return {Float4(Int4(lower) & Int4{-1, -1, -1, 0}), upper}; }
};

/// Twice the centre of a box: the builder compares centres only with each other.
inline Float4 doubled_centre(const Box& box) {
    return box.lower + box.upper;
}

/// What a node needs to know of its items.
struct ItemBounds {
    Box box;     ///< of the triangles
    Box centres; ///< of the doubled centres of their boxes

    void extend(const Box& item) {
        box.extend(item);
        centres.extend(doubled_centre(item));
    }
    void extend(const ItemBounds& other) {
        box.extend(other.box);
        centres.extend(other.centres);
    }
};

/// The two sides of a range after it was split.
struct SplitSides {
    u32 left_count = 0;
    ItemBounds left, right;
};

} // namespace clrt
