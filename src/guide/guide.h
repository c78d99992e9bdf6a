// SPDX-License-Identifier: Apache-2.0
// What paths have found, as distributions of directions for the next ones (kernels/path/guide.h): trees over
// space with one distribution in every leaf. The same sums give the same guide. No OpenCL here.
#pragma once

#include "guide/direction_bins.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clrt {

/// What a cell has learnt. Epochs count half as much with every one that follows them: they were guided
/// worse.
struct GuideLore {
    DirectionSplits splits = {};
    DirectionWeight weight; ///< of its records of light
    double vertices = 0;    ///< that could have found some
};

/// Trees over space, with a distribution of directions in every leaf.
class Guide {
public:
    /// One cell a side for the scene's box, [-extent, extent] along each axis; nothing is learnt yet.
    explicit Guide(double extent);
    /// What nodes() and lore() of another have been.
    Guide(double extent, std::vector<GuideNode> nodes, std::vector<GuideLore> lore);

    /// The trees, the roots first; children are numbered without the grid.
    const std::vector<GuideNode>& nodes() const { return nodes_; }
    /// Half the side of the scene's box.
    double extent() const { return double(extent_); }
    /// What each cell has learnt.
    const std::vector<GuideLore>& lore() const { return lore_; }

    /// Grid and nodes as the device holds them.
    std::vector<GuideNode> device_nodes() const;
    /// The distributions of all cells.
    std::vector<GuideCell> device_cells() const;

    /// Learns the sums of an epoch, GUIDE_SUMS of one cell after the other, and divides cells in which paths
    /// have found much.
    void learn(const std::vector<std::uint64_t>& epoch);

private:
    struct Box {
        std::array<float, 3> low, high;
    };
    GuideNode grid_node(u32 place) const;
    void divide(size_t node, const Box& box, double most);

    std::vector<GuideNode> nodes_;
    std::vector<GuideLore> lore_;
    float extent_;
};

} // namespace clrt
