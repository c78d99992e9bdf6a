// SPDX-License-Identifier: Apache-2.0
// Closed meshes of about unit size around the origin, for rays that must not get out.
#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// A closed mesh with balls that are surely inside it.
struct ClosedMesh {
    std::string name, place;
    Scene scene;             ///< positions, triangles and an opaque material only
    std::vector<vec4> cores; ///< centre, and radius in w
};

/// A sphere of triangles of ordinary shape.
ClosedMesh make_sphere();

/// Two fans of needles, 16 long and 0.006 wide, that share a rim and close a spindle.
ClosedMesh make_needle_fans();

/// A torus whose every vertex is moved by a random share of the tube's radius.
ClosedMesh make_noise_torus();

/// A torus of 262,144 triangles with a rough surface in a large ball, from which no ray escapes, before a
/// camera: a scene for timing where none is given.
Scene make_rough_scene();

/// The meshes as they are and in the frame that the loader brings every scene to: at the origin, a million
/// away, at sizes of 1e-6 and 1e6.
std::vector<ClosedMesh> watertight_meshes();

/// Whether a mesh is closed by the triangles that have an area: a triangle whose three different corners lie
/// on one line closes a gap between its neighbours, but is in no tree.
bool is_closed_by_areas(const Scene& scene);

} // namespace clrt
