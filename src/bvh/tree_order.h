// SPDX-License-Identifier: Apache-2.0
// Giving the nodes of a tree the numbers that they have in a walk from the root.
#pragma once

#include "bvh/binary_tree.h"

#include <functional>

namespace clrt {

/// Renumbers the nodes depth first, fills counts, `order`, `depth` and `node_count`, and drops the nodes that
/// the root does not reach. A leaf has `count` items from leaf_begins[its node] on, of the triangles
/// `triangle_at`; a triangle that a leaf holds twice is kept once. The result depends on the tree alone, not
/// on the numbers its nodes had.
void put_in_order(BinaryTree& tree, const u32* leaf_begins, const std::function<u32(u32)>& triangle_at);

} // namespace clrt
