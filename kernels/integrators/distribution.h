// SPDX-License-Identifier: Apache-2.0
// Distribution ray tracing (Cook, Porter, Carpenter 1984): a tree of rays a sample, in which a vertex sends
// several shadow rays to every light and several rays on by rough lobes, where Whitted's sends one. Simulates
// LD?(G|S)*E: no ray leaves a matte lobe, so surfaces do not light each other but by rough and smooth
// reflection and refraction. The tree ends at surfaces that are matte alone, at max_depth segments, by chance
// at weights below min_contribution, and outside the scene.
#ifndef CLRT_INTEGRATORS_DISTRIBUTION_H
#define CLRT_INTEGRATORS_DISTRIBUTION_H

#include "distribution_light.h"

/* Adds light of one kind that a ray has met. */
static inline void distribution_add_layers(const Scene* scene, const TreeRay* path, uint kind, real3 light,
                                           LayerSums* layers)
{
#if PATH_LAYERS > 0
    layers_add(scene, path->state, kind, path->weight * light, layers);
#endif
}

/* The light of some kinds from outside the scene. */
static inline real3 distribution_outside(const Scene* scene, const RenderParams* params, const TreeRay* path,
                                         uint kinds)
{
    return path->segment == 1u
               ? lights_outside(scene, params, 1u, &path->view, path->ray.direction, REAL(0.0), kinds)
               : each_light_escape(scene, params, path->ray.direction, path->pdf_w, kinds);
}

/* Adds the light from outside the scene. */
static inline void distribution_escape(const Scene* scene, const RenderParams* params, const TreeRay* path,
                                       const Hit* hit, CameraSample* sample, PixelRays* rays)
{
    rays->missed += path->segment == 1u ? 1u : 0u;
    if (nan_carry(scene, nan_of_miss(hit), &sample->radiance))
        return;
    const real3 sky = distribution_outside(scene, params, path, distribution_accepted(path));
    TRACE_VECTOR(scene, TRACE_SKY, sky);
    vertex_add(scene, path->weight * sky, &sample->radiance);
    if (PATH_LAYERS == 0)
        return;
    distribution_add_layers(scene, path, KIND_SKY, distribution_outside(scene, params, path, KIND_SKY),
                            &sample->layers);
    distribution_add_layers(scene, path, KIND_SUN, distribution_outside(scene, params, path, KIND_SUN),
                            &sample->layers);
}

/* Adds what the surface emits, weighted against the shadow rays of the vertex before. */
static inline void distribution_add_emission(const Scene* scene, const RenderParams* params,
                                             const Surface* surface, const Hit* hit, const TreeRay* path,
                                             CameraSample* sample)
{
    if (!HAS(EFFECT_AREA_LIGHT) || surface->emitter == NO_INDEX || !(distribution_accepted(path) & KIND_AREA))
        return;
    real3 emitted = material_emitted(scene, surface, -path->ray.direction);
    if (path->pdf_w != REAL(0.0)) {
        if (!emitter_is_met(path->lift, distribution_length(path, hit)))
            return;
        const real light_pdf_w = each_light_emitter_pdf_w(
            scene, params, &path->view, path->lift, surface, distribution_length(path, hit),
            -path->ray.direction);
        TRACE_NUMBER(scene, TRACE_LIGHT_PDF, light_pdf_w);
        emitted *= mis_weight(path->pdf_w, light_pdf_w);
    }
    vertex_add(scene, path->weight * emitted, &sample->radiance);
    distribution_add_layers(scene, path, KIND_AREA, emitted, &sample->layers);
}

/* Counts a ray that would have been lit, or gone on, but for max_depth: by all of its surface's lobes, or,
   with --paths, by those that max_depth closes. */
static inline void distribution_cut(const Scene* scene, const RenderParams* params, const TreeRay* path,
                                    const Bsdf* bsdf, PixelRays* rays)
{
    uint lobes = bsdf->lobes;
    if (HAS(EFFECT_PATH_FILTER)) {
        const AutomatonStep open = automaton_step(scene, params, path->state, path->segment);
        const AutomatonStep closed = automaton_cut_step(scene, &open, path->state);
        lobes = bsdf_lobes_of(bsdf, automaton_open(&closed));
    }
    if (lobes == 0u)
        return;
    film_count_cut(path->weight, rays);
    TRACE_CHOICE(scene, TRACE_CUT, 1u);
}

/* What a vertex does: which of its lobes are rough, and how many rays it branches into. */
static inline TreeVertex distribution_vertex_make(const Scene* scene, const RenderParams* params,
                                                  const TreeRay* path, const Surface* surface,
                                                  const Sampler* sampler, Bsdf* bsdf)
{
    TreeVertex vertex;
    vertex.path = path;
    vertex.surface = surface;
    vertex.bsdf = bsdf;
    vertex.sampler = *sampler;
    if (HAS(EFFECT_PATH_FILTER)) {
        vertex.step = automaton_step(scene, params, path->state, path->segment);
        filter_lobes(&vertex.step, bsdf);
    }
    const bool is_rough_glass = HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC) &&
                                !bsdf_dielectric_is_delta(bsdf);
    const bool is_rough_pane =
        HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE) && !bsdf_pane_is_delta(bsdf);
    vertex.rough = bsdf_lobes_of(bsdf, LETTER_BIT(LETTER_GLOSSY));
    const uint asked =
        is_rough_glass || is_rough_pane ? params->translucent_rays : params->gloss_rays;
    vertex.rough_rays = distribution_count(asked, path->share);
    vertex.shadow_rays = distribution_count(params->shadow_rays, path->share);
    /* The density of a direction is that of the rough lobes' rays alone. */
    if (vertex.rough != 0u)
        bsdf_choose_among(bsdf, vertex.rough);
    return vertex;
}

/* Lights the surface where a ray ends, and puts the rays that it sends on upon the stack; gives its new
   size. */
static CLRT_NOINLINE uint distribution_shade(const Scene* scene, const RenderParams* params,
                                             const TreeRay* path, const Surface* surface, const Hit* hit,
                                             const Sampler* sampler, TreeRay* stack, uint top,
                                             CameraSample* sample, PixelRays* rays)
{
    Bsdf bsdf = vertex_bsdf(scene, surface, -path->ray.direction);
    nan_carry(scene, nan_of_vector(surface->normal_g + bsdf.wo), &sample->radiance);
    top = distribution_pass(scene, params, path, surface, hit, sampler, &bsdf, stack, top);
    if (path->segment >= params->max_depth) {
        distribution_cut(scene, params, path, &bsdf, rays);
        return top;
    }
    if (HAS(EFFECT_PATH_FILTER)) {
        const AutomatonStep step = automaton_step(scene, params, path->state, path->segment);
        if (automaton_is_cut(scene, &step, path->state))
            distribution_cut(scene, params, path, &bsdf, rays);
    }
    const TreeVertex vertex = distribution_vertex_make(scene, params, path, surface, sampler, &bsdf);
    if (bsdf.lobes == 0u)
        return top;
    distribution_light(scene, params, &vertex, sample, rays);
    top = distribution_spawn_smooth(scene, params, &vertex, stack, top, &sample->radiance);
    top = distribution_spawn_rough(scene, params, &vertex, stack, top, &sample->radiance);
    TRACE_CHOICE(scene, TRACE_WAITING, top);
    return top;
}

/* Follows a ray to its end. */
static CLRT_NOINLINE uint distribution_follow(const Scene* scene, const RenderParams* params,
                                              TreeRay* path, TreeRay* stack, uint top,
                                              CameraSample* sample, PixelRays* rays)
{
    const Sampler sampler = sampler_at(sample->sampler.key, path->index);
    Hit hit = vertex_hit(scene, params, &sampler, path->segment, path->node, &path->ray, 0);
    TRACE_VECTOR(scene, TRACE_THROUGHPUT, path->weight);
    nan_carry(scene, nan_of_vector(path->weight), &sample->radiance);
    if (hit.triangle == NO_INDEX) {
#if CLRT_EFFECTS & EFFECT_ATTENUATION
        solid_escape(scene, path->solid, &path->weight);
#endif
        distribution_escape(scene, params, path, &hit, sample, rays);
        return top;
    }
    const Surface surface = visible_surface(scene, params, &path->ray, &hit);
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    solid_arrive(scene, path->solid, &surface, hit.t, &path->weight);
#endif
    distribution_add_emission(scene, params, &surface, &hit, path, sample);
    return distribution_shade(scene, params, path, &surface, &hit, &sampler, stack, top, sample, rays);
}

static CLRT_NOINLINE void distribution_sample(const Scene* scene, const RenderParams* params,
                                              CameraSample* sample, PixelRays* rays)
{
    TreeRay stack[DISTRIBUTION_WAITING];
    uint top = 1u;
    stack[0] = distribution_first(scene, sample);
    while (top != 0u) {
        TreeRay path = stack[--top];
        rays->secondary += path.segment > 1u ? 1u : 0u;
        top = distribution_follow(scene, params, &path, stack, top, sample, rays);
    }
}

static inline void distribution_radiance(const Scene* scene, const RenderParams* params,
                                         CameraSample* samples, uint count, PixelRays* rays)
{
    for (uint k = 0; k < count; ++k)
        distribution_sample(scene, params, &samples[k], rays);
}

#endif
