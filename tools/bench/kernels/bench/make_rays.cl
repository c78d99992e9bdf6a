// SPDX-License-Identifier: Apache-2.0
// The rays of a render: from the camera, and from where they hit, with the renderer's cameras, surfaces and lights.
#include "bench_ray.h"
#include "camera/camera.h"
#include "film/tile.h"
#include "lights/lights.h"
#include "numerics/frame.h"

/* Kinds of rays that leave a surface. */
#define BENCH_SHADOW 1u
#define BENCH_DIFFUSE 2u
#define BENCH_MIRROR 3u

/* Primary rays in the order in which the renderer's work-groups take tiles. */
CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void make_primary(
    const RenderParams params, global float4* restrict rays)
{
    TilePixel place;
    if (!tile_pixel(&params, &place))
        return;
    const SampleCounter counter = {0u, 0u, params.first_sample};
    const Sampler sampler = tile_sampler(&params, place.x, place.y, counter);
    const Ray ray = camera_ray(&params, &sampler, place.x, place.y);
    bench_ray_store(rays, bench_index(), &ray);
}

/* A ray that is no ray: the host drops it. */
static Ray make_nothing(void)
{
    Ray ray = ray_make((real3)(REAL(0.0)), (real3)(REAL(0.0)), REAL(0.0));
    ray.t_max = REAL(0.0);
    return ray;
}

/* Towards a uniform point of the scene's bounding sphere, on the surface's lit side. */
static Ray make_sphere_ray(const RenderParams* params, const Surface* surface, real2 u)
{
    const real radius = REAL(1.7320508) * (real)params->scene_extent;
    const real z = fma(REAL(-2.0), u.x, REAL(1.0));
    const real r = real_root(REAL(1.0) - z * z);
    const real2 sc = real_sin_cos_turn(u.y);
    const real3 target = radius * vector_make(r * sc.y, r * sc.x, z);
    real3 wi = vector_normalize(target - surface->position);
    wi -= REAL(2.0) * fmin(vector_dot(wi, surface->normal_g), REAL(0.0)) * surface->normal_g;
    return surface_ray(surface, surface_reflects(surface, wi), wi);
}

/* Towards a light that the renderer samples; to the bounding sphere where it samples none (a constant sky). */
static Ray make_shadow(const Scene* scene, const RenderParams* params, const Surface* surface, const Sampler* sampler,
                       uint bounce)
{
    if (params->choose_emitter + params->choose_environment + params->choose_light == 0.0f)
        return make_sphere_ray(params, surface, sampler_pair(sampler, bounce, SAMPLE_LIGHT));
    const LightSample light =
        lights_sample(scene, params, surface, surface->normal_s, sampler_pair_words(sampler, bounce, SAMPLE_LIGHT),
                      sampler_word(sampler, bounce, SAMPLE_LIGHT_ALIAS));
    if (light.pdf_w == REAL(0.0) || !light.reflects)
        return make_nothing();
    return light_shadow_ray(surface, &light);
}

static Ray make_diffuse(const Surface* surface, const Sampler* sampler, uint bounce)
{
    const Frame frame = frame_make(surface->normal_g);
    const real3 wi =
        frame_to_world(&frame, warp_cosine_hemisphere(sampler_pair(sampler, bounce, SAMPLE_DIRECTION)));
    return surface_ray(surface, surface_reflects(surface, wi), wi);
}

/* About the shading normal, about the plane's where that would lead inside. */
static Ray make_mirror(const Surface* surface, real3 d)
{
    real3 wi = d - REAL(2.0) * vector_dot(d, surface->normal_s) * surface->normal_s;
    if (!surface_reflects(surface, wi))
        wi = d - REAL(2.0) * vector_dot(d, surface->normal_g) * surface->normal_g;
    wi = vector_normalize(wi);
    return surface_ray(surface, surface_reflects(surface, wi), wi);
}

/* The ray of a kind from where each ray hit; nothing where it did not. */
CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void make_secondary(
    const RenderParams params, SCENE_PARAMS, global const float4* restrict rays, global const float4* restrict hits,
    const uint count, const uint kind, const uint bounce, global float4* restrict made)
{
    const uint index = bench_index();
    if (index >= count)
        return;
    const Scene scene = SCENE_MAKE;
    const Hit hit = bench_hit_load(hits, index);
    Ray ray = make_nothing();
    if (hit.triangle != NO_INDEX) {
        const Ray before = bench_ray_load(rays, index);
        const Surface surface = surface_at(&scene, &hit, &before);
        const Sampler sampler = sampler_make(params.seed, index, 0u, params.first_sample);
        if (kind == BENCH_SHADOW)
            ray = make_shadow(&scene, &params, &surface, &sampler, bounce);
        else if (kind == BENCH_DIFFUSE)
            ray = make_diffuse(&surface, &sampler, bounce);
        else
            ray = make_mirror(&surface, before.direction);
    }
    bench_ray_store(made, index, &ray);
}
