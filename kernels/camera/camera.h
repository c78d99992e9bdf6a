// SPDX-License-Identifier: Apache-2.0
// Film positions and the rays through them.
#ifndef CLRT_CAMERA_CAMERA_H
#define CLRT_CAMERA_CAMERA_H

#include "geometry/ray.h"
#include "numerics/real_functions.h"
#include "numerics/sampler.h"
#include "shared/effects.h"
#include "shared/render_types.h"

/* A Gaussian filter's standard deviation as a share of its radius. */
#define CAMERA_GAUSSIAN_SHARE REAL(0.3333333333)

/* A number distributed as the tent of radius 1, from one in (0, 1). */
static inline real camera_tent(real u)
{
    return u < REAL(0.5) ? real_sqrt(REAL(2.0) * u) - REAL(1.0)
                         : REAL(1.0) - real_sqrt(REAL(2.0) * (REAL(1.0) - u));
}

/* Film position of a sample relative to its pixel's centre, distributed as the pixel filter (filter importance sampling,
   Ernst et al. 2006): every sample has weight 1. */
static inline real2 camera_filter_sample(const RenderParams* params, real2 u)
{
    const real radius = (real)params->filter_radius;
    if (!HAS(EFFECT_FILTER) || params->filter == FILTER_BOX)
        return (u - (real2)(REAL(0.5))) * (REAL(2.0) * radius);
    if (params->filter == FILTER_TENT)
        return (real2)(camera_tent(u.x), camera_tent(u.y)) * radius;
    /* Box-Muller, cut at the radius by scaling the radial distribution. */
    const real sigma = CAMERA_GAUSSIAN_SHARE * radius;
    const real cut = REAL(1.0) - real_exp(-radius * radius / (REAL(2.0) * sigma * sigma));
    const real r = sigma * real_root(REAL(-2.0) * real_log(REAL(1.0) - u.x * cut));
    const real2 sc = real_sin_cos_turn(u.y);
    return (real2)(r * sc.y, r * sc.x);
}

/* The ray of a sample through pixel (x, y) of the whole picture. */
static inline Ray camera_ray(const RenderParams* params, const Sampler* sampler, uint x, uint y)
{
    const real2 offset = camera_filter_sample(params, sampler_pair(sampler, 0u, SAMPLE_FILM));
    /* From the picture's centre, exact for pixel centres: from a corner, the terms of a wide angle would cancel. */
    const real film_x = (real)(2 * (int)x + 1 - (int)params->width) * REAL(0.5) + offset.x;
    const real film_y = (real)(2 * (int)y + 1 - (int)params->height) * REAL(0.5) + offset.y;
    const real3 direction = fma((real3)(film_x), vector_from(params->film_dx),
                                fma((real3)(film_y), vector_from(params->film_dy), vector_from(params->look)));
    const real time = HAS(EFFECT_MOTION_BLUR) ? sampler_number(sampler, 0u, SAMPLE_TIME) : REAL(0.0);
    return ray_make(vector_from(params->eye), vector_normalize(direction), time);
}

#endif
