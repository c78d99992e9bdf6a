// SPDX-License-Identifier: Apache-2.0
// The path that a chain's random numbers stand for (Hachisuka, Kaplanyan and Dachsbacher 2014): of a fixed
// length, found by one strategy that a number chooses. All are tried equally often, so what one brings counts
// as often as there are strategies, weighted against the others (splat_weight.h).
#ifndef CLRT_PATH_CHAIN_PATH_H
#define CLRT_PATH_CHAIN_PATH_H

#include "cut.h"
#include "light_path.h"
#include "splat_connect.h"

/* Ways to find a path; strategy numbers. */
#define STRATEGY_HIT 0u     /* the path from the eye meets the light */
#define STRATEGY_CONNECT 1u /* its last vertex is connected to it */
#define STRATEGY_SPLAT 2u   /* the path from the light is connected to the camera */
#define STRATEGY_COUNT 3u

/* What a path brings: radiance that counts as one of a pass's samples, one for each pixel of the window, and
   the film position that it goes to. */
typedef struct {
    real2 film;
    real3 radiance;
    real3 watched; /* sum of directions and normals, for NaNs among them */
} ChainPath;

/* Numbers of a point in the pixel: what is left of the word that chose it. */
#define CHAIN_FILL 0x80000000u

/* The camera's ray of a path: through any pixel of the window. */
static inline Ray chain_camera_ray(const RenderParams* params, const Sampler* sampler, real2* film)
{
    const uint2 words = sampler_pair_words(sampler, 0u, SAMPLE_FILM);
    const uint x = params->crop_x + warp_index(words.x, params->crop_width);
    const uint y = params->crop_y + warp_index(words.y, params->crop_height);
    const real2 within = (real2)(warp_rest(words.x, params->crop_width, CHAIN_FILL),
                                 warp_rest(words.y, params->crop_height, CHAIN_FILL));
    *film = camera_pixel_centre(params, x, y);
    return camera_ray_at(params, sampler, x, y, within);
}

/* Light that the last segment of a path from the eye meets. */
static inline real3 chain_hit(const Scene* scene, const RenderParams* params, const Surface* surface,
                              const Path* path, const SplatWeights* weights)
{
    if (path->hit.triangle == NO_INDEX)
        return path->throughput * splat_escape(scene, params, path, weights);
    if (!HAS(EFFECT_AREA_LIGHT) || surface->emitter == NO_INDEX)
        return (real3)(REAL(0.0));
    return path->throughput * splat_emission(scene, params, surface, path, -path->ray.direction, weights);
}

/* Connects the last vertex but one of a path from the eye to a light. */
static CLRT_NOINLINE real3 chain_connect(const Scene* scene, const RenderParams* params,
                                         const Surface* surface, const Bsdf* bsdf,
                                         const SplatWeights* weights, Path* path, PixelRays* rays)
{
    path->is_connected = false;
    splat_connect(scene, params, surface, bsdf, -path->ray.direction, weights, path);
    if (!path->is_connected)
        return (real3)(REAL(0.0));
    ++rays->shadow;
    return path->connection * visible_share(scene, params, &path->shadow);
}

/* Goes on from a vertex of a path from the eye; false where it ends. */
static CLRT_NOINLINE bool chain_leave(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                      uint segment, const Surface* surface, const Bsdf* bsdf,
                                      const AutomatonStep* step, SplatWeights* weights, Path* path)
{
    const real3 wo = -path->ray.direction;
    Guide guide = guide_none();
    const BsdfSample next = path_sample(scene, surface, bsdf, true, &guide, path);
    if (!next.is_valid)
        return false;
    path_leave(scene, params, sampler, segment, surface, bsdf, step, &guide, &next, path);
    splat_eye_leaves(bsdf, wo, &next, weights);
    return true;
}

/* Follows a path from the eye to its last segment but `connected` ones, which a connection replaces. */
static CLRT_NOINLINE void chain_from_eye(const Scene* scene, const RenderParams* params,
                                         const Sampler* sampler, uint length, uint connected,
                                         ChainPath* found, PixelRays* rays)
{
    Path path;
    SplatWeights weights = splat_weights_none();
    Ray ray = chain_camera_ray(params, sampler, &found->film);
    if (HAS(EFFECT_NESTED))
        visible_find_nest(scene, params, &ray);
    path_begin(scene, &path, &ray);
    for (uint segment = 1u;; ++segment) {
        path.numbers = numbers_make(sampler, segment, 0u);
        path.hit = vertex_hit(scene, params, sampler, segment, 0u, &path.ray, &path.throughput);
        ++rays->secondary;
        if (path.hit.triangle == NO_INDEX) {
            found->watched += nan_of_miss(&path.hit);
            path_absorb(scene, 0, &path);
            if (connected == 0u && segment == length)
                found->radiance = chain_hit(scene, params, 0, &path, &weights);
            break;
        }
        const Surface surface = visible_surface(scene, params, &path.ray, &path.hit);
        path_absorb(scene, &surface, &path);
        splat_eye_meets(params, sampler, segment, path.hit.t, &surface, -path.ray.direction, &weights);
        if (segment == length) {
            found->radiance = chain_hit(scene, params, &surface, &path, &weights);
            if (length == params->max_depth)
                path_cut(scene, params, sampler, segment, &surface, &path, rays);
            break;
        }
        Bsdf bsdf = vertex_bsdf(scene, &surface, -path.ray.direction);
        AutomatonStep step;
        path_filter(scene, params, sampler, segment, &surface, &path, &step, &bsdf, rays);
        if (bsdf.lobes == 0u)
            break;
        if (segment + connected == length) {
            found->radiance = chain_connect(scene, params, &surface, &bsdf, &weights, &path, rays);
            break;
        }
        if (!chain_leave(scene, params, sampler, segment, &surface, &bsdf, &step, &weights, &path))
            break;
    }
    found->watched += path.throughput + path.watched;
}

/* Follows a path from a light to its last vertex, which is connected to the camera. */
static CLRT_NOINLINE void chain_from_light(const Scene* scene, const RenderParams* params,
                                           const Sampler* sampler, uint length, ChainPath* found,
                                           PixelRays* rays)
{
    LightPath path;
    path.sampler = *sampler;
    if (!light_path_begin(scene, params, &path))
        return;
    for (uint segment = 1u; segment < length; ++segment) {
        Hit hit = vertex_hit(scene, params, sampler, segment, 0u, &path.ray, &path.throughput);
        ++rays->secondary;
        if (hit.triangle == NO_INDEX) {
            found->watched += nan_of_miss(&hit);
            break;
        }
        LightVertex vertex;
        if (!light_path_meet(scene, params, segment, &hit, &path, &vertex, &found->watched))
            break;
        if (segment + 1u < length) {
            if (!light_path_leave(scene, params, segment, &hit, &vertex, &path, &found->watched, rays))
                break;
            continue;
        }
        LightSplat splat;
        if (!bsdf_has_smooth_lobe(&vertex.bsdf) ||
            !light_path_connect(scene, params, segment, &hit, &vertex, &path, &splat, &found->watched, rays))
            break;
        /* A pass has as many light paths as the picture has pixels, and chains as many as the window. */
        const real window = (real)params->crop_width * (real)params->crop_height;
        found->radiance = splat.radiance * (splat_path_count(params) / window);
        found->film = splat.film;
    }
    found->watched += path.throughput + path.emission.power + path.emission.pdf;
}

/* The path of `length` segments, two or more, that a sampler's numbers stand for. */
static CLRT_NOINLINE ChainPath chain_path(const Scene* scene, const RenderParams* params,
                                          const Sampler* sampler, uint length, PixelRays* rays)
{
    ChainPath found;
    found.film = (real2)(REAL(0.0));
    found.radiance = found.watched = (real3)(REAL(0.0));
    const uint strategy = warp_index(sampler_word(sampler, 0u, SAMPLE_STRATEGY), STRATEGY_COUNT);
    if (strategy == STRATEGY_SPLAT)
        chain_from_light(scene, params, sampler, length, &found, rays);
    else
        chain_from_eye(scene, params, sampler, length, strategy == STRATEGY_CONNECT ? 1u : 0u, &found, rays);
    found.radiance = found.radiance * (real)STRATEGY_COUNT + nan_of_vector(found.watched);
    return found;
}

#endif
