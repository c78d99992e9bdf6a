// SPDX-License-Identifier: Apache-2.0
// Rays and hits as arrays, one ray a work-item, work-groups as in the renderer: tiles of 8 x 8 that take 64
// consecutive rays.
#ifndef CLRT_BENCH_BENCH_RAY_H
#define CLRT_BENCH_BENCH_RAY_H

#include "geometry/ray.h"
#include "shared/render_types.h"

/* The ray of this work-item. */
static inline uint bench_index(void) {
    const uint group = (uint)(get_group_id(1) * get_num_groups(0) + get_group_id(0));
    return group * TILE_PIXELS + (uint)(get_local_id(1) * TILE_SIZE + get_local_id(0));
}

/* Two vectors a ray: origin and t_max, direction and 0. */
static inline Ray bench_ray_load(global const float4* rays, uint index) {
    Ray ray = ray_make(vector_from(rays[2 * index]), vector_from(rays[2 * index + 1]), REAL(0.0));
    ray.t_max = rays[2 * index].w;
    return ray;
}

static inline void bench_ray_store(global float4* rays, uint index, const Ray* ray) {
    rays[2 * index] =
        (float4)((float)ray->origin.x, (float)ray->origin.y, (float)ray->origin.z, (float)ray->t_max);
    rays[2 * index + 1] =
        (float4)((float)ray->direction.x, (float)ray->direction.y, (float)ray->direction.z, 0.0f);
}

/* A hit: distance, weights of corners 1 and 2, and the triangle's index by its bits. */
static inline Hit bench_hit_load(global const float4* hits, uint index) {
    const float4 words = hits[index];
    Hit hit = hit_none(words.x);
    hit.b1 = words.y;
    hit.b2 = words.z;
    hit_set_triangle(0u, as_uint(words.w), &hit);
    return hit;
}

static inline void bench_hit_store(global float4* hits, uint index, const Hit* hit) {
    hits[index] = (float4)((float)hit->t, (float)hit->b1, (float)hit->b2, as_float(hit->triangle));
}

#endif
