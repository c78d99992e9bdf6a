// SPDX-License-Identifier: Apache-2.0
#include "scene/voxel_grid.h"

#include "scene/triangle_corners.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

constexpr int CELLS = 64; // along the longest side: of a room of 6 m, 10 cm
/// Points per side of a cell at which triangles are sampled: they leave no cell out that a triangle passes
/// well inside.
constexpr double SAMPLES_PER_CELL = 1.5;
/// Samples in all: a tenth of a second.
constexpr double MOST_SAMPLES = 3e7;
/// Cosine between a surface's normal and an axis from which on it faces that side: each normal has one such
/// axis.
constexpr double FACES_SIDE = 0.57;
/// The same for rays, which may graze a wall: below it they say nothing about it.
constexpr double ALONG_SIDE = 0.1;

/// Steps along each edge of a triangle.
int steps_of(const TriangleCorners& t, double cell) {
    const glm::dvec3 ab = t.p[1] - t.p[0], bc = t.p[2] - t.p[1], ca = t.p[0] - t.p[2];
    const double longest = std::max({glm::dot(ab, ab), glm::dot(bc, bc), glm::dot(ca, ca)});
    if (longest * SAMPLES_PER_CELL * SAMPLES_PER_CELL <= cell * cell) // most
        return 1;
    return int(std::ceil(SAMPLES_PER_CELL * std::sqrt(longest) / cell));
}

/// The scene's box, and the samples that its triangles take with cells of this side.
struct Extent {
    Bounds box;
    double samples = 0;
};

Extent measure_extent(const Scene& scene, double cell) {
    const double most = std::numeric_limits<double>::max();
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, scene.triangles.size(), TRIANGLE_GRAIN),
        Extent{{glm::dvec3(most), glm::dvec3(-most)}, 0},
        [&](const tbb::blocked_range<size_t>& range, Extent extent) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const TriangleCorners t = corners_of(scene.positions, scene.triangles[i]);
                extent.box.low = glm::min(extent.box.low, glm::min(t.p[0], glm::min(t.p[1], t.p[2])));
                extent.box.high = glm::max(extent.box.high, glm::max(t.p[0], glm::max(t.p[1], t.p[2])));
                const double steps = steps_of(t, cell);
                extent.samples += steps * steps / 2;
            }
            return extent;
        },
        [](const Extent& a, const Extent& b) {
            return Extent{{glm::min(a.box.low, b.box.low), glm::max(a.box.high, b.box.high)},
                          a.samples + b.samples};
        });
}

std::uint8_t sides_of(const TriangleCorners& t) {
    const glm::dvec3 n = glm::cross(t.p[1] - t.p[0], t.p[2] - t.p[0]);
    const double least = FACES_SIDE * glm::length(n);
    unsigned sides = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (std::fabs(n[axis]) > least)
            sides |= 1u << (2 * axis + (n[axis] > 0));
    return std::uint8_t(sides);
}

/// Whether one of the sides is that of a direction, as far as sides can tell.
bool faces(std::uint8_t sides, const glm::dvec3& direction) {
    for (int axis = 0; axis < 3; ++axis)
        if (std::fabs(direction[axis]) > ALONG_SIDE && (sides >> (2 * axis + (direction[axis] > 0)) & 1) != 0)
            return true;
    return false;
}

} // namespace

std::optional<VoxelGrid> VoxelGrid::make(const Scene& scene) {
    const double cell = 2 * double(scene.extent) / CELLS; // the box is centred
    if (!(cell > 0))
        return std::nullopt;
    const Extent extent = measure_extent(scene, cell);
    const glm::dvec3 size = extent.box.high - extent.box.low;
    if (!(std::min({size.x, size.y, size.z}) > cell) || extent.samples > MOST_SAMPLES)
        return std::nullopt;
    VoxelGrid grid(extent.box, cell);
    grid.fill(scene);
    return grid;
}

VoxelGrid::VoxelGrid(const Bounds& box, double cell)
    : box_(box), cell_(cell), inverse_cell_(1 / cell), count_(glm::ceil((box.high - box.low) / cell)) {
    count_ = glm::max(count_, glm::ivec3(1));
    sides_.resize(size_t(count_.x) * size_t(count_.y) * size_t(count_.z));
}

glm::ivec3 VoxelGrid::cell_of(const glm::dvec3& p) const {
    return glm::clamp(glm::ivec3((p - box_.low) * inverse_cell_), glm::ivec3(0), count_ - 1);
}

size_t VoxelGrid::index_of(const glm::ivec3& c) const {
    return (size_t(c.z) * size_t(count_.y) + size_t(c.y)) * size_t(count_.x) + size_t(c.x);
}

void VoxelGrid::fill(const Scene& scene) {
    // Cells are shared by the tasks; most of them are marked already when a triangle comes.
    std::vector<std::atomic<std::uint8_t>> marks(sides_.size());
    const auto mark = [&](const glm::dvec3& p, std::uint8_t sides) {
        std::atomic<std::uint8_t>& cell = marks[index_of(cell_of(p))];
        if ((cell.load(std::memory_order_relaxed) & sides) != sides)
            cell.fetch_or(sides, std::memory_order_relaxed);
    };
    tbb::parallel_for(tbb::blocked_range<size_t>(0, scene.triangles.size(), TRIANGLE_GRAIN),
                      [&](const auto& range) {
                          for (size_t i = range.begin(); i < range.end(); ++i) {
                              const TriangleCorners t = corners_of(scene.positions, scene.triangles[i]);
                              const std::uint8_t sides = sides_of(t);
                              const int steps = steps_of(t, cell_);
                              if (steps == 1) { // its neighbours mark the cells beside
                                  mark(t.p[0], sides);
                                  continue;
                              }
                              const glm::dvec3 ab = (t.p[1] - t.p[0]) / double(steps),
                                               ac = (t.p[2] - t.p[0]) / double(steps);
                              for (int j = 0; j <= steps; ++j)
                                  for (int k = 0; j + k <= steps; ++k)
                                      mark(t.p[0] + double(j) * ab + double(k) * ac, sides);
                          }
                      });
    std::copy(marks.begin(), marks.end(), sides_.begin());
}

bool VoxelGrid::is_free(const glm::dvec3& p) const {
    return sides_[index_of(cell_of(p))] == 0;
}

VoxelGrid::Hit VoxelGrid::cast(const glm::dvec3& origin, const glm::dvec3& direction) const {
    // Where the ray enters and leaves the box.
    double enter = 0, leave = std::numeric_limits<double>::max();
    glm::dvec3 step(std::numeric_limits<double>::max());
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0)
            continue;
        step[axis] = cell_ / std::fabs(direction[axis]);
        const double a = (box_.low[axis] - origin[axis]) / direction[axis],
                     b = (box_.high[axis] - origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    if (!(enter < leave))
        return {leave, false, false, false};
    // From cell to cell.
    glm::ivec3 c = cell_of(origin + enter * direction);
    glm::dvec3 next(std::numeric_limits<double>::max());
    for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0)
            next[axis] =
                (box_.low[axis] + (c[axis] + (direction[axis] > 0)) * cell_ - origin[axis]) / direction[axis];
    double distance = enter;
    for (bool is_first = enter == 0;; is_first = false) {
        if (const std::uint8_t sides = sides_[index_of(c)]; !is_first && sides != 0) {
            const bool is_front = faces(sides, -direction);
            return {distance, true, is_front, !is_front && faces(sides, direction)};
        }
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        distance = next[axis];
        c[axis] += direction[axis] > 0 ? 1 : -1;
        if (distance >= leave || c[axis] < 0 || c[axis] >= count_[axis])
            return {leave, false, false, false};
        next[axis] += step[axis];
    }
}

} // namespace clrt
