// SPDX-License-Identifier: Apache-2.0
#include "bench/watertight.h"

#include "bench/closed_meshes.h"
#include "device/opencl_error.h"
#include "device/program.h"
#include "kernels/shared/effects.h"
#include "kernels/shared/render_types.h"
#include "render/launcher.h"
#include "render/scene_buffers.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Work-groups of a launch: under a second on a CPU, and few enough for one row of the grid.
constexpr u32 LAUNCH_GROUPS = 1024;
constexpr u32 RAYS_PER_ITEM = 16;
constexpr u32 COUNTERS = 2; // AIMED_LOST, AIMED_LOST_ANY
/// Rays of a launch with so many work-groups.
constexpr std::uint64_t launch_rays(u32 groups) {
    return std::uint64_t(groups) * RAYS_PER_BLOCK * RAYS_PER_ITEM;
}

Program build_aimed(const Device& device, const WatertightRequest& request) {
    ProgramRequest program;
    program.name = "aimed";
    program.source = expand_kernel_source(request.files, "bench/aimed.cl");
    program.defines = {"CLRT_EFFECTS=0u", fmt::format("AIMED_PER_ITEM={}u", RAYS_PER_ITEM),
                       fmt::format("BVH_LAYOUT={}", int(request.layout))};
    return build_program(device, program);
}

/// A mesh on the device.
class AimedRays {
public:
    AimedRays(const Device& device, const Program& program, const ClosedMesh& mesh, BvhLayout layout)
        : device_(device), bvh_(build_bvh(mesh.scene.positions, mesh.scene.triangles, layout)),
          buffers_(upload_scene(device, mesh.scene, bvh_)), kernel_(program, "aimed_trace"),
          counters_(create_buffer(device, "counters", COUNTERS * sizeof(u32))),
          lost_(create_buffer(device, "lost", sizeof(BenchRay))) {
        bind_scene(buffers_, kernel_);
        RenderParams params{};
        params.scene_extent = mesh.scene.extent;
        kernel_.set("params", params);
        kernel_.set("cores", upload_buffer(device, "cores", mesh.cores));
        kernel_.set("core_count", u32(mesh.cores.size()));
        kernel_.set("triangle_count", u32(mesh.scene.triangles.size()));
        kernel_.set("counters", counters_);
        kernel_.set("lost", lost_);
    }

    void launch(u32 seed, u32 groups) {
        kernel_.set("seed", seed);
        run_groups(device_, kernel_, groups, "tracing aimed rays");
    }

    /// Adds what was found so far.
    void report(WatertightCase& result) const {
        u32 counts[COUNTERS] = {};
        BenchRay ray{};
        check_opencl("reading counters", [&] {
            device_.queue.enqueueReadBuffer(counters_, CL_TRUE, 0, sizeof counts, counts);
            device_.queue.enqueueReadBuffer(lost_, CL_TRUE, 0, sizeof ray, &ray);
        });
        result.triangles = bvh_.triangle_count;
        result.lost = counts[0];
        result.lost_any = counts[1];
        if (counts[0] + counts[1] > 0)
            result.lost_ray = ray;
    }

private:
    const Device& device_;
    Bvh bvh_;
    SceneBuffers buffers_;
    Kernel kernel_;
    cl::Buffer counters_, lost_;
};

} // namespace

std::vector<WatertightCase> run_watertight(const Device& device, const WatertightRequest& request,
                                           const std::function<void(double)>& progress) {
    const Program program = build_aimed(device, request);
    const std::vector<ClosedMesh> meshes = watertight_meshes();
    const std::uint64_t rays = (request.rays + meshes.size() - 1) / meshes.size();
    const u32 groups =
        u32(std::min<std::uint64_t>(LAUNCH_GROUPS, (rays + launch_rays(1) - 1) / launch_rays(1)));
    std::vector<WatertightCase> cases;
    u32 seed = 0;
    for (const ClosedMesh& mesh : meshes) {
        WatertightCase result;
        result.mesh = mesh.name;
        result.place = mesh.place;
        AimedRays aimed(device, program, mesh, request.layout);
        for (; result.rays < rays; result.rays += launch_rays(groups)) {
            if (progress)
                progress((double(cases.size()) + double(result.rays) / double(rays)) / double(meshes.size()));
            aimed.launch(seed++, groups);
        }
        aimed.report(result);
        cases.push_back(result);
    }
    return cases;
}

std::uint64_t count_lost(const std::vector<WatertightCase>& cases) {
    std::uint64_t lost = 0;
    for (const WatertightCase& result : cases)
        lost += result.lost + result.lost_any;
    return lost;
}

} // namespace clrt
