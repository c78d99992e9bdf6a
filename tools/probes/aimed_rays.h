// SPDX-License-Identifier: Apache-2.0
// Rays where tracing is hard: aimed at vertices and edges, near the origin and far away. Random rays prove
// nothing about watertightness: they never come near an edge.
#pragma once

#include "probes/meshes.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"

namespace clrt {

/// How large a mesh of radius 1 is made, and how far from the origin it is put.
struct Placement {
    const char* name;
    double size;
    double distance;
};

constexpr Placement PLACEMENTS[] = {
    {"1@0", 1, 0}, {"2@2.6e5", 2, 2.6e5}, {"1e-6@0", 1e-6, 0}, {"1e7@0", 1e7, 0}, {"1@1e4", 1, 1e4}};

/// A scene in its placement, away from all axes.
Scene place(const Scene& scene, const Placement& placement);

enum class Aim { VERTEX, EDGE };

/// The largest distance of a spike's tip is 6 times that of the ball inside.
constexpr double BALL_INNER = 0.95, STAR_INNER = 0.95 / 6;

/// Rays from the inner 40 % of a star-shaped mesh to its vertices or to points of its edges. `inner` is the
/// radius of the ball that the mesh encloses, over the smallest half edge of its box.
std::vector<TestRay> aimed_rays(const Scene& scene, double inner, Aim aim, size_t count, u32 seed);

/// Rays from around the cube [-1, 1]^3 to points within and to corners of triangles.
std::vector<TestRay> rays_at(const Scene& scene, size_t count, u32 seed);

/// Rays whose origin, direction or both lie in planes on the lattice of quarters; zeros have either sign.
std::vector<TestRay> rays_in_lattice_planes(size_t count, u32 seed);

/// Cubes with corners on the lattice of quarters: their faces share planes, and so do the boxes of the tree.
Scene make_cubes();

/// Rays down on the flat grid y = 0 in cells of 2 / `cells`, at its corners and edges; a quarter exactly from
/// above.
std::vector<TestRay> rays_at_flat_grid(const Scene& grid, int cells, size_t count, u32 seed);

/// A random point of a triangle.
glm::dvec3 point_on(const Scene& scene, const Triangle& triangle, Random& random);

/// How many hits are none.
size_t count_misses(const std::vector<TestHit>& hits);

/// How many hits differ in any bit.
size_t count_differences(const std::vector<TestHit>& a, const std::vector<TestHit>& b);

} // namespace clrt
