// SPDX-License-Identifier: Apache-2.0
// The loop over a pixel's samples that all integrators share. An integrator defines
//   real3 NAME(const Scene*, const RenderParams*, const Sampler*, Ray, RayCount*)
// which gives the radiance along a camera ray, and instantiates RENDER_KERNEL(render_x, NAME).
#ifndef CLRT_INTEGRATORS_PIXEL_H
#define CLRT_INTEGRATORS_PIXEL_H

#include "camera/camera.h"
#include "film/film.h"
#include "film/tile.h"
#include "geometry/scene.h"

/* Defines the loop over samples and the entry point. The entry point is thin and the loop is out of line, because some
   compilers compile an entry point's body several times. */
#define RENDER_KERNEL(KERNEL, RADIANCE)                                                                       \
    static CLRT_NOINLINE void KERNEL##_pixel(const Scene* scene, const RenderParams* params, uint2 place,     \
                                             global long* film, global volatile uint* counters)               \
    {                                                                                                         \
        const uint x = params->crop_x + place.x;                                                              \
        const uint y = params->crop_y + place.y;                                                              \
        const uint pixel = y * params->width + x;                                                             \
        const uint slot = place.y * params->crop_width + place.x;                                             \
        RayCount rays = {0u, 0u, 0u};                                                                         \
        for (uint i = 0; i < params->sample_count; ++i) {                                                     \
            const uint sample = params->first_sample + i;                                                     \
            const Sampler sampler = sampler_make(params->seed, pixel, sample, params->replicates);            \
            const Ray ray = camera_ray(params, &sampler, x, y);                                               \
            ++rays.primary;                                                                                   \
            const real3 radiance = RADIANCE(scene, params, &sampler, ray, &rays);                             \
            film_add(params, film, counters, &sampler, slot, pixel, sample, radiance);                        \
        }                                                                                                     \
        film_count_rays(counters, &rays);                                                                     \
    }                                                                                                         \
                                                                                                              \
    kernel __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void KERNEL(                        \
        const RenderParams params, SCENE_PARAMS, global long* restrict film, global volatile uint* counters)  \
    {                                                                                                         \
        uint2 place;                                                                                          \
        if (!tile_pixel(&params, &place))                                                                     \
            return;                                                                                           \
        const Scene scene = SCENE_MAKE;                                                                       \
        KERNEL##_pixel(&scene, &params, place, film, counters);                                               \
    }

#endif
