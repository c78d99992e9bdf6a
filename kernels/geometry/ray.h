// SPDX-License-Identifier: Apache-2.0
// Rays and hits.
#ifndef CLRT_GEOMETRY_RAY_H
#define CLRT_GEOMETRY_RAY_H

#include "numerics/vector.h"
#include "shared/effects.h"
#include "shared/types.h"

typedef struct {
    real3 origin;
    real3 direction; /* unit, or a segment's way to its end, where t = 1 */
    real t_max;      /* at most REAL_FAR */
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    real time;       /* ray_time */
#endif
} Ray;

/* A point on a triangle: distance and the barycentric weights of its corners 1 and 2. */
typedef struct {
    real t;
    real b1, b2;
    uint triangle; /* NO_INDEX: no hit */
} Hit;

/* `time` is within the shutter's opening, from 0 to 1; where nothing moves it is not kept. */
static inline Ray ray_make(real3 origin, real3 direction, real time)
{
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    ray.t_max = REAL_FAR;
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    ray.time = time;
#endif
    return ray;
}

/* When the ray sees the scene: 0 where the shutter opens, 1 where it closes; 0 where nothing moves. */
static inline real ray_time(const Ray* ray)
{
#if CLRT_EFFECTS & EFFECT_MOTION_BLUR
    return ray->time;
#else
    return REAL(0.0);
#endif
}

/* Before the first hit: traversal looks for hits after (0, none) and not beyond t_max. */
static inline Hit hit_none(real t_max)
{
    Hit hit;
    hit.t = t_max;
    hit.b1 = REAL(0.0);
    hit.b2 = REAL(0.0);
    hit.triangle = NO_INDEX;
    return hit;
}

/* Hits are ordered by distance, at equal distance by triangle index. */
static inline bool hit_is_before(real t, uint triangle, real other_t, uint other_triangle)
{
    return t < other_t || (t == other_t && triangle < other_triangle);
}

#endif
