// SPDX-License-Identifier: Apache-2.0
// Rays and hits.
#ifndef CLRT_GEOMETRY_RAY_H
#define CLRT_GEOMETRY_RAY_H

#include "numerics/sampler.h"
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
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    real width;      /* of the cone that it stands for, at the origin */
    real spread;     /* and the cone's solid angle (ray_cone.h) */
#endif
#if CLRT_EFFECTS & EFFECT_DISPERSION
    uint wave;       /* ray_wave */
#endif
#if CLRT_EFFECTS & EFFECT_NESTED
    uint4 nest;      /* solids that it is in (nest.h) */
#endif
} Ray;

/* Of a ray's path: the colour that decides how glass bends it, from 1 (red) to 3 (blue), 0: none does, and
   glass bends all alike; and whether it carries that colour alone (scattering/dispersion.h). */
#define WAVE_NONE 0u
#define WAVE_COLOR 3u
#define WAVE_ALONE 4u

/* A point on a triangle: distance and the barycentric weights of its corners 1 and 2. */
typedef struct {
    real t;
    real b1, b2;
    uint triangle; /* NO_INDEX: no hit */
#if CLRT_EFFECTS & EFFECT_INSTANCES
    uint instance; /* hit_instance */
#endif
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
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    ray.width = ray.spread = REAL(0.0);
#endif
#if CLRT_EFFECTS & EFFECT_DISPERSION
    ray.wave = WAVE_NONE;
#endif
#if CLRT_EFFECTS & EFFECT_NESTED
    ray.nest = (uint4)(NO_INDEX);
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

static inline uint ray_wave(const Ray* ray)
{
#if CLRT_EFFECTS & EFFECT_DISPERSION
    return ray->wave;
#else
    return WAVE_NONE;
#endif
}

static inline void ray_set_wave(uint wave, Ray* ray)
{
#if CLRT_EFFECTS & EFFECT_DISPERSION
    ray->wave = wave;
#endif
}

/* A path's first wave: any of the colours, beside others, by the number that a sampler has for it: what the
   shutter's time leaves of its pair. */
static inline uint ray_sampled_wave(const Sampler* sampler)
{
    if (!HAS(EFFECT_DISPERSION))
        return WAVE_NONE;
    return 1u + min((uint)(REAL(3.0) * sampler_pair(sampler, 0u, SAMPLE_TIME).y), 2u);
}

/* Turns a ray into the segment to a point. It keeps its length, so that no rounding of a unit vector moves
   its end, and stops a few roundings short. */
static inline void ray_end_at(real3 point, Ray* ray)
{
    ray->direction = point - ray->origin;
    ray->t_max = REAL(1.0) - REAL(8.0) * FLOAT_ROUNDING;
}

/* Before the first hit: traversal looks for hits after (0, none) and not beyond t_max. */
static inline Hit hit_none(real t_max)
{
    Hit hit;
    hit.t = t_max;
    hit.b1 = REAL(0.0);
    hit.b2 = REAL(0.0);
    hit.triangle = NO_INDEX;
#if CLRT_EFFECTS & EFFECT_INSTANCES
    hit.instance = NO_INDEX;
#endif
    return hit;
}

/* The instance whose triangle it is: 0 for the scene's own. */
static inline uint hit_instance(const Hit* hit)
{
#if CLRT_EFFECTS & EFFECT_INSTANCES
    return hit->instance;
#else
    return 0u;
#endif
}

static inline void hit_set_triangle(uint instance, uint triangle, Hit* hit)
{
    hit->triangle = triangle;
#if CLRT_EFFECTS & EFFECT_INSTANCES
    hit->instance = instance;
#endif
}

static inline bool hit_is_same_triangle(const Hit* a, const Hit* b)
{
    return a->triangle == b->triangle && hit_instance(a) == hit_instance(b);
}

/* Hits are ordered by distance, at equal distance by instance and triangle index. */
static inline bool hit_triangle_is_before(uint instance, uint triangle, uint other_instance,
                                          uint other_triangle)
{
    if (HAS(EFFECT_INSTANCES) && instance != other_instance)
        return instance < other_instance;
    return triangle < other_triangle;
}

/* Whether what is hit at t comes before a hit, */
static inline bool hit_comes_before(real t, uint instance, uint triangle, const Hit* hit)
{
    return t < hit->t ||
           (t == hit->t && hit_triangle_is_before(instance, triangle, hit_instance(hit), hit->triangle));
}

/* and after one. */
static inline bool hit_comes_after(real t, uint instance, uint triangle, const Hit* hit)
{
    return hit->t < t ||
           (hit->t == t && hit_triangle_is_before(hit_instance(hit), hit->triangle, instance, triangle));
}

#endif
