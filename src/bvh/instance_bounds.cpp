// SPDX-License-Identifier: Apache-2.0
#include "bvh/instance_bounds.h"

#include <array>
#include <cmath>

namespace clrt {
namespace {

/// Cells along each axis of a prototype's box, which its corners are sorted into.
constexpr int CELLS = 4;

/// Three roundings put a corner to its place (instance_coordinate), each by at most 2^-24 of the sum of what
/// is added; the one more is for those that bound them.
constexpr double PLACING_ERROR = 4 * 0x1p-24;

template <class Visit>
void for_each_corner(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles,
                     const Visit& visit) {
    for (const Triangle& t : triangles)
        for (const u32 v : {t.v0, t.v1, t.v2})
            visit(box_corner(positions[v]));
}

int cell_of(const Box& box, Float4 p) {
    int cell = 0;
    for (int axis = 2; axis >= 0; --axis) {
        const float size = box.upper[axis] - box.lower[axis];
        const float share = size > 0 ? (p[axis] - box.lower[axis]) / size : 0;
        cell = cell * CELLS + std::min(int(share * CELLS), CELLS - 1);
    }
    return cell;
}

} // namespace

PrototypeHull::PrototypeHull(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles) {
    Box all;
    for_each_corner(positions, triangles, [&](Float4 p) { all.extend(p); });
    std::array<Box, CELLS * CELLS * CELLS> cells;
    for_each_corner(positions, triangles, [&](Float4 p) { cells[size_t(cell_of(all, p))].extend(p); });
    for (const Box& cell : cells) {
        if (cell.lower[0] > cell.upper[0])
            continue;
        Part part;
        for (int axis = 0; axis < 3; ++axis) {
            part.centre[axis] = 0.5f * (cell.lower[axis] + cell.upper[axis]);
            part.half[axis] =
                std::max(cell.upper[axis] - part.centre[axis], part.centre[axis] - cell.lower[axis]);
            largest_[axis] =
                std::max({largest_[axis], std::fabs(cell.lower[axis]), std::fabs(cell.upper[axis])});
        }
        parts_.push_back(part);
    }
}

Box PrototypeHull::placed(const Instance& instance) const {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
        const vec4& row = instance.to_world[axis];
        const double m[3] = {row.x, row.y, row.z};
        double lower = INFINITE_FLOAT, upper = -INFINITE_FLOAT, largest = std::fabs(row.w);
        for (const Part& part : parts_) {
            double centre = row.w, half = 0;
            for (int k = 0; k < 3; ++k) {
                centre += m[k] * double(part.centre[k]);
                half += std::fabs(m[k]) * double(part.half[k]);
            }
            lower = std::min(lower, centre - half);
            upper = std::max(upper, centre + half);
        }
        for (int k = 0; k < 3; ++k)
            largest += std::fabs(m[k]) * double(largest_[k]);
        box.lower[axis] = std::nextafter(float(lower - PLACING_ERROR * largest), -INFINITE_FLOAT);
        box.upper[axis] = std::nextafter(float(upper + PLACING_ERROR * largest), INFINITE_FLOAT);
    }
    box.lower[3] = box.upper[3] = 0;
    return box;
}

} // namespace clrt
