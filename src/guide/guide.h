// SPDX-License-Identifier: Apache-2.0
// What paths have found, as distributions of directions for the next ones (kernels/path/guide.h): trees over
// space with one distribution in every leaf. The same sums give the same guide. No OpenCL here.
#pragma once

#include "guide/direction_bins.h"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace clrt {

/// What a cell has learnt. Epochs count half as much with every one that follows them: they were guided
/// worse.
struct GuideLore {
    DirectionSplits splits = {};
    DirectionWeight weight; ///< of its records of light
    double vertices = 0;    ///< of paths from the eye, that could have found some
};

/// Trees over space, with a distribution of directions in every leaf.
class Guide {
public:
    /// One cell a side; nothing is learnt yet.
    Guide();
    /// What nodes() and lore() of another have been.
    Guide(std::vector<u32> nodes, std::vector<GuideLore> lore)
        : nodes_(std::move(nodes)), lore_(std::move(lore)) {}

    /// The trees, the roots first: of a leaf GUIDE_LEAF and its cell, else its first child, which the other
    /// one is next to. Levels halve a cube across x, y and z by turns.
    const std::vector<u32>& nodes() const { return nodes_; }
    /// What each cell has learnt.
    const std::vector<GuideLore>& lore() const { return lore_; }

    /// Grid and octrees as the device holds them.
    std::vector<u32> device_links() const;
    /// The distributions of all cells.
    std::vector<GuideCell> device_cells() const;

    /// Learns the sums of an epoch, GUIDE_SUMS of one cell after the other, and divides cells in which paths
    /// have found much.
    void learn(const std::vector<std::uint64_t>& epoch);

    /// Records of an epoch's sums.
    static double records(const std::vector<std::uint64_t>& epoch);
    /// Records of an epoch from which on more of them make no better guide: a multiple of what divides cells,
    /// in all cells that there can be.
    static double most_records();

private:
    u32 node_below(u32 node, u32 levels, u32 path) const;
    u32 octree_link(u32 node, std::vector<u32>& links) const;
    void find_areas(size_t node, double area, std::vector<double>& areas) const;
    void divide(size_t node, u32 level, double most);

    std::vector<u32> nodes_;
    std::vector<GuideLore> lore_;
};

} // namespace clrt
