// SPDX-License-Identifier: Apache-2.0
// Embree's side of a comparison: the same triangles and rays, one ray at a time on all threads.
#pragma once

#include "bench/bench_rays.h"
#include "bench/measure.h"
#include "scene/scene.h"

#include <atomic>
#include <embree3/rtcore.h>
#include <string>
#include <vector>

namespace clrt {

class EmbreeSide {
public:
    /// Builds a tree of the best quality. `robust`: Embree's own answer to rays that slip through edges,
    /// slower. `threads` of 0: all. `isa`: one of EMBREE_ISAS, or empty for the processor's best. The scene
    /// must outlive this object. Throws std::runtime_error where Embree fails.
    EmbreeSide(const Scene& scene, bool robust, int threads, const std::string& isa);
    EmbreeSide(const EmbreeSide&) = delete;
    EmbreeSide& operator=(const EmbreeSide&) = delete;
    ~EmbreeSide();

    /// Traces all rays: rtcIntersect1 for the closest hits, rtcOccluded1 for any.
    void trace(bool any_hit, const std::vector<BenchRay>& rays, std::vector<BenchHit>& hits) const;

    /// Of building the tree.
    Cost build_cost() const { return build_cost_; }
    /// Memory of the finished tree, in bytes, without the triangles' corners that it shares with the scene.
    size_t bytes() const { return size_t(bytes_.load()); }

private:
    BenchHit closest(const BenchRay& ray) const;
    BenchHit any(const BenchRay& ray) const;

    std::atomic<long long> bytes_{0};
    Cost build_cost_;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

/// "3.13.5".
std::string embree_version();

} // namespace clrt
