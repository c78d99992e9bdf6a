// SPDX-License-Identifier: Apache-2.0
// One walk over the tree.
#include "bvh/tree_order.h"

#include <algorithm>

namespace clrt {
namespace {

class Walk {
public:
    Walk(const BinaryTree& tree, const u32* leaf_begins, const std::function<u32(u32)>& triangle_at)
        : old_(tree.nodes.get()), leaf_begins_(leaf_begins), triangle_at_(triangle_at) {
        nodes.reserve(tree.node_count);
        nodes.resize(1);
        visit(0, 0, 1);
    }

    std::vector<BinaryNode> nodes;
    std::vector<u32> order;
    int depth = 0;

private:
    // At most BVH_MAX_DEPTH calls deep.
    void visit(u32 from, u32 to, int level) {
        const BinaryNode& node = old_[from];
        const u32 first = u32(order.size());
        nodes[to] = node;
        depth = std::max(depth, level);
        if (node.child == 0) {
            for (u32 i = leaf_begins_[from]; i != leaf_begins_[from] + node.count; ++i) {
                const u32 triangle = triangle_at_(i);
                if (std::find(order.begin() + std::ptrdiff_t(first), order.end(), triangle) == order.end())
                    order.push_back(triangle);
            }
        } else {
            const u32 child = u32(nodes.size());
            nodes.resize(nodes.size() + 2);
            nodes[to].child = child;
            visit(node.child, child, level + 1);
            visit(node.child + 1, child + 1, level + 1);
        }
        nodes[to].count = u32(order.size()) - first;
    }

    const BinaryNode* old_;
    const u32* leaf_begins_;
    const std::function<u32(u32)>& triangle_at_;
};

} // namespace

void put_in_order(BinaryTree& tree, const u32* leaf_begins, const std::function<u32(u32)>& triangle_at) {
    Walk walk(tree, leaf_begins, triangle_at);
    tree.node_count = u32(walk.nodes.size());
    std::copy(walk.nodes.begin(), walk.nodes.end(), tree.nodes.get());
    tree.order = std::move(walk.order);
    tree.depth = walk.depth;
}

} // namespace clrt
