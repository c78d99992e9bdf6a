// SPDX-License-Identifier: Apache-2.0
// Rays from inside a closed mesh, aimed exactly at its vertices and edges. One that hits nothing has slipped through.
#include "bench_ray.h"
#include "geometry/traverse.h"
#include "numerics/sampler.h"
#include "numerics/warp.h"

/* Words of the counters. */
#define AIMED_LOST 0
#define AIMED_LOST_ANY 1

/* Rays a work-item traces; the host says how many. */
#ifndef AIMED_PER_ITEM
#define AIMED_PER_ITEM 1u
#endif

/* Independent words one after the other: a Weyl sequence, hashed. */
static inline uint aimed_word(uint* state)
{
    *state += 0x9e3779b9u;
    return sampler_hash(*state);
}

/* In (-1, 1). */
static inline real aimed_signed(uint* state) { return fma(REAL(2.0), sampler_unit(aimed_word(state)), REAL(-1.0)); }

/* A vertex, or a point of an edge. */
static real3 aimed_target(const Scene* scene, uint triangle_count, uint* state)
{
    global const Triangle* triangle = scene->triangles + warp_index(aimed_word(state), triangle_count);
    const uint corners[3] = {triangle->v0, triangle->v1, triangle->v2};
    const uint corner = aimed_word(state) % 3u;
    const real3 a = vector_from(scene->positions[corners[corner]]);
    const real3 b = vector_from(scene->positions[corners[(corner + 1u) % 3u]]);
    const real u = sampler_unit(aimed_word(state));
    return (aimed_word(state) & 0x100u) ? vector_mix(a, b, u) : a;
}

/* The origin's coordinate along an axis: within the core's inner cube, or that of the target where this is inside too,
   so that a component of the direction is 0. */
static real aimed_coordinate(real centre, real half_edge, real target, uint* state)
{
    const real random = fma(half_edge, aimed_signed(state), centre);
    const bool snap = (aimed_word(state) & 0x100u) != 0u;
    return snap && fabs(target - centre) <= half_edge ? target : random;
}

/* A core is a ball inside the mesh: centre and radius. */
static CLRT_NOINLINE Ray aimed_ray(const Scene* scene, uint triangle_count, global const float4* cores, uint core_count,
                                   uint* state)
{
    const real3 target = aimed_target(scene, triangle_count, state);
    const float4 core = cores[warp_index(aimed_word(state), core_count)];
    const real half_edge = REAL(0.5) * (real)core.w;
    const real3 origin = vector_make(aimed_coordinate(core.x, half_edge, target.x, state),
                                     aimed_coordinate(core.y, half_edge, target.y, state),
                                     aimed_coordinate(core.z, half_edge, target.z, state));
    const real3 way = target - origin;
    /* Lengths must be beyond the range in which a square underflows. */
    return ray_make(origin, (aimed_word(state) & 0x100u) ? vector_normalize(way) : way, REAL(0.0));
}

/* Every work-item traces its rays; lost ones are counted, and the last one of the launch is kept. */
CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void aimed_trace(
    const RenderParams params, SCENE_PARAMS, global const float4* restrict cores, const uint core_count,
    const uint triangle_count, const uint seed, global volatile uint* counters, global float4* restrict lost)
{
    const Scene scene = SCENE_MAKE;
    uint state = sampler_hash(bench_index() ^ sampler_hash(seed));
    for (uint i = 0; i < AIMED_PER_ITEM; ++i) {
        const Ray ray = aimed_ray(&scene, triangle_count, cores, core_count, &state);
        const Hit after = hit_none(REAL(0.0));
        const bool is_lost = scene_closest_hit(&scene, &params, &ray, &after).triangle == NO_INDEX;
        const bool is_lost_any = !scene_any_hit(&scene, &params, &ray);
        if (!is_lost && !is_lost_any)
            continue;
        if (is_lost)
            atomic_inc(counters + AIMED_LOST);
        if (is_lost_any)
            atomic_inc(counters + AIMED_LOST_ANY);
        bench_ray_store(lost, 0u, &ray);
    }
}
