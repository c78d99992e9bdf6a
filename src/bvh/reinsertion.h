// SPDX-License-Identifier: Apache-2.0
// Improving a finished tree by moving subtrees to where they enlarge fewer boxes (Bittner, Hapala and Havran
// 2013, "Fast insertion-based optimization of bounding volume hierarchies"; Meister and Bittner 2018,
// "Parallel reinsertion for bounding volume hierarchy optimization").
#pragma once

#include "bvh/binary_tree.h"

namespace clrt {

/// Moves subtrees until `rounds` are done or a round finds nothing. The sum of the inner nodes' surfaces
/// shrinks with every move that is kept. The result is the same for any number of threads; no deeper than
/// BVH_MAX_DEPTH; leaves stay what they are. Nodes must be numbered as put_in_order does, and are so again.
/// Time: every round looks at a share of the nodes and follows at most a fixed number of steps from each,
/// whatever the tree.
void reinsert_subtrees(BinaryTree& tree, int rounds);

} // namespace clrt
