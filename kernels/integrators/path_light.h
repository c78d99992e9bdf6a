// SPDX-License-Identifier: Apache-2.0
// Path tracing and light tracing in one picture: hits, next-event estimation and splats are three ways to
// find a path, weighted against each other (path/splat_weight.h); no vertex is kept, and no inner vertices
// are connected. Simulates L(D|G|S)*E. Splats bring the caustics, LS(D|G|S)*(D|G)E and those of sharp
// reflections, which paths from the eye find by chance; light paths are aimed at what casts them. Paths from
// the eye may be guided (path/guide.h): weights on both ends are by densities of the BSDF, as if nothing were.
// What they find that no splat does may serve other pixels (path_reuse.h).
#ifndef CLRT_INTEGRATORS_PATH_LIGHT_H
#define CLRT_INTEGRATORS_PATH_LIGHT_H

#include "light_paths.h"
#include "path/cut.h"
#include "path_reuse.h"
#include "splat_escape.h"

/* Handles the vertex at the end of a segment of the path from the eye. */
static CLRT_NOINLINE void path_light_vertex(const Scene* scene, const RenderParams* params, uint segment,
                                            Path* path, SplatWeights* weights, CameraSample* sample,
                                            ReusedPath* reused, PixelRays* rays)
{
    const real3 wo = -path->ray.direction;
    const Sampler* sampler = &sample->sampler;
    path->is_alive = path->is_connected = false;
    guide_arrive(reuse_gathered(sample->radiance, reused), &path->guided);
    if (path->hit.triangle == NO_INDEX) {
        path_absorb(scene, 0, path);
        path_skip_slabs(params, path);
        const bool is_weighed = splat_may_compete_outside(path, slab_sky_is_sampled(params), weights);
        splat_add_escape(scene, params, segment, path, weights, sample,
                         reuse_sum(is_weighed, &sample->radiance, reused), rays);
        return;
    }
    const Surface surface = visible_surface(scene, params, &path->ray, &path->hit);
    path_absorb(scene, &surface, path);
    splat_eye_meets(params, sampler, segment, path->hit.t, &surface, wo, weights);
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX && !pixel_has_seen(sample)) {
        const real3 emitted = splat_emission(scene, params, &surface, path, wo, weights);
        vertex_add(scene, path->throughput * emitted,
                   reuse_sum(splat_may_compete(path->pdf_w, weights), &sample->radiance, reused));
#if FILM_MOMENTS
        alone_emission(scene, params, &surface, path, wo, emitted, &sample->moments);
#endif
    }
    if (segment >= params->max_depth) {
        path_cut(scene, params, sampler, segment, &surface, path, rays);
        return;
    }
    Bsdf bsdf = vertex_bsdf(scene, &surface, wo);
    AutomatonStep step;
    path_filter(scene, params, sampler, segment, &surface, path, &step, &bsdf, rays);
    if (bsdf.lobes == 0u)
        return;
    Guide guide = guide_of(scene, &bsdf, &path->guided);
    const bool is_joined = splat_joins(&bsdf, weights);
    reuse_keep_first(params, segment, &surface, &bsdf, &guide, path, reused);
    reuse_keep_second(scene, segment, &surface, &bsdf, path, &sample->radiance, reused);
    const BsdfSample next = path_sample(scene, &surface, &bsdf, true, &guide, path);
    pixel_leave(segment, next.pdf_w, sample);
    splat_connect(scene, params, &surface, &bsdf, wo, weights, path);
    reuse_note_connection(is_joined, reused);
    reuse_keep_shares(segment, &bsdf, &next, path, reused);
#if FILM_MOMENTS
    alone_notes(scene, params, segment, &surface, &bsdf, wo, weights, path, &sample->moments);
#endif
    if (!next.is_valid)
        return;
    path_leave(scene, params, sampler, segment, &surface, &bsdf, &step, &guide, &next, path);
    if (path->is_alive)
        splat_eye_leaves(&bsdf, wo, &next, weights);
}

/* Follows a sample's path from the eye to its end; gives the sum of its vectors, for NaNs among them. */
static CLRT_NOINLINE real3 path_light_trace(const Scene* scene, const RenderParams* params,
                                            CameraSample* sample, ReusedPath* reused, PixelRays* rays)
{
    Path path;
    SplatWeights weights = splat_weights_none();
    path_begin(scene, &path, &sample->ray);
    splat_take_seen(scene, sample);
    reuse_begin(reused);
    guide_choose(params, &sample->sampler, &path.guided);
    for (uint segment = 1u; path.is_alive; ++segment) {
        path.numbers = numbers_make(&sample->sampler, segment, params->epoch);
        path.hit = vertex_hit(scene, params, &sample->sampler, segment, 0u, &path.ray, &path.throughput);
        guide_approach(scene, params, &path.ray, &path.hit, path.numbers.direction, &path.guided);
        path_light_vertex(scene, params, segment, &path, &weights, sample, reused, rays);
        rays->secondary += path.is_alive ? 1u : 0u;
        rays->shadow += path.is_connected ? 1u : 0u;
        if (!path.is_connected)
            continue;
        const real3 share = path_connection_share(scene, params, segment, &path, rays);
        path_add_connection(scene, &path, share, reuse_connection_sum(&sample->radiance, reused),
                            &sample->layers);
        reuse_keep_connection(segment, sample->radiance, reused);
#if FILM_MOMENTS
        moments_gather(path.connection * share, sample->moments.connection * share, &sample->moments);
#endif
    }
#if PATH_GUIDE
    sample->guide_gain =
        guide_learn(scene, params, reuse_gathered(sample->radiance, reused), &path.guided);
#endif
    return path.throughput + path.watched;
}

static CLRT_NOINLINE void path_light_radiance(const Scene* scene, const RenderParams* params,
                                              CameraSample* samples, uint count, PixelRays* rays)
{
    ReusedPath reused[SAMPLES_AT_ONCE];
    real3 watched[SAMPLES_AT_ONCE];
    for (uint k = 0; k < count; ++k) {
        PixelRays* counts = pixel_rays_of(&samples[k], rays);
        watched[k] = path_light_trace(scene, params, &samples[k], &reused[k], counts);
        light_paths_trace(scene, params, &samples[k], 0, counts);
    }
    reuse_share(scene, params, count, reused, samples, rays);
    for (uint k = 0; k < count; ++k)
        nan_carry(scene, nan_of_vector(watched[k]), &samples[k].radiance);
}

#endif
