// SPDX-License-Identifier: Apache-2.0
// Generated scenes for tests: positions, triangles and one opaque material, nothing else.
#pragma once

#include "scene/scene.h"

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace clrt {

/// A corner's position as the scene stores it.
glm::dvec3 corner_position(const Scene& scene, const Triangle& triangle, int corner);

/// Not normalised, by winding; exact but for the rounding of double.
glm::dvec3 triangle_normal(const Scene& scene, const Triangle& triangle);

/// Appends a position, rounded to float, and gives its index.
u32 add_position(Scene& scene, const glm::dvec3& position);

/// Appends a triangle over existing positions.
void add_triangle(Scene& scene, u32 v0, u32 v1, u32 v2);

/// Appends a triangle with positions of its own.
void add_triangle(Scene& scene, const glm::dvec3& p0, const glm::dvec3& p1, const glm::dvec3& p2);

/// Appends the positions and triangles of another scene.
void append_scene(Scene& scene, const Scene& other);

/// A scene without triangles and with the opaque material 0.
Scene make_empty_scene();

/// A closed ball of radius 1 around the origin: `slices` meridians, `stacks` bands, single corners at the
/// poles; winding outwards.
Scene make_ball(int slices, int stacks);

/// The same with every corner's distance from the origin multiplied by a random number in [1, 6).
Scene make_star(int slices, int stacks, unsigned seed);

/// Unconnected triangles with corners up to `size` from random centres in the cube [-1, 1]^3.
Scene make_soup(int count, double size, unsigned seed);

/// The square [-1, 1]^2 in cells of two triangles each, on the plane z = x/2 - y/4. `cells` is a power of two
/// up to 512, so that all corners lie on the plane exactly; winding towards +z.
Scene make_tilted_plane(int cells);

/// A box of twelve triangles, seen from inside: winding inwards. Corner i is at low or high along x, y, z
/// where bit 0, 1, 2 of i is 0 or 1.
Scene make_room(const glm::dvec3& low, const glm::dvec3& high);

/// Positions times `size` plus `place`, rounded to float once more.
Scene placed(Scene scene, double size, const glm::dvec3& place);

/// The scene in the normalised frame, as the loader makes it.
Scene normalised(Scene scene);

/// Makes a scene's triangles the prototype of instances under maps to the frame of another scene, whose own
/// triangles come first. May be called again with the result.
void add_instances(Scene& scene, const Scene& prototype, const std::vector<glm::dmat4>& maps);

/// The same scene without instances: each one's triangles written out behind the scene's own, with corners
/// rounded as kernels/geometry/instance.h rounds them, and with normals by double.
Scene written_out(const Scene& scene);

/// Largest |coordinate| of the triangles' corners (RenderParams::scene_extent).
float extent_of(const Scene& scene);

/// The middle of the box around the triangles, and the smallest half edge of that box.
struct Core {
    glm::dvec3 centre{0};
    double half_edge = 0;
};
Core core_of(const Scene& scene);

} // namespace clrt
