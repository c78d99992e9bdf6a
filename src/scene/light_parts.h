// SPDX-License-Identifier: Apache-2.0
// Lights parted in two again and again, until each set is a leaf: what the light tree's nodes are made of.
#pragma once

#include "scene/light_leaves.h"

#include <vector>

namespace clrt {

/// Splits on the longest way to a leaf.
constexpr u32 LONGEST_SPLIT_WAY = 50;

/// A set of lights.
struct LightPart {
    LightBounds bounds;
    u32 first = 0, second = 0; ///< the parts that it is split into; of a leaf: its index among the leaves, 0

    bool is_leaf() const { return second == 0; }
};

/// Sorts the leaves into parts, the whole first, a part before those that it is split into: by binned splits
/// that keep lights of one place and one direction together (Conty Estevez and Kulla 2018), on all threads,
/// the same whatever their number.
std::vector<LightPart> split_lights(std::vector<LightLeaf>& leaves);

} // namespace clrt
