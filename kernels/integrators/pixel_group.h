// SPDX-License-Identifier: Apache-2.0
// The loop over the samples of a group of pixels, whose paths serve each other (path_reuse.h). A tile is cut
// into cells, of each of which a group has one pixel, by chance: noise that a group's pixels have in common
// shows neither as blocks nor as a lattice.
#ifndef CLRT_INTEGRATORS_PIXEL_GROUP_H
#define CLRT_INTEGRATORS_PIXEL_GROUP_H

#include "emission_rays.h"

/* Pixels of a cell, side by side and one below the other: as many as there are groups in a tile. */
#define CELL_COLUMNS 2u
#define CELL_ROWS 4u
#define CELL_PIXELS (CELL_COLUMNS * CELL_ROWS)
#define CELLS_IN_ROW (TILE_SIZE / CELL_COLUMNS)

/* Which group of its tile a work-item renders; those from CELL_PIXELS on have none. */
static inline uint group_number(void)
{
    return (uint)(get_local_id(1) * TILE_SIZE + get_local_id(0));
}

/* The pixel that a group has in cell number `cell` of a tile, whose first pixel is `corner`; false for
   padding. `dealt`: a random word of the tile. */
static inline bool group_pixel(const RenderParams* params, TilePixel corner, uint dealt, uint group,
                               uint cell, TilePixel* pixel)
{
    const uint place = group ^ (dealt >> (3u * cell) & (CELL_PIXELS - 1u));
    const uint x = cell % CELLS_IN_ROW * CELL_COLUMNS + place % CELL_COLUMNS;
    const uint y = cell / CELLS_IN_ROW * CELL_ROWS + place / CELL_COLUMNS;
    pixel->x = corner.x + x;
    pixel->y = corner.y + y;
    pixel->slot = corner.slot + y * TILE_SIZE + x;
    return tile_is_inside(params, *pixel);
}

/* The pixels of a group that are inside the window; gives their number. `place`: any pixel of the tile. */
static inline uint group_pixels(const RenderParams* params, TilePixel place, uint group, TilePixel* pixels)
{
    const TilePixel corner = {place.x & ~(TILE_SIZE - 1u), place.y & ~(TILE_SIZE - 1u),
                              place.slot & ~(TILE_PIXELS - 1u)};
    const uint dealt =
        sampler_hash(tile_pixel_number(params, params->crop_x + corner.x, params->crop_y + corner.y) ^
                     params->seed);
    uint count = 0u;
    for (uint cell = 0; cell < REUSE_PIXELS; ++cell)
        count += group_pixel(params, corner, dealt, group, cell, &pixels[count]) ? 1u : 0u;
    return count;
}

/* Takes the samples of this launch of the pixels of a work-item's group; `place` is its own pixel. */
static CLRT_NOINLINE void work_item_render(const Scene* scene, const RenderParams* params, TilePixel place,
                                           global long* film, global uint* pixel_rays,
                                           global volatile uint* counters)
{
    TilePixel places[REUSE_PIXELS];
    PixelRays rays[REUSE_PIXELS];
    const uint group = group_number();
    const uint members = group < CELL_PIXELS ? group_pixels(params, place, group, places) : 0u;
    if (members == 0u)
        return;
    uint emission[REUSE_PIXELS];
    CameraSample samples[SAMPLES_AT_ONCE];
    for (uint m = 0; m < members; ++m) {
        rays[m] = (PixelRays){0u, 0u, 0u, 0ul, 0u};
        emission[m] = emission_settle(scene, params, pixel_rays, places[m], &samples->ray);
    }
    const SampleRange range = tile_samples(params, pixel_rays, place.slot);
    SampleCounter counter = sample_counter_make(params, range.first);
    const uint step = SAMPLES_AT_ONCE / REUSE_PIXELS;
    for (uint i = 0; i < range.count; i += step) {
        const uint count = min(step, range.count - i);
        for (uint m = 0; m < members; ++m) {
            CLRT_PREFETCH(film_sums(params, film, places[m].slot, counter.replicate));
            const uint x = params->crop_x + places[m].x, y = params->crop_y + places[m].y;
            emission_begin(scene, params, emission[m], x, y, counter, samples + m * count, count, rays + m);
            pixel_aim(scene, params, film, x, y, counter, samples + m * count, count);
            for (uint k = 0; k < count; ++k)
                samples[m * count + k].member = m;
        }
        INTEGRATOR_RADIANCE(scene, params, samples, count * members, rays);
        SampleCounter next = counter;
        for (uint m = 0; m < members; ++m) {
            next = counter;
#if PATH_GUIDE
            pixel_add_gain(scene, places[m].slot, samples + m * count, count);
#endif
            pixel_add(params, places[m], samples + m * count, count, &next, film, pixel_rays, counters);
        }
        counter = next;
    }
    for (uint m = 0; m < members; ++m)
        film_add_counts(&rays[m], range.count, pixel_rays + tile_index(places[m].slot, PIXEL_RAYS_WORDS));
}

#endif
