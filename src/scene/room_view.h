// SPDX-License-Identifier: Apache-2.0
// A camera inside a scene that is a room.
#pragma once

#include "scene/box_cover.h"
#include "scene/framing.h"
#include "scene/voxel_grid.h"

#include <optional>

namespace clrt {

/// Where to stand in a room and where to look, normalised frame.
struct RoomView {
    glm::dvec3 eye, at;
};

/// Whether one can look into a room through this side of its box: no wall or furniture closes most of it.
bool is_open(const VoxelGrid& grid, const BoxFace& side);

/// A view from within, where the scene is a room: rays from inside it meet walls whose fronts they see, while
/// from outside it shows backs of walls, or nothing but a plain box; without lamps it must be a box, and not
/// a closed one. The eye stands, among points of a lattice whose surroundings are free, where it sees most:
/// deep space, things before one another, and things that are no walls. It looks slightly down. Nothing for a
/// thing that is looked at from outside. `up` is a unit vector.
std::optional<RoomView> find_room_view(const VoxelGrid& grid, bool has_lamps, const glm::dvec3& up,
                                       const ViewTangents& view);

} // namespace clrt
