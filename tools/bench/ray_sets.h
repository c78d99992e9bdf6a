// SPDX-License-Identifier: Apache-2.0
// The rays that are traced: made once, by the renderer's own functions, and used by every side.
#pragma once

#include "bench/clrt_side.h"

#include <vector>

namespace clrt {

/// All rays of a kind.
struct RaySet {
    RayKind kind = RayKind::PRIMARY;
    std::vector<BenchRay> rays;
};

/// Makes primary rays, and from their hits one ray of every other kind: up to `most` of each. Where few
/// primary rays hit, more samples a pixel fill the other kinds up.
std::vector<RaySet> make_ray_sets(ClrtSide& clrt, size_t most);

} // namespace clrt
