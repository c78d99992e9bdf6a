// SPDX-License-Identifier: Apache-2.0
// How a scene's box is closed by walls.
#pragma once

#include "kernels/shared/scene_types.h"

#include <array>
#include <optional>
#include <vector>

namespace clrt {

/// A face of a box: the axis that it is perpendicular to and the axis' end.
struct BoxFace {
    int axis;
    double sign;
};

/// The faces in their order everywhere.
constexpr BoxFace BOX_FACES[6] = {{2, 1}, {2, -1}, {0, 1}, {0, -1}, {1, 1}, {1, -1}};

/// How much of each face of the scene's box is covered by triangles that lie near it and face inwards, 0..1.
/// A room covers four to six of them, a solid thing none.
using BoxCover = std::array<double, 6>;

/// A face with this much wall counts as closed: windows and doors are open.
constexpr double COVERED = 0.6;
/// Closed faces of a room at least.
constexpr int WALLS_OF_A_ROOM = 4;

/// Measures the cover on a grid of points per face.
BoxCover measure_box_cover(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles);

/// Whether so covered a scene is a room by its walls.
bool is_room(const BoxCover& cover);

/// The side through which a room that is closed elsewhere can be looked into.
std::optional<BoxFace> open_side(const BoxCover& cover);

} // namespace clrt
