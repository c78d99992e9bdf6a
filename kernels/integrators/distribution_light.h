// SPDX-License-Identifier: Apache-2.0
// Shadow rays of a distribution tree: several to every light that has an extent. What matte lobes scatter is
// found by them alone; what rough lobes scatter is found by their rays too, and the two are weighted against
// each other (Veach 1997, multi-sample model).
#ifndef CLRT_INTEGRATORS_DISTRIBUTION_LIGHT_H
#define CLRT_INTEGRATORS_DISTRIBUTION_LIGHT_H

#include "distribution_ray.h"

/* BSDF times cosine towards a light, by class; the rough part is weighted. */
typedef struct {
    real3 matte, rough;
} LitParts;

static inline LitParts distribution_parts(const TreeVertex* vertex, const LightSample* light)
{
    LitParts parts;
    parts.matte = parts.rough = (real3)(REAL(0.0));
    const Bsdf* bsdf = vertex->bsdf;
    const real3 wi = frame_to_local(&bsdf->frame, light->wi);
    if (!bsdf_sides_agree(bsdf, light->wi, wi))
        return parts;
    if (HAS(EFFECT_MATTE) && (bsdf->lobes & LOBE_MATTE) &&
        distribution_accepts(vertex, LETTER_MATTE, light->kind))
        parts.matte = bsdf_eval_matte(bsdf, wi);
    if (vertex->rough == 0u || !distribution_accepts(vertex, LETTER_GLOSSY, light->kind))
        return parts;
    const BsdfValue rough = bsdf_eval_lobes(bsdf, vertex->rough, wi);
    const real rays = (real)vertex->rough_rays / (real)vertex->shadow_rays;
    parts.rough =
        rough.value * (light->is_delta ? REAL(1.0) : mis_weight(light->pdf_w, rough.pdf_w * rays));
    return parts;
}

/* Adds what one of `count` samples of a light sends by way of the surface. */
static CLRT_NOINLINE void distribution_connect(const Scene* scene, const RenderParams* params,
                                               const TreeVertex* vertex, LightSample* light, uint count,
                                               CameraSample* sample, PixelRays* rays)
{
    solid_dim_light(scene, vertex->surface, light);
    light_record(scene, light);
    if (nan_carry(scene, nan_of_vector(light->wi), &sample->radiance) || light->pdf_w == REAL(0.0))
        return;
    const LitParts parts = distribution_parts(vertex, light);
    const real3 factor = vertex->path->weight * light->radiance / (light->pdf_w * (real)count);
    const real3 arriving = factor * (parts.matte + parts.rough);
    TRACE_VECTOR(scene, TRACE_LIGHT_BSDF, parts.matte + parts.rough);
    TRACE_VECTOR(scene, TRACE_CONNECTION, arriving);
    TRACE_CHOICE(scene, TRACE_CONNECTS, vector_is_black(arriving) ? 0u : 1u);
    if (vector_is_black(arriving))
        return;
    const Ray shadow = light_shadow_ray(vertex->surface, light);
    ++rays->shadow;
    const real3 share = visible_share(scene, params, &shadow);
    vertex_add(scene, arriving * share, &sample->radiance);
    if (PATH_LAYERS == 0)
        return;
    const AutomatonStep* step = &vertex->step;
    layers_add(scene, step->next[LETTER_MATTE], light->kind, factor * parts.matte * share, &sample->layers);
    layers_add(scene, step->next[LETTER_GLOSSY], light->kind, factor * parts.rough * share, &sample->layers);
}

/* True if shadow rays to lights of a kind can find anything. */
static inline bool distribution_wants(const TreeVertex* vertex, uint kind)
{
    const bool is_matte = HAS(EFFECT_MATTE) && (vertex->bsdf->lobes & LOBE_MATTE);
    return (is_matte && distribution_accepts(vertex, LETTER_MATTE, kind)) ||
           (vertex->rough != 0u && distribution_accepts(vertex, LETTER_GLOSSY, kind));
}

/* Connects to all emissive triangles together. */
static inline void distribution_connect_emitters(const Scene* scene, const RenderParams* params,
                                                 const TreeVertex* vertex, CameraSample* sample,
                                                 PixelRays* rays)
{
    const uint node = vertex->path->node;
    const uint count = vertex->shadow_rays;
    const real3 normal = bsdf_light_normal(vertex->bsdf);
    for (uint k = 0u; k < count; ++k) {
        const Sampler branch = sampler_branch(&vertex->sampler, count, k);
        /* A single shadow ray of the first vertex is in one net with the position on the film. */
        const uint2 words = count == 1u ? sampler_light_words(&branch, node)
                                        : sampler_pair_words(&branch, node, SAMPLE_LIGHT);
        const uint alias_word = sampler_word(&branch, node, SAMPLE_LIGHT_ALIAS);
        LightSample light =
            each_light_emitter(scene, params, vertex->surface, normal, words, alias_word);
        distribution_connect(scene, params, vertex, &light, count, sample, rays);
    }
}

/* Connects to the environment. Where it is constant, only matte lobes are: rays of rough lobes find it as
   well as can be. */
static inline void distribution_connect_sky(const Scene* scene, const RenderParams* params,
                                            const TreeVertex* vertex, CameraSample* sample, PixelRays* rays)
{
    const uint node = vertex->path->node;
    const uint count = vertex->shadow_rays;
    TreeVertex seen = *vertex;
    if (each_light_sky_is_constant(params))
        seen.rough = 0u;
    if (!distribution_wants(&seen, KIND_SKY))
        return;
    for (uint k = 0u; k < count; ++k) {
        const Sampler branch = sampler_branch(&vertex->sampler, count, k);
        const uint2 words = sampler_pair_words(&branch, node, SAMPLE_SKY);
        const uint alias_word = sampler_word(&branch, node, SAMPLE_LIGHT_ALIAS);
        LightSample light =
            each_light_sky(scene, params, vertex->surface, vertex->bsdf->frame.z, words, alias_word);
        distribution_connect(scene, params, &seen, &light, count, sample, rays);
    }
}

/* Connects to the points and suns; one ray finds all of what has no extent. */
static inline void distribution_connect_delta(const Scene* scene, const RenderParams* params,
                                              const TreeVertex* vertex, CameraSample* sample, PixelRays* rays)
{
    for (uint i = 0u; i < params->light_count; ++i) {
        const uint count = delta_light_has_disc(scene->lights + i) ? vertex->shadow_rays : 1u;
        for (uint k = 0u; k < count; ++k) {
            const Sampler branch = sampler_branch(&vertex->sampler, count, k);
            const real2 u = sampler_pair(&branch, sampler_hash(vertex->path->node) + i, SAMPLE_LIGHT);
            LightSample light = each_light_delta(scene, vertex->surface, i, u);
            distribution_connect(scene, params, vertex, &light, count, sample, rays);
        }
    }
}

/* Connects to every light. */
static CLRT_NOINLINE void distribution_light(const Scene* scene, const RenderParams* params,
                                             const TreeVertex* vertex, CameraSample* sample, PixelRays* rays)
{
    if (HAS(EFFECT_AREA_LIGHT) && params->emitter_count != 0u && distribution_wants(vertex, KIND_AREA))
        distribution_connect_emitters(scene, params, vertex, sample, rays);
    if (HAS(EFFECT_ENVIRONMENT))
        distribution_connect_sky(scene, params, vertex, sample, rays);
    if (HAS(EFFECT_DELTA_LIGHT) && distribution_wants(vertex, KIND_POINT | KIND_SUN))
        distribution_connect_delta(scene, params, vertex, sample, rays);
}

#endif
