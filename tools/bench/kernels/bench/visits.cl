// SPDX-License-Identifier: Apache-2.0
// What every ray of an array visits: nodes, leaves, triangles. Built with CLRT_COUNT_VISITS.
#include "bench_ray.h"
#include "geometry/traverse.h"

static void visits_store(global uint4* visits, uint index, const uint* counts)
{
    visits[index] = (uint4)(counts[0], counts[1], counts[2], 0u);
}

CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void visits_closest(
    const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const uint count,
    global uint4* restrict hits)
{
    const uint index = bench_index();
    if (index >= count)
        return;
    Scene scene = SCENE_MAKE;
    uint counts[3] = {0u, 0u, 0u};
    scene.visits = counts;
    const Ray ray = bench_ray_load(rays, index);
    const Hit after = hit_none(REAL(0.0));
    scene_closest_hit(&scene, &params, &ray, &after);
    visits_store(hits, index, counts);
}

CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void visits_any(
    const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, const uint count,
    global uint4* restrict hits)
{
    const uint index = bench_index();
    if (index >= count)
        return;
    Scene scene = SCENE_MAKE;
    uint counts[3] = {0u, 0u, 0u};
    scene.visits = counts;
    const Ray ray = bench_ray_load(rays, index);
    scene_any_hit(&scene, &params, &ray);
    visits_store(hits, index, counts);
}
