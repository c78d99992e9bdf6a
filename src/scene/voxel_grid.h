// SPDX-License-Identifier: Apache-2.0
// A coarse grid of cells that surfaces pass through, for questions about free space.
#pragma once

#include "scene/normalise.h"
#include "scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace clrt {

/// Cells of equal sides over the scene's box. Each knows to which sides the fronts of its surfaces face.
class VoxelGrid {
public:
    /// The first cell with a surface on a ray's way.
    struct Hit {
        double distance; ///< to the cell, or to the end of the box
        bool is_hit;     ///< false: the ray leaves the box
        bool is_front;   ///< a surface of the cell turns its front to the ray
        bool is_back;    ///< one turns its back to it, and none its front
    };

    /// The grid of a scene, in its normalised frame, with 64 cells along the longest side of the box; nothing
    /// for a scene that is flat, and for one whose triangles overlap so much that filling it would take long.
    static std::optional<VoxelGrid> make(const Scene& scene);

    /// Steps from cell to cell along a unit vector (Amanatides and Woo 1987), the cell of the origin left
    /// out. Origins outside start where they enter the box.
    Hit cast(const glm::dvec3& origin, const glm::dvec3& direction) const;
    /// Whether no surface is in the cell of a point.
    bool is_free(const glm::dvec3& p) const;

    const Bounds& box() const { return box_; } ///< of the scene, normalised frame
    double cell() const { return cell_; }      ///< side of a cell

private:
    VoxelGrid(const Bounds& box, double cell);
    void fill(const Scene& scene);
    glm::ivec3 cell_of(const glm::dvec3& p) const;
    size_t index_of(const glm::ivec3& c) const;

    Bounds box_;
    double cell_, inverse_cell_;
    glm::ivec3 count_;
    std::vector<std::uint8_t>
        sides_; ///< bit 2 a: faces the low end of axis a; 2 a + 1: the high end; 0: free
};

} // namespace clrt
