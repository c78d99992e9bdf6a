// SPDX-License-Identifier: Apache-2.0
// Launches a render kernel on a range of samples and tiles.
#pragma once

#include "device/device.h"
#include "device/program.h"
#include "kernels/shared/render_types.h"
#include "render/scene_buffers.h"

#include <cstdint>
#include <string>

namespace clrt {

/// Launches work-groups of 8 x 8 work-items, at least one, and waits; `doing` is how an error names that.
/// Returns the device's own seconds, which other programs disturb little: where it is the processor, those
/// that all threads of this process were at work, else those between start and end by the device's clock.
double run_groups(const Device& device, const Kernel& kernel, u32 groups, const std::string& doing);

/// One kernel with its parameters; launches tiles and samples of them.
class Launcher {
public:
    Launcher(const Device& device, const Program& program, const std::string& name,
             const RenderParams& params, const SceneBuffers& buffers);
    /// For binding the outputs.
    Kernel& kernel() { return kernel_; }

    /// Runs `count` samples from `first` on tiles [first_tile, end_tile) and waits.
    void run(std::uint32_t first, std::uint32_t count, u32 first_tile, u32 end_tile);
    /// Runs the samples of half `half` of the replicates that FilmBuffers::write_tile_ranges named, on tiles
    /// [first_tile, end_tile), and waits.
    void run_half(int half, u32 first_tile, u32 end_tile);

    /// The next launches belong to this epoch of a guided render.
    void set_epoch(u32 epoch) { params_.epoch = epoch; }
    /// The guide learns from samples up to this one (RenderParams::guide_learns).
    void set_teachers(u32 last_reversed) { params_.guide_learns = last_reversed; }

    /// Of all launches so far, as run_groups counts them.
    double device_seconds() const { return device_seconds_; }

private:
    void launch(RenderParams params, u32 first_tile, u32 end_tile);

    const Device& device_;
    Kernel kernel_;
    RenderParams params_;
    double device_seconds_ = 0;
};

} // namespace clrt
