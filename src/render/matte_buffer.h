// SPDX-License-Identifier: Apache-2.0
// The mattes of the tiles of one launch on the device. Samples go on counting in the slots that earlier ones
// took, so that tiles are written before a launch and read after it.
#pragma once

#include "device/device.h"
#include "device/program.h"
#include "film/matte_sums.h"
#include "kernels/shared/render_types.h"

namespace clrt {

class MatteBuffer {
public:
    /// Bytes of a tile on the device, and of as many on the host.
    static constexpr size_t TILE_BYTES = size_t(MATTE_WORDS) * TILE_PIXELS * sizeof(u32);

    /// For launches of so many tiles at most. Throws DeviceError.
    MatteBuffer(const Device& device, const RenderParams& params, u32 tiles);

    void bind(Kernel& kernel) const { kernel.set("hit_mattes", buffer_); }
    /// Hands over the slots of tiles [first_tile, end_tile).
    void write(const std::vector<u32>& slots, u32 first_tile, u32 end_tile);
    /// Takes them back.
    void read(std::vector<u32>& slots, u32 first_tile, u32 end_tile);

private:
    const Device& device_;
    const RenderParams params_;
    cl::Buffer buffer_;
    std::vector<u32> words_;
};

} // namespace clrt
