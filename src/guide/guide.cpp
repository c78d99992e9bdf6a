// SPDX-License-Identifier: Apache-2.0
#include "guide/guide.h"

#include <algorithm>
#include <tbb/parallel_for.h>
#include <utility>

namespace clrt {

namespace {

/// What the last epochs have left counts so much beside the next.
constexpr double KEPT = 0.5;
/// A cell is divided until it has at most so many records.
constexpr double MOST_RECORDS = 200;
/// With so many records a cell chooses half as many directions as it does with very many.
constexpr double FEW_RECORDS = 64;
/// The part of the directions that a cell chooses at most: what it has not seen is left to the BSDF.
constexpr double LARGEST_SHARE = 0.5;

/// What an epoch adds to what a cell knew.
void learn_cell(const std::uint64_t* sums, GuideLore& lore) {
    lore.weight.sum *= KEPT;
    lore.weight.count *= KEPT;
    lore.vertices = KEPT * lore.vertices + double(sums[GUIDE_SUM_VERTICES]);
    const DirectionWeight found = weight_of_sums(sums);
    if (!(found.sum > 0))
        return;
    lore.splits = learn_splits(lore.splits, lore.weight, sums);
    lore.weight.sum += found.sum;
    lore.weight.count += found.count;
}

GuideCell make_cell(const GuideLore& lore) {
    const double count = lore.weight.count;
    GuideCell cell{};
    cell.share = float(LARGEST_SHARE * count / (count + FEW_RECORDS));
    cell.radiance = count >= FEW_RECORDS ? float(lore.weight.sum / lore.vertices) : 0;
    pack_splits(lore.splits, cell);
    return cell;
}

} // namespace

Guide::Guide(double extent) : nodes_(GUIDE_SIDES), lore_(GUIDE_SIDES), extent_(float(extent)) {
    for (u32 side = 0; side < GUIDE_SIDES; ++side)
        nodes_[side] = {GUIDE_LEAF | side, 0, 0, 0};
    for (GuideLore& lore : lore_)
        lore.splits = even_splits();
}

std::vector<GuideCell> Guide::device_cells() const {
    std::vector<GuideCell> cells(lore_.size());
    std::transform(lore_.begin(), lore_.end(), cells.begin(), make_cell);
    return cells;
}

Guide::Guide(double extent, std::vector<GuideNode> nodes, std::vector<GuideLore> lore)
    : nodes_(std::move(nodes)), lore_(std::move(lore)), extent_(float(extent)) {}

/// The node of a place of the grid, or the leaf above.
GuideNode Guide::grid_node(u32 place) const {
    std::array<u32, 3> coordinates;
    for (u32& coordinate : coordinates) {
        coordinate = place % GUIDE_GRID;
        place /= GUIDE_GRID;
    }
    GuideNode node = nodes_[place]; // the root of a side
    for (u32 half = GUIDE_GRID / 2, axis = 0; half > 0 && !(node.link & GUIDE_LEAF);) {
        node = nodes_[(node.link >> 2) + (coordinates[axis] & half ? 1 : 0)];
        half = axis == 2 ? half / 2 : half;
        axis = (axis + 1) % 3;
    }
    return node;
}

std::vector<GuideNode> Guide::device_nodes() const {
    std::vector<GuideNode> nodes(GUIDE_GRID_PLACES);
    for (u32 place = 0; place < GUIDE_GRID_PLACES; ++place)
        nodes[place] = grid_node(place);
    nodes.insert(nodes.end(), nodes_.begin(), nodes_.end());
    return nodes;
}

/// Divides the leaves below a node until they have at most so many records.
void Guide::divide(size_t node, const Box& box, double most) {
    const u32 link = nodes_[node].link;
    if (!(link & GUIDE_LEAF)) {
        const size_t axis = link & 3;
        Box low = box, high = box;
        low.high[axis] = high.low[axis] = nodes_[node].split;
        divide(link >> 2, low, most);
        divide((link >> 2) + 1, high, most);
        return;
    }
    const u32 cell = link & ~GUIDE_LEAF;
    if (lore_[cell].weight.count <= most || lore_.size() == GUIDE_CELLS)
        return;
    // Halve the longest axis, the first of equals; what is known, too.
    size_t axis = 0;
    for (size_t i = 1; i < 3; ++i)
        if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis])
            axis = i;
    GuideLore& lore = lore_[cell];
    for (double* sum : {&lore.weight.sum, &lore.weight.count, &lore.vertices})
        *sum *= 0.5;
    const u32 first = u32(nodes_.size());
    nodes_.push_back({GUIDE_LEAF | cell, 0, 0, 0});
    nodes_.push_back({GUIDE_LEAF | u32(lore_.size()), 0, 0, 0});
    lore_.push_back(GuideLore(lore));
    nodes_[node] = {first * 4 | u32(axis), 0.5f * (box.low[axis] + box.high[axis]), 0, 0};
    divide(node, box, most);
}

void Guide::learn(const std::vector<std::uint64_t>& epoch) {
    tbb::parallel_for(size_t(0), lore_.size(),
                      [&](size_t cell) { learn_cell(&epoch[cell * GUIDE_SUMS], lore_[cell]); });
    // Halves of what is divided have more than half of so many, so the cells are enough for all records.
    double records = 0;
    for (const GuideLore& lore : lore_)
        records += lore.weight.count;
    const double most = std::max(MOST_RECORDS, 2 * records / GUIDE_CELLS);
    const Box whole = {{-extent_, -extent_, -extent_}, {extent_, extent_, extent_}};
    for (size_t side = 0; side < GUIDE_SIDES; ++side)
        divide(side, whole, most);
}

} // namespace clrt
