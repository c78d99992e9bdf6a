// SPDX-License-Identifier: Apache-2.0
// The loop over a pixel's samples, and the entry point. An integrator's .cl file includes this last and
// defines before
//   INTEGRATOR_KERNEL    the entry point's name
//   INTEGRATOR_RADIANCE  the integrator's function (pixel.h)
// Builds with -DCLRT_TRACE have the entry point of replay.h instead.
#ifndef CLRT_INTEGRATORS_ENTRY_POINT_H
#define CLRT_INTEGRATORS_ENTRY_POINT_H

#include "emission_rays.h"

/* What a kernel that guides paths takes besides. */
#if PATH_GUIDE
#define GUIDE_PARAMS \
    , global const uint* restrict guide_links, global const GuideCell* restrict guide_cells, \
        global long *guide_sums, global const float *restrict guide_weights, global long *guide_gains
#define GUIDE_SET(scene) \
    ((scene).guide.links = guide_links, (scene).guide.cells = guide_cells, (scene).guide.sums = guide_sums, \
     (scene).guide.weights = guide_weights, (scene).guide.gains = guide_gains)
#else
#define GUIDE_PARAMS
#define GUIDE_SET(scene)
#endif

#ifdef CLRT_TRACE
#include "replay.h"
#else

#if PATH_REUSE
#include "pixel_group.h"
#else
/* Takes the samples of this launch of a work-item's pixel. Out of line, because some compilers compile an entry point's
   body several times. */
static CLRT_NOINLINE void work_item_render(const Scene* scene, const RenderParams* params, TilePixel place,
                                           global long* film, global uint* pixel_rays,
                                           global volatile uint* counters)
{
    if (!tile_is_inside(params, place))
        return;
    PixelRays rays = {0u, 0u, 0u, 0ul, 0u};
    const uint x = params->crop_x + place.x, y = params->crop_y + place.y;
    const SampleRange range = tile_samples(params, pixel_rays, place.slot);
    SampleCounter counter = sample_counter_make(params, range.first);
    CameraSample samples[SAMPLES_AT_ONCE];
    const uint emission = emission_settle(scene, params, pixel_rays, place, &samples->ray);
    for (uint i = 0; i < range.count; i += SAMPLES_AT_ONCE) {
        const uint count = min((uint)SAMPLES_AT_ONCE, range.count - i);
        CLRT_PREFETCH(film_sums(params, film, place.slot, counter.replicate));
        emission_begin(scene, params, emission, x, y, counter, samples, count, &rays);
        pixel_aim(scene, params, film, x, y, counter, samples, count);
        INTEGRATOR_RADIANCE(scene, params, samples, count, &rays);
#if PATH_GUIDE
        pixel_add_gain(scene, place.slot, samples, count);
#endif
        pixel_add(params, place, samples, count, &counter, film, pixel_rays, counters);
    }
    film_add_counts(&rays, range.count, pixel_rays + tile_index(place.slot, PIXEL_RAYS_WORDS));
}
#endif

CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void INTEGRATOR_KERNEL(
    const RenderParams params, SCENE_PARAMS, global long* restrict film, global uint* restrict pixel_rays,
    global volatile uint* counters GUIDE_PARAMS)
{
    TilePixel place;
    if (!tile_place(&params, &place))
        return;
    Scene scene = SCENE_MAKE;
    GUIDE_SET(scene);
    work_item_render(&scene, &params, place, film, pixel_rays, counters);
}

#endif

#endif
