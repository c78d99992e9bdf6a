// SPDX-License-Identifier: Apache-2.0
// clrt's side of a comparison: a scene on a device, rays made and traced there by the renderer's own
// functions.
#pragma once

#include "bench/bench_kernels.h"
#include "bench/bench_rays.h"
#include "bench/measure.h"
#include "render/prepared_scene.h"

#include <memory>
#include <optional>
#include <vector>

namespace clrt {

/// Rays on the device, with a place for their hits.
struct DeviceRays {
    cl::Buffer rays, hits;
    u32 count = 0;
};

/// What rays visit on average.
struct Visits {
    double nodes = 0, leaves = 0, triangles = 0;
};

class ClrtSide {
public:
    /// Builds the tree, compiles what traces from `files`, and uploads. The device must outlive this object.
    ClrtSide(const Device& device, const KernelFiles& files,
             const std::shared_ptr<const PlannedScene>& planned);

    /// A ray for each pixel, in the order of the renderer's tiles; `sample` chooses the place within the
    /// pixel.
    std::vector<BenchRay> primary_rays(u32 sample);

    /// The rays of a kind that leave where `rays` hit, without those that hit nothing or find no light.
    /// `bounce` counts the surfaces met so far, from 1.
    std::vector<BenchRay> secondary_rays(RayKind kind, const std::vector<BenchRay>& rays,
                                         const std::vector<BenchHit>& hits, u32 sample, u32 bounce);

    DeviceRays upload(const std::vector<BenchRay>& rays) const;

    /// Traces all rays in one launch of the renderer's shape and waits.
    void trace(bool any_hit, const DeviceRays& rays);

    /// Reads the hits of the last trace.
    std::vector<BenchHit> read(const DeviceRays& rays) const;

    /// Traces once more with kernels that count; overwrites the hits.
    Visits count_visits(bool any_hit, const DeviceRays& rays);

    /// Of building the tree.
    Cost build_cost() const { return build_cost_; }
    const Bvh& bvh() const { return prepared_.tree->bvh; }
    const Scene& scene() const { return prepared_.planned->scene; }

private:
    Kernel make_kernel(const Program& program, const std::string& name) const;
    const Program& ray_maker();
    void launch(Kernel& kernel, u32 count);
    void launch_over(Kernel& kernel, const DeviceRays& rays);

    const Device& device_;
    const KernelFiles files_;
    Cost build_cost_;
    const PreparedScene prepared_;
    RenderParams params_;
    Program trace_;
    std::optional<Program> ray_maker_, visits_; ///< built when first asked for
    Kernel closest_, any_;
};

} // namespace clrt
