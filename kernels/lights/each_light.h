// SPDX-License-Identifier: Apache-2.0
// Next-event estimation where a vertex is connected to every light: one sample of each, and how dense that
// was where a ray has met the light by chance. All emissive triangles together are one light, of which the
// tree chooses, where there is one, else the table; the environment is one, each point and sun is one.
#ifndef CLRT_LIGHTS_EACH_LIGHT_H
#define CLRT_LIGHTS_EACH_LIGHT_H

#include "lights.h"

/* A point on an emissive triangle, looked at from the surface; `normal` as in LightView. */
static inline LightSample each_light_emitter(const Scene* scene, const RenderParams* params,
                                             const Surface* surface, real3 normal, uint2 words,
                                             uint alias_word)
{
    const LightView view = lights_view(surface, normal);
    LightSample sample = light_sample_none();
    if (light_choice_is_by_tree(params)) {
        const LightChoice choice = light_choose_by_tree(scene, params, &view, words, alias_word);
        if (choice.light == NO_INDEX)
            return sample;
        sample = emitter_sample_chosen(scene, choice.light, choice.probability, view.position,
                                       (real2)(sampler_unit(choice.word), choice.v));
    } else
        sample = emitter_sample(scene, params, view.position, words.x, alias_word, sampler_unit(words.y));
    sample.kind = KIND_AREA;
    light_choose_side(scene, surface, &sample);
    return sample;
}

/* A direction to the environment; to a constant one by the cosine around the shading normal n. */
static inline LightSample each_light_sky(const Scene* scene, const RenderParams* params,
                                         const Surface* surface, real3 n, uint2 words, uint alias_word)
{
    LightSample sample = environment_sample(scene, params, n, words.x, alias_word, sampler_unit(words.y));
    sample.kind = KIND_SKY;
    light_choose_side(scene, surface, &sample);
    return sample;
}

/* Point or sun number `index`. */
static inline LightSample each_light_delta(const Scene* scene, const Surface* surface, uint index, real2 u)
{
    LightSample sample = delta_light_sample(scene, index, surface->position, u);
    sample.kind = scene->lights[index].kind == LIGHT_POINT ? KIND_POINT : KIND_SUN;
    light_choose_side(scene, surface, &sample);
    delta_light_dim(scene, index, &sample);
    return sample;
}

/* Density per steradian of each_light_emitter at the vertex of `view` for a ray that has met the emitter at
   distance t. `lift`: surface_lift of the ray. */
static inline real each_light_emitter_pdf_w(const Scene* scene, const RenderParams* params,
                                            const LightView* view, real lift,
                                            const Surface* surface, real t, real3 wo)
{
    const real pdf_a = light_choice_is_by_tree(params)
                           ? light_probability_of_emitter(scene, params, view, surface->emitter)
                           : (real)scene->emitters[surface->emitter].pdf_a;
    return emitter_met_pdf_w(scene, surface, pdf_a, view->position, lift, t, wo);
}

/* True where rays alone find the environment beside matte lobes: it is constant, so no density of
   each_light_sky would be better. */
static inline bool each_light_sky_is_constant(const RenderParams* params)
{
    return !HAS(EFFECT_ENVIRONMENT_MAP) || params->environment_width == 0u;
}

/* As lights_escape, for a direction that was sampled with density pdf_w (0: a delta lobe) where every light
   was sampled. */
static CLRT_NOINLINE real3 each_light_escape(const Scene* scene, const RenderParams* params, real3 wi,
                                             real pdf_w, uint kinds)
{
    real3 radiance = (real3)(REAL(0.0));
    if (HAS(EFFECT_ENVIRONMENT) && (kinds & KIND_SKY)) {
        const bool is_sampled = pdf_w > REAL(0.0) && !each_light_sky_is_constant(params);
        const real light_pdf_w = is_sampled ? environment_map_pdf_w(scene, params, wi) : REAL(0.0);
        radiance = environment_eval(scene, params, wi) * mis_weight(pdf_w, light_pdf_w);
    }
    if (!HAS(EFFECT_DELTA_LIGHT) || !(kinds & KIND_SUN))
        return radiance;
    for (uint i = 0; i < params->light_count; ++i)
        if (delta_light_covers(scene, i, wi))
            radiance += vector_from(scene->lights[i].emission) *
                        mis_weight(pdf_w, warp_cone_pdf_w((real)scene->lights[i].one_minus_cos));
    return radiance;
}

#endif
