// SPDX-License-Identifier: Apache-2.0
#include "bench/ray_sets.h"

#include <algorithm>

namespace clrt {

namespace {

/// Where few primary rays hit, more samples a pixel fill the other kinds up; so many at most.
constexpr u32 MOST_SAMPLES = 16;

std::vector<BenchHit> trace_closest(ClrtSide& clrt, const std::vector<BenchRay>& rays) {
    const DeviceRays device_rays = clrt.upload(rays);
    clrt.trace(/*any_hit=*/false, device_rays);
    return clrt.read(device_rays);
}

} // namespace

std::vector<RaySet> make_ray_sets(ClrtSide& clrt, size_t most) {
    std::vector<RaySet> sets;
    for (const RayKind kind : RAY_KINDS)
        sets.push_back({kind, {}});
    bool complete = false;
    for (u32 sample = 0; sample < MOST_SAMPLES && !complete; ++sample) {
        const std::vector<BenchRay> primary = clrt.primary_rays(sample);
        const std::vector<BenchHit> hits = trace_closest(clrt, primary);
        complete = true;
        for (RaySet& set : sets) {
            if (set.rays.size() >= most)
                continue;
            const std::vector<BenchRay> made = set.kind == RayKind::PRIMARY
                                                   ? primary
                                                   : clrt.secondary_rays(set.kind, primary, hits, sample, 1);
            set.rays.insert(set.rays.end(), made.begin(), made.end());
            set.rays.resize(std::min(set.rays.size(), most));
            complete = complete && (set.rays.size() >= most || made.empty());
        }
    }
    return sets;
}

} // namespace clrt
