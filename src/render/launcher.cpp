// SPDX-License-Identifier: Apache-2.0
#include "render/launcher.h"

#include "device/opencl_error.h"
#include "seconds.h"

#include <algorithm>

namespace clrt {

namespace {

/// Work-groups a row of the launch grid; keeps both grid dimensions below 65535 work-items, beyond which some
/// drivers compile another variant.
constexpr u32 GRID_COLUMNS = 2048;

} // namespace

double run_groups(const Device& device, const Kernel& kernel, u32 groups, const std::string& doing) {
    const u32 columns = std::clamp(groups, 1u, GRID_COLUMNS);
    const u32 rows = std::max((groups + columns - 1) / columns, 1u);
    const bool is_processor = device.info.type == "CPU";
    const double begun = is_processor ? processor_seconds() : 0;
    cl_ulong start = 0, end = 0; // nanoseconds
    check_opencl(doing, [&] {
        cl::Event event;
        device.queue.enqueueNDRangeKernel(kernel.handle(), cl::NullRange,
                                          cl::NDRange(columns * TILE_SIZE, rows * TILE_SIZE),
                                          cl::NDRange(TILE_SIZE, TILE_SIZE), nullptr, &event);
        device.queue.finish();
        start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
        end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    });
    return is_processor ? processor_seconds() - begun : 1e-9 * double(end - start);
}

Launcher::Launcher(const Device& device, const Program& program, const std::string& name,
                   const RenderParams& params, const SceneBuffers& buffers)
    : device_(device), kernel_(program, name), params_(params) {
    bind_scene(buffers, kernel_);
}

void Launcher::run(std::uint32_t first, std::uint32_t count, u32 first_tile, u32 end_tile) {
    RenderParams params = params_;
    params.first_sample = first;
    params.sample_count = count;
    launch(params, first_tile, end_tile);
}

void Launcher::run_half(int half, u32 first_tile, u32 end_tile) {
    RenderParams params = params_;
    params.dealt_replicates = params.replicates / 2;
    params.first_replicate = u32(half) * params.dealt_replicates;
    launch(params, first_tile, end_tile);
}

void Launcher::launch(RenderParams params, u32 first_tile, u32 end_tile) {
    params.first_tile = first_tile;
    params.end_tile = end_tile;
    kernel_.set("params", params);
    device_seconds_ += run_groups(device_, kernel_, end_tile - first_tile, "rendering");
}

} // namespace clrt
