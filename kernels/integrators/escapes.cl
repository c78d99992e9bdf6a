// SPDX-License-Identifier: Apache-2.0
// Entry point that finds ways out of the scene: where the sky is seen from the surfaces that paths meet. All
// surfaces scatter as matte ones do, so no material is asked but for what it lets pass.
#include "camera/camera.h"
#include "lights/environment.h"
#include "path/visibility.h"
#include "shared/escape_types.h"

/* The next surface along a ray, seen straight through slabs as through panes without a thickness. */
static inline Hit escapes_hit(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                              uint segment, Ray* ray)
{
    for (;;) {
        real3 carried = (real3)(REAL(1.0));
        Hit hit = visible_hit(scene, params, sampler, segment, ray, &carried);
        if (!(params->path_choices & SLABS_ARE_CROSSED) || hit.triangle == NO_INDEX)
            return hit;
        if (!(scene->materials[scene->triangles[hit.triangle].material].flags & MATERIAL_SLAB))
            return hit;
        const Surface surface = visible_surface(scene, params, ray, &hit);
        *ray = surface_ray(&surface, false, ray->direction);
    }
}

/* A direction from a surface; `segment` tells random numbers apart. */
static inline Ray escapes_scattered(const Surface* surface, const Sampler* sampler, uint segment)
{
    const Frame frame = frame_make(surface->normal_g);
    const real2 u = sampler_pair(sampler, segment, SAMPLE_DIRECTION);
    return surface_ray(surface, true, frame_to_world(&frame, warp_cosine_hemisphere(u)));
}

/* Whether more ways from a surface lead out of the scene, as they do where no window is needed to see the
   sky. */
static inline bool escapes_is_open(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                   uint segment, const Surface* surface)
{
    uint ways_out = 0u;
    for (uint i = 1u; i <= ESCAPE_VIEWS; ++i) {
        const uint key = segment + i * ESCAPE_SEGMENTS;
        Ray ray = escapes_scattered(surface, sampler, key);
        const Hit hit = escapes_hit(scene, params, sampler, key, &ray);
        ways_out += hit.triangle == NO_INDEX ? 1u : 0u;
    }
    return ways_out >= ESCAPE_OPEN_VIEWS;
}

/* Follows a path from the pixel (x, y) of the picture. */
static CLRT_NOINLINE Escape escapes_follow(const Scene* scene, const RenderParams* params, uint x, uint y,
                                           const Sampler* sampler)
{
    Escape escape = {(float4)(0.0f), (float4)(0.0f)};
    Ray ray = camera_ray(params, sampler, x, y);
    if (HAS(EFFECT_NESTED))
        visible_find_nest(scene, params, &ray);
    Surface surface;
    for (uint segment = 1u; segment <= ESCAPE_SEGMENTS; ++segment) {
        const real3 origin = ray.origin;
        Hit hit = escapes_hit(scene, params, sampler, segment, &ray);
        if (hit.triangle == NO_INDEX) {
            const real3 sky = environment_eval(scene, params, ray.direction);
            const uint surfaces = segment - 1u;
            const bool is_open =
                surfaces > 0u && escapes_is_open(scene, params, sampler, surfaces, &surface);
            escape.origin = (float4)(convert_float3(origin), is_open ? -(float)surfaces : (float)surfaces);
            escape.direction = (float4)(convert_float3(ray.direction), (float)vector_luminance(sky));
            break;
        }
        surface = visible_surface(scene, params, &ray, &hit);
        ray = escapes_scattered(&surface, sampler, segment);
    }
    return escape;
}

/* Follows one path a work-item: `count` of them, spread evenly over the pixels of the picture. */
CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void find_escapes(
    const RenderParams params, SCENE_PARAMS, const uint count, global Escape* restrict escapes)
{
    const uint group = (uint)(get_group_id(1) * get_num_groups(0) + get_group_id(0));
    const uint item = group * TILE_PIXELS + (uint)(get_local_id(1) * TILE_SIZE + get_local_id(0));
    if (item >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const ulong pixels = (ulong)params.width * params.height;
    const uint pixel = (uint)(((ulong)item * pixels) / count);
    const Sampler sampler = sampler_make(params.seed, pixel, 0u, item);
    escapes[item] = escapes_follow(&scene, &params, pixel % params.width, pixel / params.width, &sampler);
}
