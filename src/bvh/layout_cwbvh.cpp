// SPDX-License-Identifier: Apache-2.0
// Eight-wide nodes of 80 bytes with quantised boxes over runs of up to three triangles (Ylitie, Karras and
// Laine 2017, "Efficient incoherent ray traversal on GPUs through compressed wide BVHs").
#include "bvh/collapse.h"
#include "bvh/layout.h"
#include "bvh/sah_cost.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// a - b without an error: `value` is the rounded difference, `error` what is missing (Knuth's two-sum).
struct Difference {
    double value, error;

    Difference(double a, double b) : value(a - b) {
        const double b_rounded = a - value;
        error = (a - (value + b_rounded)) + (b_rounded - b);
    }
    // Rounding is monotonic: only where `value` is a whole number of steps can `error` change its place.
    bool exceeds(double limit) const { return value > limit || (value == limit && error > 0); }
    double steps_below(int exponent) const {
        const double steps = std::ldexp(value, -exponent), whole = std::floor(steps);
        return whole == steps && error < 0 ? whole - 1 : whole;
    }
    double steps_above(int exponent) const {
        const double steps = std::ldexp(value, -exponent), whole = std::ceil(steps);
        return whole == steps && error > 0 ? whole + 1 : whole;
    }
};

/// The lattice of one axis of a node: origin + i * 2^exponent for i from 0 to 255.
struct Lattice {
    float origin;
    int exponent;

    /// The finest that reaches from `lower` to `upper`.
    Lattice(float lower, float upper) : origin(lower), exponent(CWBVH_SMALLEST_EXPONENT) {
        const Difference extent(upper, lower);
        if (extent.value > 0)
            exponent = std::max(exponent, std::ilogb(extent.value) - 8);
        while (extent.exceeds(std::ldexp(255.0, exponent)))
            ++exponent;
    }
    std::uint8_t below(float x) const { return std::uint8_t(Difference(x, origin).steps_below(exponent)); }
    std::uint8_t above(float x) const { return std::uint8_t(Difference(x, origin).steps_above(exponent)); }
};

void set_byte(u32* node, size_t word, size_t byte, std::uint32_t value) {
    reinterpret_cast<unsigned char*>(node + word)[byte] = static_cast<unsigned char>(value);
}

// Quantises the children's boxes on the lattice of the box around them.
void write_boxes(const BinaryNode* binary, const WideChildren& children, u32* node) {
    for (size_t axis = 0; axis < 3; ++axis) {
        float lower = INFINITE_FLOAT, upper = -INFINITE_FLOAT;
        for (size_t slot = 0; slot < BVH8_WIDTH; ++slot)
            if (children.used[slot]) {
                lower = std::min(lower, binary[children.slots[slot].node].lower[axis]);
                upper = std::max(upper, binary[children.slots[slot].node].upper[axis]);
            }
        const Lattice lattice(lower, upper);
        node[axis] = float_bits(lower);
        set_byte(node, CWBVH_EXPONENT_WORD, axis, u32(lattice.exponent + CWBVH_EXPONENT_BIAS));
        for (size_t slot = 0; slot < BVH8_WIDTH; ++slot)
            if (children.used[slot]) {
                const BinaryNode& child = binary[children.slots[slot].node];
                set_byte(node, CWBVH_LOWER_WORD + 2 * axis, slot, lattice.below(child.lower[axis]));
                set_byte(node, CWBVH_UPPER_WORD + 2 * axis, slot, lattice.above(child.upper[axis]));
            }
    }
}

/// Writes nodes, siblings side by side and otherwise depth first; sorts the ranges of BinaryTree::order that
/// become leaves and collects them in the order of their triangles in Bvh::leaves.
class NodeWriter {
public:
    NodeWriter(BinaryTree& tree, Bvh& bvh)
        : tree_(tree), binary_(tree.nodes.get()), collapse_(tree, CWBVH_RULES), bvh_(bvh) {
        append_nodes(1);
        stack_.push_back({{0, 0}, 0, CWBVH_RULES.max_levels});
        while (!stack_.empty()) {
            const Pending parent = stack_.back();
            stack_.pop_back();
            write_node(parent);
        }
        bvh.sah_cost = cost_.relative_to(half_area(binary_[0]));
    }

    /// Each with its different triangles only.
    const std::vector<LeafRange>& leaves() const { return leaves_; }
    /// Where each leaf's triangles begin in Bvh::leaves.
    const std::vector<u32>& places() const { return places_; }
    /// Entries in all leaves.
    u32 entry_count() const { return entry_count_; }

private:
    struct Pending {
        WideChild subtree;
        u32 node;
        int levels; // of wide nodes that its subtree may have
    };

    u32 append_nodes(u32 count) {
        const size_t first = bvh_.nodes.size() / CWBVH_NODE_WORDS;
        bvh_.nodes.resize(bvh_.nodes.size() + size_t(count) * CWBVH_NODE_WORDS, 0u);
        return u32(first);
    }

    void write_node(const Pending& parent) {
        cost_.add_node(half_area(binary_[parent.subtree.node]));
        const WideChildren children =
            collapse_.assign_slots(collapse_.children(parent.subtree, parent.levels), parent.subtree.node);
        u32 inner_mask = 0, inner_count = 0;
        for (u32 slot = 0; slot < BVH8_WIDTH; ++slot)
            if (children.used[slot] && !collapse_.is_leaf(children.slots[slot].node)) {
                inner_mask |= 1u << slot;
                ++inner_count;
            }
        const u32 first_node = append_nodes(inner_count), first_triangle = entry_count_;
        u32* node = &bvh_.nodes[size_t(parent.node) * CWBVH_NODE_WORDS];
        write_boxes(binary_, children, node);
        set_byte(node, CWBVH_EXPONENT_WORD, 3, inner_mask);
        node[CWBVH_CHILD_WORD] = first_node;
        node[CWBVH_TRIANGLE_WORD] = first_triangle;
        const size_t first_pending = stack_.size();
        u32 next_node = first_node;
        for (u32 slot = 0; slot < BVH8_WIDTH; ++slot) {
            if (!children.used[slot])
                continue;
            const WideChild child = children.slots[slot];
            if (inner_mask >> slot & 1u) {
                set_byte(node, CWBVH_META_WORD, slot, CWBVH_INNER_META | slot);
                stack_.push_back({child, next_node++, parent.levels - 1});
                continue;
            }
            const u32 count = sort_leaf(tree_, {child.first, binary_[child.node].count});
            const u32 unary = (1u << count) - 1;
            set_byte(node, CWBVH_META_WORD, slot,
                     unary << CWBVH_COUNT_SHIFT | (entry_count_ - first_triangle));
            leaves_.push_back({child.first, count});
            places_.push_back(entry_count_);
            entry_count_ += count;
            cost_.add_leaf(half_area(binary_[child.node]), count);
        }
        std::reverse(stack_.begin() + std::ptrdiff_t(first_pending), stack_.end());
    }

    BinaryTree& tree_;
    const BinaryNode* binary_;
    WideCollapse collapse_;
    Bvh& bvh_;
    std::vector<Pending> stack_;
    std::vector<LeafRange> leaves_;
    std::vector<u32> places_;
    u32 entry_count_ = 0;
    SahSum cost_{BvhLayout::CWBVH};
};

} // namespace

void write_cwbvh(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles, BinaryTree& tree,
                 Bvh& bvh) {
    if (tree.order.empty()) {
        bvh.nodes.resize(CWBVH_NODE_WORDS, 0u);
        return;
    }
    const NodeWriter writer(tree, bvh);
    bvh.leaves.resize(size_t(writer.entry_count()) * LEAF_TRIANGLE_WORDS, 0u);
    tbb::parallel_for(size_t(0), writer.leaves().size(), [&](size_t i) {
        const LeafRange& leaf = writer.leaves()[i];
        const u32* indices = &tree.order[leaf.first];
        if (indices[0] >= tree.first_box) {
            bvh.leaves[size_t(writer.places()[i]) * LEAF_TRIANGLE_WORDS + BVH_INSTANCE_WORD] =
                instance_at(tree, leaf.first);
            return;
        }
        for (u32 k = 0; k < leaf.count; ++k)
            write_leaf_triangle(positions, triangles[indices[k]], indices[k],
                                &bvh.leaves[size_t(writer.places()[i] + k) * LEAF_TRIANGLE_WORDS]);
    });
}

} // namespace clrt
