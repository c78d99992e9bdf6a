// SPDX-License-Identifier: Apache-2.0
// Rays that have met a surface and leave it again.
#pragma once

#include "probes/aimed_rays.h"

namespace clrt {

/// Rays with their hits, misses left out.
struct Arrivals {
    std::vector<TestRay> rays;
    std::vector<TestHit> hits;
};

Arrivals arrivals(const RayDevice& device, const std::vector<TestRay>& rays);

/// A direction on the side of the plane from which the ray came, at the given cosine to its normal; rounded
/// to float and on that side even so. `normal` is exact.
glm::dvec3 leaving_direction(const glm::dvec3& normal, const TestRay& ray, double cos_o, Random& random);

/// Cosines of which one in four is grazing.
double any_cosine(Random& random);

/// The arrivals' rays as they leave at random on the side that they came from.
std::vector<TestRay> leave_at_random(const Scene& scene, const RayDevice& device, const Arrivals& from,
                                     Random& random);

/// A tetrahedron with corners in its own positions.
Scene make_tetrahedron(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);

/// Rays within a convex room towards its walls: anywhere, into the edges between walls, and into the corners.
std::vector<TestRay> rays_in_room(const Scene& room, size_t count, Random& random);

} // namespace clrt
