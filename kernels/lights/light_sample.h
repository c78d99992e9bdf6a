// SPDX-License-Identifier: Apache-2.0
// What sampling a light gives, and the alias table that all lights are chosen by.
#ifndef CLRT_LIGHTS_LIGHT_SAMPLE_H
#define CLRT_LIGHTS_LIGHT_SAMPLE_H

#include "geometry/surface.h"
#include "numerics/warp.h"
#include "shared/path_types.h"

typedef struct {
    real3 wi;       /* world, unit, from the surface */
    real3 radiance; /* arriving if nothing is in between; irradiance at normal incidence for a delta light */
    real3 target;   /* where the shadow ray ends; unused when distant */
    real pdf_w;     /* per steradian as seen from the surface; 1 for a delta light, 0 where no light was found */
    uint kind;      /* KIND_*, set where lights of several kinds are chosen from */
    bool is_distant;
    bool is_delta;
} LightSample;

/* No light: nothing arrives. */
static inline LightSample light_sample_none(void)
{
    LightSample sample;
    sample.wi = (real3)(REAL(0.0), REAL(0.0), REAL(1.0));
    sample.radiance = (real3)(REAL(0.0));
    sample.target = (real3)(REAL(0.0));
    sample.pdf_w = REAL(0.0);
    sample.kind = KINDS_ALL;
    sample.is_distant = true;
    sample.is_delta = true;
    return sample;
}

/* The shadow ray from a surface to the sampled light. A segment to a target keeps its length, so that no rounding of a unit
   vector moves its end, and stops a few roundings short. */
static inline Ray light_shadow_ray(const Surface* surface, const LightSample* sample)
{
    const real3 origin = surface_origin(surface, surface_reflects(surface, sample->wi));
    if (sample->is_distant)
        return ray_make(origin, sample->wi);
    Ray ray = ray_make(origin, sample->target - origin);
    ray.t_max = REAL(1.0) - REAL(8.0) * FLOAT_ROUNDING;
    return ray;
}

#endif
