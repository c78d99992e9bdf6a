// SPDX-License-Identifier: Apache-2.0
#include "guide/guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// What the last epochs have left counts so much beside the next.
constexpr double KEPT = 0.5;
/// A cell is divided until it has at most so many records.
constexpr double MOST_RECORDS = 200;
/// With so many records a cell chooses half as many directions as it does with very many.
constexpr double FEW_RECORDS = 64;
/// The part of the directions that a cell chooses at most: what it has not seen is left to the BSDF.
constexpr double LARGEST_SHARE = 0.7;
/// Where paths from lights teach, irradiance counts so much, as if the eye had sent a path for each of them.
/// What a grey surface scatters of it to the eye is a sixth; but directions that hit the light are far fewer
/// than those of a bin, so that more of them are worth it (Rath et al. 2020). Eight times as much makes no
/// other guide of a pool.
constexpr double LIGHT_WEIGHT = 1;

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

/// `density`: of the vertices in the cell, as a part of all, over its area.
GuideCell make_cell(const GuideLore& lore, double density) {
    const double count = lore.weight.count;
    GuideCell cell{};
    cell.share = float(LARGEST_SHARE * count / (count + FEW_RECORDS));
    cell.radiance = count >= FEW_RECORDS && lore.vertices > 0 ? float(lore.weight.sum / lore.vertices) : 0;
    cell.light = float(LIGHT_WEIGHT * density);
    pack_splits(lore.splits, cell);
    return cell;
}

} // namespace

Guide::Guide() : lore_(GUIDE_SIDES) {
    for (u32 side = 0; side < GUIDE_SIDES; ++side)
        nodes_.push_back(GUIDE_LEAF | side);
    for (GuideLore& lore : lore_)
        lore.splits = even_splits();
}

std::vector<GuideCell> Guide::device_cells() const {
    std::vector<double> areas(lore_.size());
    for (size_t side = 0; side < GUIDE_SIDES; ++side)
        find_areas(side, 1, areas);
    double vertices = 0;
    for (const GuideLore& lore : lore_)
        vertices += lore.vertices;
    std::vector<GuideCell> cells;
    for (size_t i = 0; i < lore_.size(); ++i) {
        const double share = vertices > 0 ? lore_[i].vertices / vertices : 1 / double(lore_.size());
        cells.push_back(make_cell(lore_[i], share / areas[i]));
    }
    return cells;
}

/// The area of a wall through each cell below a node, where one through the node's is `area`.
void Guide::find_areas(size_t node, double area, std::vector<double>& areas) const {
    if (nodes_[node] & GUIDE_LEAF) {
        areas[nodes_[node] & ~GUIDE_LEAF] = area;
        return;
    }
    const double half = area * std::exp2(-2.0 / 3); // by turns of three levels a wall is halved across two
    find_areas(nodes_[node], half, areas);
    find_areas(nodes_[node] + 1, half, areas);
}

/// The node so many levels below, or the leaf above it; bit `i` of the path says whether the half of level
/// `i` is the high one.
u32 Guide::node_below(u32 node, u32 levels, u32 path) const {
    for (u32 level = 0; level < levels && !(nodes_[node] & GUIDE_LEAF); ++level)
        node = nodes_[node] + ((path >> level) & 1);
    return node;
}

/// Adds the octree below a node of the first of three levels to `links`, and returns the link to it.
u32 Guide::octree_link(u32 node, std::vector<u32>& links) const {
    if (nodes_[node] & GUIDE_LEAF)
        return nodes_[node];
    const size_t first = links.size();
    links.resize(first + GUIDE_CHILDREN);
    for (u32 child = 0; child < GUIDE_CHILDREN; ++child) {
        const u32 link = octree_link(node_below(node, 3, child), links);
        links[first + child] = link;
    }
    return u32(first);
}

std::vector<u32> Guide::device_links() const {
    std::vector<u32> links(GUIDE_GRID_PLACES);
    for (u32 place = 0; place < GUIDE_GRID_PLACES; ++place) {
        const std::array<u32, 3> at = {place % GUIDE_GRID, place / GUIDE_GRID % GUIDE_GRID,
                                       place / (GUIDE_GRID * GUIDE_GRID) % GUIDE_GRID};
        u32 path = 0;
        for (u32 level = 0; level < 3 * GUIDE_GRID_BITS; ++level)
            path |= ((at[level % 3] >> (GUIDE_GRID_BITS - 1 - level / 3)) & 1) << level;
        const u32 node =
            node_below(place / (GUIDE_GRID * GUIDE_GRID * GUIDE_GRID), 3 * GUIDE_GRID_BITS, path);
        const u32 link = octree_link(node, links);
        links[place] = link;
    }
    return links;
}

/// Divides the leaves below a node until they have at most so many records.
void Guide::divide(size_t node, u32 level, double most) {
    if (nodes_[node] & GUIDE_LEAF) {
        const u32 cell = nodes_[node] & ~GUIDE_LEAF;
        if (lore_[cell].weight.count <= most || lore_.size() == GUIDE_CELLS || level == 3 * GUIDE_AXIS_BITS)
            return;
        // Halve what is known, too.
        GuideLore& lore = lore_[cell];
        for (double* sum : {&lore.weight.sum, &lore.weight.count, &lore.vertices})
            *sum *= 0.5;
        nodes_[node] = u32(nodes_.size());
        nodes_.push_back(GUIDE_LEAF | cell);
        nodes_.push_back(GUIDE_LEAF | u32(lore_.size()));
        lore_.push_back(GuideLore(lore));
    }
    const size_t first = nodes_[node];
    divide(first, level + 1, most);
    divide(first + 1, level + 1, most);
}

double Guide::records(const std::vector<std::uint64_t>& epoch) {
    double records = 0;
    for (size_t cell = 0; cell < epoch.size(); cell += GUIDE_SUMS)
        records += weight_of_sums(&epoch[cell]).count;
    return records;
}

double Guide::most_records() {
    return MOST_RECORDS * GUIDE_CELLS;
}

void Guide::learn(const std::vector<std::uint64_t>& epoch) {
    tbb::parallel_for(size_t(0), lore_.size(),
                      [&](size_t cell) { learn_cell(&epoch[cell * GUIDE_SUMS], lore_[cell]); });
    // Halves of what is divided have more than half of so many, so the cells are enough for all records.
    double records = 0;
    for (const GuideLore& lore : lore_)
        records += lore.weight.count;
    const double most = std::max(MOST_RECORDS, 2 * records / GUIDE_CELLS);
    for (size_t side = 0; side < GUIDE_SIDES; ++side)
        divide(side, 0, most);
}

} // namespace clrt
