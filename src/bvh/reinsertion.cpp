// SPDX-License-Identifier: Apache-2.0
// Rounds of: find the best new place for the largest nodes side by side, then move those that do not get in
// each other's way one by one.
#include "bvh/reinsertion.h"

#include "bvh/box.h"
#include "bvh/tree_order.h"

#include <algorithm>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <vector>

namespace clrt {
namespace {

constexpr u32 CANDIDATE_SHARE = 10;     // one node in so many is tried each round
constexpr u32 MOST_STEPS = 400;         // nodes looked at for one subtree
constexpr u32 SEARCHES_PER_TASK = 64;   // searches of a thread at a time
constexpr u32 PARALLEL_WALK = 1u << 14; // triangles, before moves, of subtrees that repay a task
constexpr float LEAST_GAIN = 1e-9f;     // as a share of the root's surface: less is rounding

Box box_of(const BinaryNode& node) {
    Box box;
    box.lower = Float4{node.lower[0], node.lower[1], node.lower[2], 0};
    box.upper = Float4{node.upper[0], node.upper[1], node.upper[2], 0};
    return box;
}

bool same(const Box& a, const Box& b) {
    const Int4 differ = (a.lower != b.lower) | (a.upper != b.upper);
    return (differ[0] | differ[1] | differ[2]) == 0;
}

struct Move {
    u32 node = 0, target = 0; // `target` becomes the sibling of `node`
    float gain = 0;
};

class Reinserter {
public:
    explicit Reinserter(BinaryTree& tree)
        : tree_(tree), nodes_(tree.nodes.get()), parents_(tree.node_count), begins_(tree.node_count) {
        const Box root = box_of(nodes_[0]);
        const Float4 edge = root.upper - root.lower;
        scale_ = std::min(1.0f / std::max({edge[0], edge[1], edge[2]}), std::numeric_limits<float>::max());
        least_gain_ = LEAST_GAIN * area(root);
        link(0, 0);
    }

    void run(int rounds) {
        for (int round = 0; round < rounds; ++round) {
            const std::vector<Move> done = apply(find_moves());
            if (done.empty())
                break;
            if (depth(0) > tree_.most_levels()) {
                for (auto move = done.rbegin(); move != done.rend(); ++move)
                    reinsert(move->node, move->target);
                break;
            }
        }
        const std::vector<u32> order = std::move(tree_.order);
        put_in_order(tree_, begins_.data(), [&](u32 item) { return order[item]; });
    }

private:
    float area(const Box& box) const { return half_area(box, scale_); }
    float area(u32 node) const { return area(box_of(nodes_[node])); }
    u32 sibling(u32 node) const {
        const u32 first = nodes_[parents_[node]].child;
        return node == first ? first + 1 : first;
    }

    // Children are numbered in pairs from 1 on, so parents and the places of leaves follow in one walk.
    void link(u32 node, u32 begin) {
        begins_[node] = begin;
        const u32 child = nodes_[node].child;
        if (child == 0)
            return;
        parents_[child] = parents_[child + 1] = node;
        link(child, begin);
        link(child + 1, begin + nodes_[child].count);
    }

    int depth(u32 node) const {
        const BinaryNode& n = nodes_[node];
        if (n.child == 0)
            return 1;
        int left = 0, right = 0;
        if (n.count < PARALLEL_WALK) {
            left = depth(n.child);
            right = depth(n.child + 1);
        } else {
            tbb::parallel_invoke([&] { left = depth(n.child); }, [&] { right = depth(n.child + 1); });
        }
        return 1 + std::max(left, right);
    }

    // The best moves of the largest nodes, best first.
    std::vector<Move> find_moves() const {
        // Children of the root have no parent that could shrink.
        std::vector<std::pair<float, u32>> candidates;
        candidates.reserve(tree_.node_count);
        for (u32 i = 1; i < tree_.node_count; ++i)
            if (parents_[i] != 0)
                candidates.emplace_back(-area(i), i);
        const size_t count = std::min<size_t>(candidates.size(), tree_.node_count / CANDIDATE_SHARE + 1);
        std::nth_element(candidates.begin(), candidates.begin() + std::ptrdiff_t(count), candidates.end());
        std::vector<Move> moves(count);
        tbb::parallel_for(tbb::blocked_range<size_t>(0, count, SEARCHES_PER_TASK), [&](const auto& part) {
            for (size_t i = part.begin(); i != part.end(); ++i)
                moves[i] = find_move(candidates[i].second);
        });
        moves.erase(std::remove_if(moves.begin(), moves.end(),
                                   [&](const Move& move) { return !(move.gain > least_gain_); }),
                    moves.end());
        std::sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) {
            return a.gain != b.gain ? a.gain > b.gain : a.node < b.node;
        });
        return moves;
    }

    // Walks up from the node; at every ancestor searches the other side, nearest first, as far as that can
    // pay.
    Move find_move(u32 node) const {
        const Box box = box_of(nodes_[node]);
        const float node_area = area(box);
        Move best{node, 0, 0};
        u32 steps = 0;
        struct Entry {
            u32 node;
            float gain; // of the ancestors that shrink, less those above this node that grow
        };
        Entry stack[BVH_MAX_DEPTH + 1]; // a depth-first walk leaves at most one node a level behind
        const u32 parent = parents_[node];
        u32 other = sibling(node), pivot = parent;
        Box shrunk = box_of(nodes_[other]);
        float gain = area(parent); // the parent goes
        for (;;) {
            int top = 0;
            stack[top++] = {other, gain};
            while (top > 0 && steps < MOST_STEPS) {
                const Entry entry = stack[--top];
                // The new parent is at least as large as the node.
                if (entry.gain - node_area <= best.gain)
                    continue;
                ++steps;
                Box merged = box_of(nodes_[entry.node]);
                const float own_area = area(merged);
                merged.extend(box);
                const float rest = entry.gain - area(merged);
                if (rest > best.gain && !(pivot == parent && entry.node == other)) {
                    best.gain = rest;
                    best.target = entry.node;
                }
                const u32 child = nodes_[entry.node].child;
                if (child != 0 && top + 2 <= BVH_MAX_DEPTH + 1) {
                    stack[top++] = {child, rest + own_area};
                    stack[top++] = {child + 1, rest + own_area};
                }
            }
            if (pivot == 0 || steps >= MOST_STEPS)
                return best;
            // Without the node the pivot is as large as what is left below it.
            if (pivot != parent) {
                shrunk.extend(box_of(nodes_[other]));
                gain += area(pivot) - area(shrunk);
            }
            other = sibling(pivot);
            pivot = parents_[pivot];
        }
    }

    // Makes the moves whose surroundings no better one has changed, as long as each shrinks the tree as it is
    // by then; returns how to take them back.
    std::vector<Move> apply(const std::vector<Move>& moves) {
        std::vector<bool> touched(tree_.node_count);
        std::vector<Move> done;
        for (const Move& move : moves) {
            const u32 around[] = {move.node, move.target, sibling(move.node), parents_[move.node],
                                  parents_[move.target]};
            if (std::any_of(std::begin(around), std::end(around), [&](u32 n) { return touched[n]; }) ||
                is_below(move.target, move.node))
                continue;
            for (u32 n : around)
                touched[n] = true;
            // Where the sibling goes is where the subtree would have to return to.
            const u32 way_back = parents_[move.node];
            if (reinsert(move.node, move.target) < 0)
                done.push_back({move.node, way_back, 0});
            else
                reinsert(move.node, way_back);
        }
        return done;
    }

    // Earlier moves may have brought the target under the node.
    bool is_below(u32 node, u32 ancestor) const {
        while (node != 0 && node != ancestor)
            node = parents_[node];
        return node == ancestor;
    }

    // The sibling takes the parent's place, the target the sibling's, and their new parent the target's.
    // Returns by how much the sum of inner nodes' surfaces has grown.
    float reinsert(u32 node, u32 target) {
        const u32 other = sibling(node), parent = parents_[node];
        const u32 pair = std::min(node, other);
        float growth = -area(parent);
        const BinaryNode sibling_node = nodes_[other];
        const u32 sibling_begin = begins_[other];
        place(other, nodes_[target], begins_[target]);
        place(parent, sibling_node, sibling_begin);
        nodes_[target].child = pair;
        parents_[node] = parents_[other] = target;
        growth += area(target) + refit(target);
        return growth + refit(parents_[parent]);
    }

    void place(u32 slot, const BinaryNode& node, u32 begin) {
        nodes_[slot] = node;
        begins_[slot] = begin;
        if (node.child != 0)
            parents_[node.child] = parents_[node.child + 1] = slot;
    }

    // Fits boxes from an inner node upwards, as far as they change; returns by how much they have grown.
    float refit(u32 node) {
        for (float growth = 0;; node = parents_[node]) {
            BinaryNode& n = nodes_[node];
            const Box before = box_of(n);
            Box box = box_of(nodes_[n.child]);
            box.extend(box_of(nodes_[n.child + 1]));
            if (same(box, before))
                return growth;
            growth += area(box) - area(before);
            for (int axis = 0; axis < 3; ++axis) {
                n.lower[axis] = box.lower[axis];
                n.upper[axis] = box.upper[axis];
            }
            if (node == 0)
                return growth;
        }
    }

    BinaryTree& tree_;
    BinaryNode* nodes_;
    std::vector<u32> parents_;
    std::vector<u32> begins_; // of leaves, in tree_.order
    float scale_ = 1, least_gain_ = 0;
};

} // namespace

void reinsert_subtrees(BinaryTree& tree, int rounds) {
    if (rounds > 0 && tree.node_count > 3)
        Reinserter(tree).run(rounds);
}

} // namespace clrt
