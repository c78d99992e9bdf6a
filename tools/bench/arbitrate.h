// SPDX-License-Identifier: Apache-2.0
// Who is right where two hits of a ray differ: all triangles in double precision decide.
#pragma once

#include "bench/bench_rays.h"
#include "scene/scene.h"

#include <string>
#include <vector>

namespace clrt {

/// What rounding excuses.
struct RoundingBound {
    /// Error of a corner seen along a ray, on two axes across it, as a share of its largest component from
    /// the origin: what the triangle test in single precision cannot avoid (kernels/geometry/box.h).
    double shear = 0;
};

/// The bound for devices that divide with correct rounding, or within 2.5 units in the last place.
RoundingBound rounding_bound(bool correctly_rounded_division);

/// The comparison of clrt's hits with a rival's.
struct Verdict {
    size_t rays = 0;
    size_t twins = 0;       ///< different triangles at distances that agree, such as at a shared edge
    size_t differences = 0; ///< beyond what rounding excuses; of which
    size_t judged = 0;      ///< were decided; of those
    size_t clrt_wrong = 0, rival_wrong = 0; ///< hit what is not there, or overlooked what is nearer
    std::string first_wrong; ///< the first ray that clrt got wrong, with both hits; empty: none
};

/// At most so many differences of a set of rays are judged: each takes a pass over all triangles.
constexpr size_t MOST_JUDGED = 1000;

/// Compares the hits of all rays. `any_hit`: only whether there is a hit counts.
Verdict arbitrate(const Scene& scene, const RoundingBound& bound, bool any_hit,
                  const std::vector<BenchRay>& rays, const std::vector<BenchHit>& clrt,
                  const std::vector<BenchHit>& rival);

/// True if no rounding excuses a closest hit: its triangle is not there, or a nearer one was overlooked.
bool closest_is_wrong(const Scene& scene, const RoundingBound& bound, const BenchRay& ray,
                      const BenchHit& hit);

/// True if no rounding excuses the answer to whether something is in between.
bool any_is_wrong(const Scene& scene, const RoundingBound& bound, const BenchRay& ray, bool found);

} // namespace clrt
