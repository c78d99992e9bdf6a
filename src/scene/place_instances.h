// SPDX-License-Identifier: Apache-2.0
// Meshes that instances share -> the scene's arrays, and what stands for the instances until then.
#pragma once

#include "scene/normalise.h"
#include "scene/notices.h"
#include "scene/scene_description.h"

#include <cstddef>
#include <string>

namespace clrt {

/// What a map does to a mesh.
enum class MapKind {
    PLACES,   ///< it can be undone, also in floats
    FLATTENS, ///< to a plane, or nearly
    VANISHES  ///< to a line or a point, or it is not finite: no triangle can be seen
};

/// How well an affine map can be undone; its scale does not count.
MapKind kind_of_map(const glm::dmat4& to_world);

/// The instance of prototype 0 and object 0 under a map from the prototype's frame to the normalised one; the
/// prototype's |coordinates| are at most `largest`. Rounds the map to floats and inverts what that gives.
Instance make_instance(const glm::dmat4& map, const glm::dvec3& largest);

/// The box around all instances in world units, or that of `own` where there are none; `own`: the box of
/// `description.mesh`, taken in where that has triangles. Exact as long as that takes no second, else the box
/// around the boxes of prototypes.
Bounds bounds_with_instances(const SceneDescription& description, const Bounds& own);

/// Triangles that stand for the instances while the camera is fitted and the light chosen: the last of the
/// scene's own.
struct StandIns {
    size_t first_triangle = 0, triangles = 0;
    size_t first_position = 0, positions = 0;
};

/// Appends every triangle of every instance in the normalised frame, without normals; where they would be
/// more than a million, an even choice of each prototype's, at least one an instance.
StandIns add_stand_ins(const SceneDescription& description, Scene& scene);

/// Takes them away; what has been appended since moves up.
void remove_stand_ins(const StandIns& stand_ins, Scene& scene);

/// Appends the prototypes' triangles in frames of their own, releases the meshes, and places the instances.
/// Those too small beside the scene for floats to tell their corners apart are left out with a notice. Throws
/// SceneError for more vertices than indices reach.
void append_instances(SceneDescription& description, const std::string& path, Scene& scene,
                      NoticeList& notices);

} // namespace clrt
