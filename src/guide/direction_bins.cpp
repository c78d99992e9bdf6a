// SPDX-License-Identifier: Apache-2.0
#include "guide/direction_bins.h"

#include <algorithm>
#include <vector>

namespace clrt {

namespace {

/// A rectangle of the square with so much of the light, and so many records of it, evenly spread.
struct Piece {
    std::array<std::uint32_t, 2> low, high;
    double mass = 0, count = 0;

    double area() const { return double(high[0] - low[0]) * double(high[1] - low[1]); }
};
using Pieces = std::vector<Piece>;

const Piece WHOLE_SQUARE = {{0, 0}, {GUIDE_SIDE, GUIDE_SIDE}};

double record_count(std::uint64_t sum) {
    return double(sum >> GUIDE_SUM_BITS);
}

double record_sum(std::uint64_t sum) {
    return double(sum & ((std::uint64_t(1) << GUIDE_SUM_BITS) - 1));
}

/// Number of a node in the tree: the `i`th of its level.
size_t node_number(size_t level, size_t i) {
    return (size_t(1) << level) - 1 + i;
}

/// Calls action(bin, rectangle) for the leaves below a node.
template <class Action>
void for_each_bin(const DirectionSplits& splits, size_t level, size_t i, const Piece& piece,
                  Action&& action) {
    if (level == GUIDE_LEVELS) {
        action(i, piece);
        return;
    }
    Piece low = piece, high = piece;
    low.high[level % 2] = high.low[level % 2] = splits[node_number(level, i)];
    for_each_bin(splits, level + 1, 2 * i, low, action);
    for_each_bin(splits, level + 1, 2 * i + 1, high, action);
}

double mass_below(const Pieces& pieces, size_t axis, std::uint32_t at) {
    double mass = 0;
    for (const Piece& piece : pieces) {
        const double part = double(at) - double(piece.low[axis]);
        if (part > 0)
            mass += piece.mass * std::min(part / double(piece.high[axis] - piece.low[axis]), 1.0);
    }
    return mass;
}

/// Where half of the mass lies below, with room for the nodes that are still to divide either side.
std::uint32_t median(const Pieces& pieces, size_t axis, const Piece& box, size_t level) {
    const std::uint32_t room = 1u << ((GUIDE_LEVELS - 1 - level) / 2);
    std::uint32_t low = box.low[axis] + room, high = box.high[axis] - room;
    double all = 0;
    for (const Piece& piece : pieces)
        all += piece.mass;
    double below_low = mass_below(pieces, axis, low), below_high = mass_below(pieces, axis, high);
    if (below_low >= 0.5 * all)
        return low;
    // Alternate between where a line through both ends meets the half, and the middle.
    for (bool is_secant = true; high - low > 1; is_secant = !is_secant) {
        const double part = is_secant ? (0.5 * all - below_low) / (below_high - below_low) : 0.5;
        const std::uint32_t at =
            std::clamp(low + std::uint32_t(part * double(high - low)), low + 1, high - 1);
        const double below = mass_below(pieces, axis, at);
        (below < 0.5 * all ? low : high) = at;
        (below < 0.5 * all ? below_low : below_high) = below;
    }
    return high;
}

/// The part of a piece within [low, high] of an axis goes to `parts`.
void add_part(const Piece& piece, size_t axis, std::uint32_t low, std::uint32_t high, Pieces& parts) {
    Piece part = piece;
    part.low[axis] = std::max(part.low[axis], low);
    part.high[axis] = std::min(part.high[axis], high);
    if (part.low[axis] >= part.high[axis])
        return;
    const double share = part.area() / piece.area();
    part.mass *= share;
    part.count *= share;
    parts.push_back(part);
}

/// Divides a rectangle, the `i`th of its level, into bins of equal mass.
void split_evenly(Pieces pieces, size_t level, size_t i, const Piece& box, DirectionSplits& splits) {
    if (level == GUIDE_LEVELS)
        return;
    double mass = 0, count = 0;
    for (const Piece& piece : pieces) {
        mass += piece.mass;
        count += piece.count;
    }
    pieces.push_back({box.low, box.high, mass > 0 ? mass / count : 1, 0});
    const size_t axis = level % 2;
    const std::uint32_t at = median(pieces, axis, box, level);
    pieces.pop_back();
    splits[node_number(level, i)] = std::uint16_t(at);
    Pieces low, high;
    low.reserve(pieces.size());
    high.reserve(pieces.size());
    for (const Piece& piece : pieces) {
        add_part(piece, axis, box.low[axis], at, low);
        add_part(piece, axis, at, box.high[axis], high);
    }
    Piece below = box, above = box;
    below.high[axis] = above.low[axis] = at;
    split_evenly(std::move(low), level + 1, 2 * i, below, splits);
    split_evenly(std::move(high), level + 1, 2 * i + 1, above, splits);
}

} // namespace

DirectionSplits even_splits() {
    DirectionSplits splits{};
    split_evenly({}, 0, 0, WHOLE_SQUARE, splits);
    return splits;
}

DirectionWeight weight_of_sums(const std::uint64_t* sums) {
    DirectionWeight weight;
    for (size_t bin = 0; bin < GUIDE_BINS; ++bin) {
        weight.sum += record_sum(sums[bin]);
        weight.count += record_count(sums[bin]);
    }
    return weight;
}

DirectionSplits learn_splits(const DirectionSplits& old, const DirectionWeight& weight,
                             const std::uint64_t* sums) {
    Pieces pieces;
    for_each_bin(old, 0, 0, WHOLE_SQUARE, [&](size_t bin, Piece piece) {
        piece.mass = weight.sum / GUIDE_BINS + record_sum(sums[bin]);
        piece.count = weight.count / GUIDE_BINS + record_count(sums[bin]);
        pieces.push_back(piece);
    });
    DirectionSplits splits{};
    split_evenly(std::move(pieces), 0, 0, WHOLE_SQUARE, splits);
    return splits;
}

void pack_splits(const DirectionSplits& splits, GuideCell& cell) {
    for (size_t level = 0; level < GUIDE_LEVELS; ++level)
        for (size_t i = 0; i < size_t(1) << level; ++i) {
            const size_t below = level % GUIDE_SUBTREE_LEVELS; // the subtree's root
            const size_t subtree = level < GUIDE_SUBTREE_LEVELS ? 0 : 1 + (i >> below);
            const size_t in_level = i & ((size_t(1) << below) - 1);
            const size_t at = subtree * GUIDE_SUBTREE_LEAVES + node_number(below, in_level);
            cell.splits[at / 2] |= u32(splits[node_number(level, i)]) << (16 * (at % 2));
        }
}

} // namespace clrt
