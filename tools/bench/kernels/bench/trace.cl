// SPDX-License-Identifier: Apache-2.0
// Rays from an array, hits into an array, by the renderer's own functions.
#include "bench_ray.h"
#include "geometry/traverse.h"

static CLRT_NOINLINE void trace_closest_ray(const Scene* scene, const RenderParams* params, global const float4* rays,
                                            uint index, global float4* hits)
{
    const Ray ray = bench_ray_load(rays, index);
    const Hit after = hit_none(REAL(0.0));
    const Hit hit = scene_closest_hit(scene, params, &ray, &after);
    bench_hit_store(hits, index, &hit);
}

CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void trace_closest(
    const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const uint count,
    global float4* restrict hits)
{
    const uint index = bench_index();
    if (index >= count)
        return;
    const Scene scene = SCENE_MAKE;
    trace_closest_ray(&scene, &params, rays, index, hits);
}

static CLRT_NOINLINE void trace_any_ray(const Scene* scene, const RenderParams* params, global const float4* rays,
                                        uint index, global float4* hits)
{
    const Ray ray = bench_ray_load(rays, index);
    Hit hit = hit_none(ray.t_max);
    /* Any triangle stands for "something is in between". */
    hit.triangle = scene_any_hit(scene, params, &ray) ? 0u : NO_INDEX;
    bench_hit_store(hits, index, &hit);
}

CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void trace_any(
    const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const uint count,
    global float4* restrict hits)
{
    const uint index = bench_index();
    if (index >= count)
        return;
    const Scene scene = SCENE_MAKE;
    trace_any_ray(&scene, &params, rays, index, hits);
}
