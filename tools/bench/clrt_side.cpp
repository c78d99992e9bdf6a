// SPDX-License-Identifier: Apache-2.0
#include "bench/clrt_side.h"

#include "device/opencl_error.h"
#include "render/launcher.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

/// Measures the building of the tree; compiles none of the renderer's programs.
PreparedScene prepare_measured(const Device& device, const std::shared_ptr<const PlannedScene>& planned,
                               Cost& cost) {
    PreparedParts parts;
    cost = measure([&] { parts.tree = plan_tree(device.info, *planned); });
    return prepare_scene(device, planned, parts);
}

Program build(const PreparedScene& prepared, const KernelFiles& files, const std::string& name,
              const std::vector<std::string>& defines = {}) {
    const DeviceOptions& options = prepared.planned->options.device;
    ProgramRequest request;
    request.name = name;
    request.source = expand_kernel_source(files, "bench/" + name + ".cl");
    request.defines = {fmt::format("CLRT_EFFECTS={:#x}u", prepared.planned->effects.mask),
                       fmt::format("BVH_LAYOUT={}", int(prepared.tree->bvh.layout))};
    request.defines.insert(request.defines.end(), defines.begin(), defines.end());
    request.dump_folder = options.dump_folder;
    request.cache = {options.cache, options.cache_folder};
    return build_program(prepared.device, request);
}

template <class T>
std::vector<T> read_buffer(const Device& device, const cl::Buffer& buffer, size_t count) {
    std::vector<T> values(count);
    check_opencl("reading rays back", [&] {
        if (count)
            device.queue.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
    });
    return values;
}

/// The rays of a buffer, without those that are none.
std::vector<BenchRay> read_rays(const Device& device, const cl::Buffer& buffer, size_t count) {
    std::vector<BenchRay> rays = read_buffer<BenchRay>(device, buffer, count);
    const auto is_none = [](const BenchRay& ray) { return !(ray.origin.w > 0); };
    rays.erase(std::remove_if(rays.begin(), rays.end(), is_none), rays.end());
    return rays;
}

} // namespace

const char* ray_kind_name(RayKind kind) {
    switch (kind) {
    case RayKind::PRIMARY:
        return "primary";
    case RayKind::SHADOW:
        return "shadow";
    case RayKind::DIFFUSE:
        return "diffuse";
    case RayKind::MIRROR:
        break;
    }
    return "mirror";
}

ClrtSide::ClrtSide(const Device& device, const KernelFiles& files,
                   const std::shared_ptr<const PlannedScene>& planned)
    : device_(device), files_(files), prepared_(prepare_measured(device, planned, build_cost_)),
      params_(launch_params(*planned)), trace_(build(prepared_, files, "trace")),
      closest_(make_kernel(trace_, "trace_closest")), any_(make_kernel(trace_, "trace_any")) {
    params_.end_tile = params_.tile_count;
    params_.sample_count = 1;
}

Kernel ClrtSide::make_kernel(const Program& program, const std::string& name) const {
    Kernel kernel(program, name);
    if (takes_scene(kernel))
        bind_scene(prepared_.buffers, kernel);
    kernel.set("params", params_);
    return kernel;
}

const Program& ClrtSide::ray_maker() {
    if (!ray_maker_)
        ray_maker_ = build(prepared_, files_, "make_rays");
    return *ray_maker_;
}

void ClrtSide::launch(Kernel& kernel, u32 count) {
    run_groups(device_, kernel, (count + RAYS_PER_BLOCK - 1) / RAYS_PER_BLOCK,
               "running the kernel " + kernel.name());
}

std::vector<BenchRay> ClrtSide::primary_rays(u32 sample) {
    const size_t slots = size_t(params_.tile_count) * TILE_PIXELS;
    const cl::Buffer made = create_buffer(device_, "rays", slots * sizeof(BenchRay));
    params_.first_sample = sample;
    Kernel kernel = make_kernel(ray_maker(), "make_primary");
    kernel.set("rays", made);
    launch(kernel, u32(slots));
    return read_rays(device_, made, slots);
}

std::vector<BenchRay> ClrtSide::secondary_rays(RayKind kind, const std::vector<BenchRay>& rays,
                                               const std::vector<BenchHit>& hits, u32 sample, u32 bounce) {
    const cl::Buffer made = create_buffer(device_, "rays", rays.size() * sizeof(BenchRay));
    params_.first_sample = sample;
    Kernel kernel = make_kernel(ray_maker(), "make_secondary");
    kernel.set("rays", upload_buffer(device_, "rays", rays));
    kernel.set("hits", upload_buffer(device_, "hits", hits));
    kernel.set("count", u32(rays.size()));
    kernel.set("kind", u32(kind));
    kernel.set("bounce", bounce);
    kernel.set("made", made);
    launch(kernel, u32(rays.size()));
    return read_rays(device_, made, rays.size());
}

DeviceRays ClrtSide::upload(const std::vector<BenchRay>& rays) const {
    return {upload_buffer(device_, "rays", rays),
            create_buffer(device_, "hits", rays.size() * sizeof(BenchHit)), u32(rays.size())};
}

void ClrtSide::launch_over(Kernel& kernel, const DeviceRays& rays) {
    kernel.set("rays", rays.rays);
    kernel.set("count", rays.count);
    kernel.set("hits", rays.hits);
    launch(kernel, rays.count);
}

void ClrtSide::trace(bool any_hit, const DeviceRays& rays) {
    launch_over(any_hit ? any_ : closest_, rays);
}

Visits ClrtSide::count_visits(bool any_hit, const DeviceRays& rays) {
    if (!visits_)
        visits_ = build(prepared_, files_, "visits", {"CLRT_COUNT_VISITS=1"});
    Kernel kernel = make_kernel(*visits_, any_hit ? "visits_any" : "visits_closest");
    launch_over(kernel, rays);
    struct Counts {
        u32 nodes, leaves, triangles, unused;
    };
    Visits mean;
    for (const Counts& counts : read_buffer<Counts>(device_, rays.hits, rays.count)) {
        mean.nodes += double(counts.nodes) / rays.count;
        mean.leaves += double(counts.leaves) / rays.count;
        mean.triangles += double(counts.triangles) / rays.count;
    }
    return mean;
}

std::vector<BenchHit> ClrtSide::read(const DeviceRays& rays) const {
    return read_buffer<BenchHit>(device_, rays.hits, rays.count);
}

} // namespace clrt
