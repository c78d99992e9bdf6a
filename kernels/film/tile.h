// SPDX-License-Identifier: Apache-2.0
// From work-item to pixel: a work-group is a tile of 8 x 8 pixels. Consecutive groups are spread over the
// picture, because a CPU thread takes a run of them and a run should cost what the picture costs on average.
#ifndef CLRT_FILM_TILE_H
#define CLRT_FILM_TILE_H

#include "numerics/sampler.h"
#include "shared/render_types.h"

typedef struct {
    uint x, y; /* within the window */
    uint slot; /* place among the film's sums: tile by tile, rows within a tile */
} TilePixel;

/* The slot of the pixel that a film position lies in, which is in pixels right of and below the picture's
   centre (render_types.h). False outside the window, and for what is no number. */
static inline bool tile_slot_at(const RenderParams* params, real2 position, uint* slot)
{
    const real x = floor(position.x + REAL(0.5) * (real)params->width) - (real)params->crop_x;
    const real y = floor(position.y + REAL(0.5) * (real)params->height) - (real)params->crop_y;
    if (!(x >= REAL(0.0) && x < (real)params->crop_width && y >= REAL(0.0) && y < (real)params->crop_height))
        return false;
    const uint column = (uint)x;
    const uint row = (uint)y;
    const uint tile = row / TILE_SIZE * params->tiles_x + column / TILE_SIZE;
    *slot = tile * TILE_PIXELS + row % TILE_SIZE * TILE_SIZE + column % TILE_SIZE;
    return true;
}

/* Samples that a launch takes of a pixel. */
typedef struct {
    uint first, count;
} SampleRange;

/* The same ones everywhere, or those of the tile of a slot where a launch deals to half of the replicates. */
static inline SampleRange tile_samples(const RenderParams* params, global const uint* pixel_rays, uint slot)
{
    SampleRange range = {params->first_sample, params->sample_count};
    if (params->dealt_replicates != params->replicates) {
        global const uint* ranges = pixel_rays + (ulong)PIXEL_RAYS_WORDS * TILE_PIXELS * params->tile_count;
        ranges += TILE_RANGE_WORDS * (slot / TILE_PIXELS);
        range.first = ranges[TILE_RANGE_FIRST];
        range.count = ranges[TILE_RANGE_COUNT];
    }
    return range;
}

/* This work-item's place among those of its launch: tile by tile, rows within a tile. */
static inline uint tile_launch_slot(void)
{
    const uint group = (uint)(get_group_id(1) * get_num_groups(0) + get_group_id(0));
    return group * TILE_PIXELS + (uint)(get_local_id(1) * TILE_SIZE + get_local_id(0));
}

/* Where a slot begins in an array of `words` a slot: six words of 716 million pixels are beyond 32 bits. */
static inline ulong tile_index(uint slot, uint words)
{
    return (ulong)words * slot;
}

/* Counts through samples: sample s is number s / replicates of replicate s mod replicates. */
typedef struct {
    uint sample, replicate, index;
} SampleCounter;

/* Starts with sample number `first` among those that the launch deals out. */
static inline SampleCounter sample_counter_make(const RenderParams* params, uint first)
{
    SampleCounter counter;
    counter.replicate = params->first_replicate + first % params->dealt_replicates;
    counter.index = first / params->dealt_replicates;
    counter.sample = counter.index * params->replicates + counter.replicate;
    return counter;
}

static inline void sample_counter_next(const RenderParams* params, SampleCounter* counter)
{
    if (++counter->replicate == params->first_replicate + params->dealt_replicates) {
        counter->replicate = params->first_replicate;
        ++counter->index;
    }
    counter->sample = counter->index * params->replicates + counter->replicate;
}

/* The number of the pixel (x, y) of the whole picture, by which its samples are addressed: row by row. */
static inline uint tile_pixel_number(const RenderParams* params, uint x, uint y)
{
    return y * params->width + x;
}

/* The random numbers of the sample that a counter is at, of the pixel (x, y) of the whole picture. */
static inline Sampler tile_sampler(const RenderParams* params, uint x, uint y, SampleCounter counter)
{
    return sampler_make(params->seed, tile_pixel_number(params, x, y), counter.replicate, counter.index);
}

/* True for a pixel of the window, false for what fills up tiles at its sides. */
static inline bool tile_is_inside(const RenderParams* params, TilePixel pixel)
{
    return pixel.x < params->crop_width && pixel.y < params->crop_height;
}

/* The pixel of this work-item, inside the window or not; false where the launch has no tile for it. */
static inline bool tile_place(const RenderParams* params, TilePixel* pixel)
{
    const uint group = params->first_tile + (uint)(get_group_id(1) * get_num_groups(0) + get_group_id(0));
    if (group >= params->end_tile)
        return false;
    const uint tile = (uint)(((ulong)group * params->tile_stride) % params->tile_count);
    const uint x = (uint)get_local_id(0);
    const uint y = (uint)get_local_id(1);
    pixel->x = (tile % params->tiles_x) * TILE_SIZE + x;
    pixel->y = (tile / params->tiles_x) * TILE_SIZE + y;
    pixel->slot = tile * TILE_PIXELS + y * TILE_SIZE + x;
    return true;
}

/* The pixel of this work-item; false for padding. */
static inline bool tile_pixel(const RenderParams* params, TilePixel* pixel)
{
    return tile_place(params, pixel) && tile_is_inside(params, *pixel);
}

#endif
