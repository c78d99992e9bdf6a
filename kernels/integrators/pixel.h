// SPDX-License-Identifier: Apache-2.0
// The loop over a pixel's samples that all integrators share. An integrator defines
//   real3 NAME(const Scene*, const RenderParams*, const Sampler*, Ray, PixelRays*)
// which gives the radiance along a camera ray, and instantiates RENDER_KERNEL(render_x, NAME).
#ifndef CLRT_INTEGRATORS_PIXEL_H
#define CLRT_INTEGRATORS_PIXEL_H

#include "camera/camera.h"
#include "film/film.h"
#include "film/tile.h"
#include "geometry/scene.h"

/* Counts through samples: sample s is number s / replicates of replicate s mod replicates. */
typedef struct {
    uint sample, replicate, index;
} SampleCounter;

static inline SampleCounter sample_counter_make(const RenderParams* params)
{
    SampleCounter counter;
    counter.sample = params->first_sample;
    counter.replicate = params->first_sample % params->replicates;
    counter.index = params->first_sample / params->replicates;
    return counter;
}

static inline void sample_counter_next(const RenderParams* params, SampleCounter* counter)
{
    ++counter->sample;
    if (++counter->replicate == params->replicates) {
        counter->replicate = 0u;
        ++counter->index;
    }
}

/* Defines the loop over samples and the entry point. The entry point is thin and the loop is out of line, because some
   compilers compile an entry point's body several times. */
#define RENDER_KERNEL(KERNEL, RADIANCE)                                                                       \
    static CLRT_NOINLINE void KERNEL##_pixel(const Scene* scene, const RenderParams* params, TilePixel place, \
                                             global long* film, global PixelRays* pixel_rays,                 \
                                             global volatile uint* counters)                                  \
    {                                                                                                         \
        const uint x = params->crop_x + place.x;                                                              \
        const uint y = params->crop_y + place.y;                                                              \
        const uint pixel = y * params->width + x;                                                             \
        PixelRays rays = {0u, 0u};                                                                            \
        SampleCounter counter = sample_counter_make(params);                                                  \
        for (uint i = 0; i < params->sample_count; ++i, sample_counter_next(params, &counter)) {              \
            global long* sums = film_sums(params, film, place.slot, counter.replicate);                       \
            CLRT_PREFETCH(sums);                                                                              \
            const Sampler sampler = sampler_make(params->seed, pixel, counter.replicate, counter.index);      \
            const Ray ray = camera_ray(params, &sampler, x, y);                                               \
            const real3 radiance = RADIANCE(scene, params, &sampler, ray, &rays);                             \
            const uint fault = film_fault(params, radiance);                                                  \
            if (fault == COUNT_WORDS)                                                                         \
                film_add(params, sums, &sampler, radiance);                                                   \
            else                                                                                              \
                film_report_fault(counters, fault, pixel, counter.sample);                                    \
        }                                                                                                     \
        pixel_rays[place.slot].secondary += rays.secondary;                                                   \
        pixel_rays[place.slot].shadow += rays.shadow;                                                         \
    }                                                                                                         \
                                                                                                              \
    kernel __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void KERNEL(                        \
        const RenderParams params, SCENE_PARAMS, global long* restrict film,                                  \
        global PixelRays* restrict pixel_rays, global volatile uint* counters)                                \
    {                                                                                                         \
        TilePixel place;                                                                                      \
        if (!tile_pixel(&params, &place))                                                                     \
            return;                                                                                           \
        const Scene scene = SCENE_MAKE;                                                                       \
        KERNEL##_pixel(&scene, &params, place, film, pixel_rays, counters);                                   \
    }

#endif
