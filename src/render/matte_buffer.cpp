// SPDX-License-Identifier: Apache-2.0
#include "render/matte_buffer.h"

#include "device/opencl_error.h"
#include "render/tile_pixels.h"

#include <algorithm>

namespace clrt {

MatteBuffer::MatteBuffer(const Device& device, const RenderParams& params, u32 tiles)
    : device_(device), params_(params), buffer_(create_buffer(device, "hit_mattes", TILE_BYTES * tiles)),
      words_(TILE_BYTES / sizeof(u32) * tiles) {}

void MatteBuffer::write(const std::vector<u32>& slots, u32 first_tile, u32 end_tile) {
    for_tile_pixels(params_, first_tile, end_tile, [&](size_t slot, size_t pixel) {
        std::copy_n(&slots[MATTE_WORDS * pixel], MATTE_WORDS, &words_[MATTE_WORDS * slot]);
    });
    check_opencl("writing the mattes", [&] {
        device_.queue.enqueueWriteBuffer(buffer_, CL_TRUE, 0, TILE_BYTES * (end_tile - first_tile),
                                         words_.data());
    });
}

void MatteBuffer::read(std::vector<u32>& slots, u32 first_tile, u32 end_tile) {
    check_opencl("reading the mattes back", [&] {
        device_.queue.enqueueReadBuffer(buffer_, CL_TRUE, 0, TILE_BYTES * (end_tile - first_tile),
                                        words_.data());
    });
    for_tile_pixels(params_, first_tile, end_tile, [&](size_t slot, size_t pixel) {
        std::copy_n(&words_[MATTE_WORDS * slot], MATTE_WORDS, &slots[MATTE_WORDS * pixel]);
    });
}

} // namespace clrt
