// SPDX-License-Identifier: Apache-2.0
#include "guide/direction_bins.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace clrt {

namespace {

/// A rectangle of the square with so much of the light, and so many records of it, evenly spread.
struct Piece {
    std::array<std::uint32_t, 2> low, high;
    double mass = 0, count = 0;

    double extent(size_t axis) const { return double(high[axis] - low[axis]); }
};
using Pieces = std::vector<Piece>;

/// Halves may differ from the half by this part: bins say what is alike, no more.
constexpr double EVEN_ENOUGH = 0.01;

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

/// How the mass of pieces lies along an axis. Sums are taken in lanes, as vectors want them.
class Marginal {
public:
    /// Takes the pieces from number `first` on, and one record more, evenly spread over the box. Returns the
    /// mass.
    double take(const Pieces& pieces, size_t first, size_t axis, const Piece& box) {
        const size_t count = pieces.size() - first;
        const size_t size = (count / LANES + 1) * LANES;
        low_.assign(size, 0);
        per_unit_.assign(size, 1);
        mass_.assign(size, 0);
        double mass = 0, records = 0;
        for (size_t i = 0; i < count; ++i) {
            const Piece& piece = pieces[first + i];
            low_[i] = piece.low[axis];
            per_unit_[i] = 1 / piece.extent(axis);
            mass_[i] = piece.mass;
            mass += piece.mass;
            records += piece.count;
        }
        low_[count] = box.low[axis];
        per_unit_[count] = 1 / box.extent(axis);
        mass_[count] = mass > 0 ? mass / records : 1;
        return mass + mass_[count];
    }

    /// The mass below a place.
    double below(std::uint32_t at) const {
        const double place = at;
        std::array<double, LANES> sums{};
        for (size_t i = 0; i < mass_.size(); i += LANES)
            for (size_t lane = 0; lane < LANES; ++lane) {
                const double part = (place - low_[i + lane]) * per_unit_[i + lane];
                sums[lane] += mass_[i + lane] * std::min(std::max(part, 0.0), 1.0);
            }
        return sum(sums);
    }

private:
    static constexpr size_t LANES = 8;

    static double sum(const std::array<double, LANES>& sums) {
        return std::accumulate(sums.begin(), sums.end(), 0.0);
    }

    std::vector<double> low_, per_unit_, mass_;
};

/// Divides rectangles into bins of equal mass.
class EvenSplits {
public:
    /// The splits of what `pieces` cover the square with.
    EvenSplits(Pieces pieces, DirectionSplits& splits) : pieces_(std::move(pieces)), splits_(splits) {
        divide(0, 0, 0, WHOLE_SQUARE);
    }

private:
    /// Divides the `i`th rectangle of a level, whose pieces are those from number `first` on.
    void divide(size_t first, size_t level, size_t i, const Piece& box) {
        if (level == GUIDE_LEVELS)
            return;
        const std::uint32_t at = median(first, level, box);
        splits_[node_number(level, i)] = std::uint16_t(at);
        Piece below = box, above = box;
        below.high[level % 2] = above.low[level % 2] = at;
        divide_part(first, level, 2 * i, below);
        divide_part(first, level, 2 * i + 1, above);
    }

    /// Divides one half of a rectangle of `level`, whose pieces are those from number `first` on.
    void divide_part(size_t first, size_t level, size_t i, const Piece& box) {
        const size_t end = pieces_.size();
        for (size_t k = first; k < end; ++k)
            add_part(Piece(pieces_[k]), level % 2, box);
        divide(end, level + 1, i, box);
        pieces_.resize(end);
    }

    /// Adds the part of a piece that an axis of a rectangle leaves.
    void add_part(const Piece piece, size_t axis, const Piece& box) {
        if (piece.high[axis] <= box.low[axis] || piece.low[axis] >= box.high[axis])
            return;
        pieces_.push_back(piece);
        if (piece.low[axis] >= box.low[axis] && piece.high[axis] <= box.high[axis])
            return;
        Piece& part = pieces_.back();
        part.low[axis] = std::max(part.low[axis], box.low[axis]);
        part.high[axis] = std::min(part.high[axis], box.high[axis]);
        const double share = part.extent(axis) / piece.extent(axis);
        part.mass *= share;
        part.count *= share;
    }

    /// Where about half of the mass lies below, with room for the nodes that are still to divide either side.
    std::uint32_t median(size_t first, size_t level, const Piece& box) {
        const size_t axis = level % 2;
        const std::uint32_t room = 1u << ((GUIDE_LEVELS - 1 - level) / 2);
        std::uint32_t low = box.low[axis] + room, high = box.high[axis] - room;
        const double half = 0.5 * marginal_.take(pieces_, first, axis, box);
        double below_low = marginal_.below(low), below_high = marginal_.below(high);
        if (below_low >= half)
            return low;
        // Alternate between where a line through both ends meets the half, and the middle.
        for (bool is_secant = true; high - low > 1; is_secant = !is_secant) {
            const double part = is_secant ? (half - below_low) / (below_high - below_low) : 0.5;
            const std::uint32_t at =
                std::clamp(low + std::uint32_t(part * double(high - low)), low + 1, high - 1);
            const double below = marginal_.below(at);
            if (std::abs(below - half) <= EVEN_ENOUGH * half)
                return at;
            (below < half ? low : high) = at;
            (below < half ? below_low : below_high) = below;
        }
        return high;
    }

    Pieces pieces_; // of the whole square, then of the rectangles on the way to the one that is divided
    DirectionSplits& splits_;
    Marginal marginal_;
};

} // namespace

DirectionSplits even_splits() {
    DirectionSplits splits{};
    EvenSplits({}, splits);
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
    EvenSplits(std::move(pieces), splits);
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
