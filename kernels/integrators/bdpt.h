// SPDX-License-Identifier: Apache-2.0
// Bidirectional path tracing (Lafortune and Willems 1993, Veach and Guibas 1994): simulates L(D|G|S)*E. To
// each path from the eye belongs one from a light. Hits, next-event estimation, splats and connections of
// inner vertices are ways to find a path, weighted against each other (path/splat_weight.h). A vertex of the
// path from the eye is connected to one vertex of the light path, all equally likely, and weighted as if all
// were connected: that is unbiased, costs as much as one more light, and is as efficient as all pairs.
//
// Where nothing but hits finds what mirrors and glass cast, because it is seen in mirrors or through glass
// itself, paths from the eye may be guided (path/guide.h), by what light paths bring there. Weights are by
// densities of the BSDF, as if nothing were.
#ifndef CLRT_INTEGRATORS_BDPT_H
#define CLRT_INTEGRATORS_BDPT_H

#include "light_paths.h"
#include "path/bdpt_connect.h"
#include "path/cut.h"
#include "splat_escape.h"

/* Books what strategy (s, t) has just added to the sample (path/strategies.h). */
static inline void bdpt_book(const RenderParams* params, uint s, uint t, CameraSample* sample)
{
    strategies_book(params, &sample->sampler, s, t, sample->radiance, &sample->strategies);
}

/* Connects the vertex at the end of a segment to one of the light path's, within max_depth segments. */
static CLRT_NOINLINE void bdpt_connect(const Scene* scene, const RenderParams* params, uint segment,
                                       const EyeVertex* eye, const LightVertices* kept, real3 throughput,
                                       CameraSample* sample, PixelRays* rays)
{
    const uint count = light_vertices_within(kept, params->max_depth - 1u - segment);
    if (count == 0u || !bsdf_has_smooth_lobe(eye->bsdf))
        return;
    const uint chosen = warp_index(sampler_word(&sample->sampler, segment, SAMPLE_PARTNER), count);
    InnerConnection connection;
    if (!bdpt_join(scene, eye, &kept->at[chosen], &connection))
        return;
    ++rays->shadow;
    const real ways = (real)count * light_vertices_share(kept);
    const real3 share = ways * slab_straight_share(scene, params, &connection.shadow);
    vertex_add(scene, throughput * connection.light * share, &sample->radiance);
    bdpt_book(params, light_vertices_segment(&kept->at[chosen]) + 1u, segment + 1u, sample);
#if FILM_MOMENTS
    const KeptVertex* light = &kept->at[chosen];
    const real rarity = roulette_rarity(segment + light_vertices_segment(light) + 1u, params->roulette_depth,
                                        vector_max_component(throughput), light->size, light->survived);
    moments_connect(throughput * connection.light * (share / ways), ways, connection.excess * rarity,
                    &sample->moments);
#endif
}

/* Handles the vertex at the end of a segment of the path from the eye. */
static CLRT_NOINLINE void bdpt_vertex(const Scene* scene, const RenderParams* params, uint segment,
                                      Path* path, EyeVertex* eye, const LightVertices* kept,
                                      CameraSample* sample, PixelRays* rays)
{
    const real3 wo = -path->ray.direction;
    const Sampler* sampler = &sample->sampler;
    SplatWeights* weights = &eye->weights;
    path->is_alive = path->is_connected = false;
    guide_arrive(sample->radiance, &path->guided);
    if (path->hit.triangle == NO_INDEX) {
        path_absorb(scene, 0, path);
        path_skip_slabs(params, path);
        splat_add_escape(scene, params, segment, path, weights, sample, &sample->radiance, rays);
        bdpt_book(params, 0u, segment + 1u, sample);
        return;
    }
    const Surface surface = visible_surface(scene, params, &path->ray, &path->hit);
    path_absorb(scene, &surface, path);
    splat_eye_meets(params, sampler, segment, path->hit.t, &surface, wo, weights);
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX && !pixel_has_seen(sample)) {
        const real3 emitted = splat_emission(scene, params, &surface, path, wo, weights);
        vertex_add(scene, path->throughput * emitted, &sample->radiance);
        bdpt_book(params, 0u, segment + 1u, sample);
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
    eye->surface = &surface;
    eye->bsdf = &bsdf;
    eye->wo = wo;
    Guide guide = splat_is_alone(weights) ? guide_of(scene, &bsdf, &path->guided) : guide_none();
    guide.radiance = REAL(0.0); /* light paths have added to it: roulette goes by throughput */
    const BsdfSample next = path_sample(scene, &surface, &bsdf, true, &guide, path);
    pixel_leave(segment, next.pdf_w, sample);
    splat_connect(scene, params, &surface, &bsdf, wo, weights, path);
#if FILM_MOMENTS
    alone_notes(scene, params, segment, &surface, &bsdf, wo, weights, path, &sample->moments);
#endif
    bdpt_connect(scene, params, segment, eye, kept, path->throughput, sample, rays);
    if (!next.is_valid)
        return;
    path_leave(scene, params, sampler, segment, &surface, &bsdf, &step, &guide, &next, path);
    if (path->is_alive)
        splat_eye_leaves(&bsdf, wo, &next, weights);
}

/* Follows a sample's path from the eye to its end. */
static CLRT_NOINLINE void bdpt_trace(const Scene* scene, const RenderParams* params,
                                     const LightVertices* kept, CameraSample* sample, PixelRays* rays)
{
    Path path;
    EyeVertex eye;
    eye.weights.open = eye.weights.closed = REAL(0.0);
    path_begin(scene, &path, &sample->ray);
    splat_take_seen(scene, sample);
    bdpt_book(params, 0u, 2u, sample);
    guide_choose(params, &sample->sampler, &path.guided);
    for (uint segment = 1u; path.is_alive; ++segment) {
        path.numbers = numbers_make(&sample->sampler, segment, params->epoch);
        path.hit = vertex_hit(scene, params, &sample->sampler, segment, 0u, &path.ray, &path.throughput);
        guide_approach(scene, params, &path.ray, &path.hit, path.numbers.direction, &path.guided);
        bdpt_vertex(scene, params, segment, &path, &eye, kept, sample, rays);
        rays->secondary += path.is_alive ? 1u : 0u;
        rays->shadow += path.is_connected ? 1u : 0u;
        if (!path.is_connected)
            continue;
        const real3 share = path_connection_share(scene, params, segment, &path, rays);
        path_add_connection(scene, &path, share, &sample->radiance, &sample->layers);
        bdpt_book(params, 1u, segment + 1u + path_connection_facets(&path), sample);
#if FILM_MOMENTS
        moments_gather(path.connection * share, sample->moments.connection * share, &sample->moments);
#endif
    }
    nan_carry(scene, nan_of_vector(path.throughput + path.watched), &sample->radiance);
#if PATH_GUIDE
    sample->guide_gain = guide_learn(scene, params, sample->radiance, &path.guided);
#endif
}

static CLRT_NOINLINE void bdpt_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples,
                                        uint count, PixelRays* rays)
{
    LightVertices kept;
    for (uint k = 0; k < count; ++k) {
        light_vertices_begin(&kept);
        light_paths_trace(scene, params, &samples[k], &kept, rays);
        bdpt_trace(scene, params, &kept, &samples[k], rays);
    }
}

#endif
