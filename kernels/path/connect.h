// SPDX-License-Identifier: Apache-2.0
// Next-event estimation: a vertex is connected to a point on a light, and emission that the path meets by
// itself is weighted against that (multiple importance sampling, Veach 1997).
#ifndef CLRT_PATH_CONNECT_H
#define CLRT_PATH_CONNECT_H

#include "walk.h"

#if LAMPS_BEHIND_SLABS
/* The density with which the vertex before a chain of slabs samples a lamp's point that was hit behind it
   (slab_bend.h); 0 where it is not connected to it. */
static CLRT_NOINLINE real path_slab_pdf_w(const Scene* scene, const RenderParams* params,
                                          const Surface* surface, const Path* path, real3 wo, PixelRays* rays)
{
    if (!slab_is_straight(&path->slabs, path->before_slabs, path->ray.direction))
        return REAL(0.0);
    const real3 target = surface_origin(surface, true, wo);
    Ray ray = path->ray;
    ray.origin = path->slab_origin;
    SlabStack stack;
    SlabBend bend;
    if (!slab_find_stack(scene, params, path->slabs.facets, &ray, target, &stack, rays) ||
        stack.facets != path->slabs.facets || !slab_bend(&stack, target - ray.origin, &bend))
        return REAL(0.0);
    const real3 turn = bend.wi - path->before_slabs;
    const real3 way = surface->position - path->view.position;
    const real distance = vector_length(way);
    const real3 straight = way / distance;
    const real cosines = vector_dot(straight, surface->normal_g) / vector_dot(wo, -surface->normal_g);
    if (!(vector_dot(turn, turn) <= slab_same_square(surface->offset, distance)) || !(cosines > REAL(0.0)) ||
        !slab_is_ahead(path->slab_facet, straight, bend.wi))
        return REAL(0.0);
    const real pdf_a = light_probability_of_emitter(scene, params, &path->view, surface->emitter);
    return cosines * bend.spread *
           emitter_hit_pdf_w(scene, surface, pdf_a, path->view.position, distance, -straight);
}
#endif

/* The weight of emission that was hit by a delta lobe: next-event estimation finds it behind slabs alone. */
static inline real path_delta_weight(const Scene* scene, const RenderParams* params, const Surface* surface,
                                     const Path* path, real3 wo, PixelRays* rays)
{
#if LAMPS_BEHIND_SLABS
    const real light_pdf_w = path_slab_pdf_w(scene, params, surface, path, wo, rays);
    if (light_pdf_w > REAL(0.0))
        return mis_weight(path->pdf_w_before_slabs, light_pdf_w);
#endif
    return REAL(1.0);
}

/* Emission of the surface that was hit, weighted against the light sampling at the vertex before that could
   have found it. */
static inline real3 path_emission(const Scene* scene, const RenderParams* params, const Surface* surface,
                                  const Path* path, real3 wo, PixelRays* rays)
{
    const real3 emitted = material_emitted(scene, surface, wo);
    const real pdf_w = path->pdf_w;
    if (pdf_w == REAL(0.0))
        return vector_is_black(emitted) ? emitted
                                        : emitted * path_delta_weight(scene, params, surface, path, wo, rays);
    if (!emitter_is_met(path->lift, path->hit.t))
        return (real3)(REAL(0.0));
    const real pdf_a = light_probability_of_emitter(scene, params, &path->view, surface->emitter);
    const real light_pdf_w =
        emitter_met_pdf_w(scene, surface, pdf_a, path->view.position, path->lift, path->hit.t, wo);
    TRACE_NUMBER(scene, TRACE_LIGHT_PDF, light_pdf_w);
    TRACE_NUMBER(scene, TRACE_LIGHT_WEIGHT, mis_weight(pdf_w, light_pdf_w));
    return emitted * mis_weight(pdf_w, light_pdf_w);
}

/* The same connection for the layers, class by class of the event; `factor` is all that arrives over the
   BSDF's value. */
static inline void path_connect_layers(const Bsdf* bsdf, const AutomatonStep* step, const LightSample* light,
                                       real3 factor, Path* path)
{
#if PATH_LAYERS > 0
    path->layers.kind = light->kind;
    path->layers.matte_state = step->next[LETTER_MATTE];
    path->layers.glossy_state = step->next[LETTER_GLOSSY];
    const real3 shared = factor * path->layers.share;
    path->layers.matte = path->layers.glossy = (real3)(REAL(0.0));
    if (filter_is_ambiguous(step, bsdf)) {
        path->layers.matte = shared * filter_part(bsdf, LETTER_MATTE, light->wi);
        path->layers.glossy = shared * filter_part(bsdf, LETTER_GLOSSY, light->wi);
    } else if (bsdf_smooth_letters(bsdf) & LETTER_BIT(LETTER_MATTE))
        path->layers.matte = path->connection * path->layers.share;
    else
        path->layers.glossy = path->connection * path->layers.share;
#endif
}

/* The light that a vertex is to be connected to: the one drawn for it, or one chosen where it is. */
static inline LightSample path_light(const Scene* scene, const RenderParams* params, const Surface* surface,
                                     const Bsdf* bsdf, const Path* path)
{
    if (light_is_drawn(params))
        return lights_drawn(scene, params, surface, &path->sky);
    return lights_sample(scene, params, surface, bsdf_light_normal(bsdf), path->numbers.light,
                         path->numbers.alias);
}

/* The path is connected from a surface to a light. `with_others`: the weight of the connection beside light
   paths over what it is without them. */
static inline void path_note_connection(const Scene* scene, const Surface* surface, const LightSample* light,
                                        real with_others, Path* path)
{
    path->is_connected = true;
#if PATH_REUSE
    path->light_wi = light->wi;
#endif
#if HAS_SLABS
    const bool may_cross = light->is_distant && solid_beside(scene, surface, light->reflects) == NO_INDEX;
    path->connects_with_others = may_cross ? with_others : REAL(0.0);
#endif
}

/* The share of the connection that arrives, as far as one of its segment's path may within max_depth. What
   comes through slabs is not weighted against light paths. */
static inline real3 path_connection_share(const Scene* scene, const RenderParams* params, uint segment,
                                          Path* path, PixelRays* rays)
{
#if HAS_SLABS
    const uint most = path->connects_with_others > REAL(0.0) ? params->max_depth - 1u - segment : 0u;
    const real3 share = slab_share(scene, params, most, &path->shadow, &path->facets, rays);
    if (path->facets == 0u || vector_is_black(share))
        return share;
    path->connection /= path->connects_with_others;
    TRACE_VECTOR(scene, TRACE_CONNECTION, path->connection);
    TRACE_CHOICE(scene, TRACE_VISIBLE, 1u);
    TRACE_NUMBER(scene, TRACE_SHARE, vector_max_component(share));
    return share;
#else
    return visible_share(scene, params, &path->shadow);
#endif
}

/* Segments of a connection beyond its one: facets of slabs that it has crossed. */
static inline uint path_connection_facets(const Path* path)
{
#if HAS_SLABS
    return path->facets;
#else
    return 0u;
#endif
}

#if LAMPS_BEHIND_SLABS
/* Sees a lamp's point straight or through slabs, as path_see_light says. */
static CLRT_NOINLINE bool path_bend_light(const Scene* scene, const RenderParams* params, uint most,
                                          const Surface* surface, LightSample* light, Ray* shadow,
                                          PixelRays* rays)
{
    SlabStack stack;
    SlabBend bend;
    if (!slab_find_stack(scene, params, most, shadow, light->target, &stack, rays))
        return false;
    if (stack.facets == 0u) {
        if (!HAS(EFFECTS_PASSED)) {
            shadow->t_max = REAL(0.0); /* it has been seen that nothing is in between */
            --rays->shadow;            /* the connection is counted again */
        }
        return true;
    }
    const real3 way = light->target - shadow->origin;
    if (!slab_bend(&stack, way, &bend) ||
        !slab_is_ahead(light->reflects ? surface->normal_g : -surface->normal_g, light->wi, bend.wi))
        return false;
    real3 p0, p1, p2;
    surface_corners(scene, scene->triangles + light->triangle, &p0, &p1, &p2);
    const real3 normal = surface_cross(p1 - p0, p2 - p0);
    const real cosines = vector_dot(light->wi, normal) / vector_dot(bend.wi, normal);
    Ray ray = surface_ray(surface, light->reflects, bend.wi);
    if (!(cosines > REAL(0.0)) || !slab_follow(scene, params, stack.facets, &ray, &light->radiance, rays))
        return false;
    const real3 left = light->target - ray.origin;
    const real3 miss = left - vector_dot(left, ray.direction) * ray.direction;
    const real square = vector_dot(way, way);
    if (!(vector_dot(miss, miss) <= slab_same_square(surface->offset, real_sqrt(square)) * square))
        return false;
    light->wi = bend.wi;
    light->pdf_w *= cosines * bend.spread;
    ray_end_at(light->target, &ray);
    *shadow = ray;
    return true;
}
#endif

/* Prepares the shadow ray to a sampled light. Where nothing but slabs is in between, it is what is left of
   the way behind them, and the sample is what their bending makes of it; false where the light cannot be
   seen. */
static inline bool path_see_light(const Scene* scene, const RenderParams* params, uint segment,
                                  const Surface* surface, const Bsdf* bsdf, LightSample* light, Ray* shadow,
                                  PixelRays* rays)
{
    *shadow = light_shadow_ray(surface, light);
#if LAMPS_BEHIND_SLABS
    if (!light->reflects && !vector_is_black(bsdf_light_normal(bsdf)))
        return false; /* nothing is scattered from there */
    if (light->triangle != NO_INDEX && !surface_is_lifted(surface, light->reflects, light->wi) &&
        slab_can_begin(surface, light->reflects) &&
        solid_beside(scene, surface, light->reflects) == NO_INDEX)
        return path_bend_light(scene, params, params->max_depth - 1u - segment, surface, light, shadow, rays);
#endif
    return true;
}

/* Samples a light and prepares the shadow ray to it; its contribution is weighted against BSDF sampling.
   Nothing where delta lobes or the automaton keep a light from being found so. */
static inline void path_connect(const Scene* scene, const RenderParams* params, uint segment,
                                const Surface* surface, const Bsdf* bsdf, const AutomatonStep* step,
                                Path* path, PixelRays* rays)
{
    if (!bsdf_has_smooth_lobe(bsdf))
        return;
    if (HAS(EFFECT_PATH_FILTER) && !filter_wants_light(step, bsdf))
        return;
    LightSample light = path_light(scene, params, surface, bsdf, path);
    solid_dim_light(scene, surface, &light);
    Ray shadow;
    const bool is_seen = light.pdf_w != REAL(0.0) &&
                         path_see_light(scene, params, segment, surface, bsdf, &light, &shadow, rays);
    light_record(scene, &light);
    nan_watch(scene, light.wi, &path->watched);
    if (!is_seen)
        return;
    light.pdf_w *= (real)path_light_samples(path);
    BsdfValue eval = bsdf_eval(bsdf, light.wi);
    if (HAS(EFFECT_PATH_FILTER))
        eval.value = filter_value(step, bsdf, light.wi, light.kind, eval.value);
    const real3 arriving = eval.value * light.radiance;
    TRACE_VECTOR(scene, TRACE_LIGHT_BSDF, eval.value);
    TRACE_NUMBER(scene, TRACE_LIGHT_BSDF_PDF, eval.pdf_w);
    TRACE_CHOICE(scene, TRACE_CONNECTS, vector_is_black(arriving) ? 0u : 1u);
    if (vector_is_black(arriving))
        return;
    const real weight = light.is_delta ? REAL(1.0) : mis_weight(light.pdf_w, eval.pdf_w);
    path->connection = path->throughput * arriving * (weight / light.pdf_w);
    TRACE_NUMBER(scene, TRACE_LIGHT_WEIGHT, weight);
    TRACE_VECTOR(scene, TRACE_CONNECTION, path->connection);
    path->shadow = shadow;
    path_note_connection(scene, surface, &light, REAL(1.0), path);
    path_connect_layers(bsdf, step, &light, path->throughput * light.radiance * (weight / light.pdf_w), path);
}

/* Adds the share of the connection that arrives. */
static inline void path_add_connection(const Scene* scene, const Path* path, real3 share, real3* radiance,
                                       LayerSums* layers)
{
    vertex_add(scene, path->connection * share, radiance);
#if PATH_LAYERS > 0
    layers_add(scene, path->layers.matte_state, path->layers.kind, path->layers.matte * share, layers);
    layers_add(scene, path->layers.glossy_state, path->layers.kind, path->layers.glossy * share, layers);
#endif
}

#endif
