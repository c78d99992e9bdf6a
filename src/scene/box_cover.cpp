// SPDX-License-Identifier: Apache-2.0
#include "scene/box_cover.h"

#include "scene/normalise.h"
#include "scene/triangle_corners.h"
#include <algorithm>
#include <bitset>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

constexpr double NEAR_FACE = 0.05; // of the box's size: how far a wall may lie from the box's face
constexpr int GRID = 16;           // points per side of a face

using Cells = std::bitset<GRID * GRID>;

/// Twice the signed area of (a, b, p).
double edge(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Marks the grid's points that lie in a triangle given in grid coordinates (a cell is 1x1, points at the
/// centres).
void mark_cells(Cells& cells, const glm::dvec2 (&corner)[3]) {
    const auto [low_x, high_x] = std::minmax({corner[0].x, corner[1].x, corner[2].x});
    const auto [low_y, high_y] = std::minmax({corner[0].y, corner[1].y, corner[2].y});
    const int x0 = std::max(0, int(low_x - 0.5)), x1 = std::min(GRID - 1, int(high_x + 0.5));
    const int y0 = std::max(0, int(low_y - 0.5)), y1 = std::min(GRID - 1, int(high_y + 0.5));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const glm::dvec2 p(x + 0.5, y + 0.5);
            const double e0 = edge(corner[0], corner[1], p), e1 = edge(corner[1], corner[2], p),
                         e2 = edge(corner[2], corner[0], p);
            if ((e0 >= 0 && e1 >= 0 && e2 >= 0) || (e0 <= 0 && e1 <= 0 && e2 <= 0))
                cells.set(size_t(y * GRID + x));
        }
}

/// Component `axis` of the triangle's normal, of any length.
double normal_along(const TriangleCorners& corners, int axis) {
    return glm::cross(corners.p[1] - corners.p[0], corners.p[2] - corners.p[0])[axis];
}

/// Marks what one triangle covers of one face, if it lies near the face and its front looks into the box.
void cover_face(Cells& cells, const BoxFace& face, const TriangleCorners& corners, const Bounds& box) {
    const glm::dvec3 size = box.high - box.low;
    const double plane = face.sign > 0 ? box.high[face.axis] : box.low[face.axis];
    const int u = (face.axis + 1) % 3, v = (face.axis + 2) % 3;
    glm::dvec2 on_grid[3];
    for (int i = 0; i < 3; ++i) {
        if (std::fabs(corners.p[i][face.axis] - plane) > NEAR_FACE * size[face.axis])
            return;
        on_grid[i] = {(corners.p[i][u] - box.low[u]) / size[u] * GRID,
                      (corners.p[i][v] - box.low[v]) / size[v] * GRID};
    }
    if (normal_along(corners, face.axis) * face.sign < 0)
        mark_cells(cells, on_grid);
}

Bounds bounds_of(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles) {
    const double most = std::numeric_limits<double>::max();
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, triangles.size(), TRIANGLE_GRAIN),
        Bounds{glm::dvec3(most), glm::dvec3(-most)},
        [&](const tbb::blocked_range<size_t>& range, Bounds box) {
            for (size_t i = range.begin(); i < range.end(); ++i)
                for (const glm::dvec3& p : corners_of(positions, triangles[i]).p) {
                    box.low = glm::min(box.low, p);
                    box.high = glm::max(box.high, p);
                }
            return box;
        },
        [](const Bounds& a, const Bounds& b) {
            return Bounds{glm::min(a.low, b.low), glm::max(a.high, b.high)};
        });
}

using FaceCells = std::array<Cells, 6>;

FaceCells merge(FaceCells a, const FaceCells& b) {
    for (size_t f = 0; f < 6; ++f)
        a[f] |= b[f];
    return a;
}

} // namespace

BoxCover measure_box_cover(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles) {
    BoxCover cover{};
    const Bounds box = bounds_of(positions, triangles);
    const glm::dvec3 size = box.high - box.low;
    if (!(size.x > 0 && size.y > 0 && size.z > 0))
        return cover; // nothing, or flat: no room
    const FaceCells cells = tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, triangles.size(), TRIANGLE_GRAIN), FaceCells{},
        [&](const tbb::blocked_range<size_t>& range, FaceCells marked) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const TriangleCorners corners = corners_of(positions, triangles[i]);
                for (size_t f = 0; f < 6; ++f)
                    cover_face(marked[f], BOX_FACES[f], corners, box);
            }
            return marked;
        },
        merge);
    for (size_t f = 0; f < 6; ++f)
        cover[f] = double(cells[f].count()) / (GRID * GRID);
    return cover;
}

bool is_room(const BoxCover& cover) {
    return std::count_if(cover.begin(), cover.end(), [](double c) { return c >= COVERED; }) >=
           WALLS_OF_A_ROOM;
}

std::optional<BoxFace> open_side(const BoxCover& cover) {
    if (!is_room(cover))
        return std::nullopt;
    const size_t least = size_t(std::min_element(cover.begin(), cover.end()) - cover.begin());
    return cover[least] < COVERED ? std::optional(BOX_FACES[least]) : std::nullopt;
}

} // namespace clrt
