// SPDX-License-Identifier: Apache-2.0
// Where the pixels of a launch's tiles lie in its buffers and in the window: kernels/film/tile.h from the
// host.
#pragma once

#include "kernels/shared/render_types.h"

#include <tbb/parallel_for.h>

namespace clrt {

/// Calls use(slot, pixel) for the pixels of tiles [first_tile, end_tile) of a launch that are in the window,
/// tiles in parallel: the place among the launch's slots, and in the window's rows from the top.
template <class Use>
void for_tile_pixels(const RenderParams& params, u32 first_tile, u32 end_tile, Use&& use) {
    tbb::parallel_for(size_t(first_tile), size_t(end_tile), [&](size_t number) {
        const size_t tile = number * params.tile_stride % params.tile_count;
        for (size_t place = 0; place < TILE_PIXELS; ++place) {
            const size_t x = tile % params.tiles_x * TILE_SIZE + place % TILE_SIZE;
            const size_t y = tile / params.tiles_x * TILE_SIZE + place / TILE_SIZE;
            if (x < params.crop_width && y < params.crop_height)
                use((number - first_tile) * TILE_PIXELS + place, y * params.crop_width + x);
        }
    });
}

} // namespace clrt
