// SPDX-License-Identifier: Apache-2.0
// All lights together: one of them chosen for next-event estimation, and what a ray that leaves the scene
// sees.
#ifndef CLRT_LIGHTS_LIGHTS_H
#define CLRT_LIGHTS_LIGHTS_H

#include "light_choice.h"
#include "numerics/mis.h"
#include "numerics/sampler.h"
#include "sky_portal.h"

/* A surface as light sampling sees it: from the facet. `normal` as in LightView. */
static inline LightView lights_view(const Surface* surface, real3 normal)
{
    const LightView view = {surface->position, normal};
    return view;
}

/* The sample that a direction is which was drawn from the map, where light_is_drawn. */
static inline LightSample lights_drawn(const Scene* scene, const RenderParams* params, const Surface* surface,
                                       const SkySample* drawn)
{
    LightSample sample = environment_drawn(drawn);
    sample.kind = KIND_SKY;
    sample.light = light_of_sky(params);
    light_choose_side(scene, surface, &sample);
    return sample;
}

/* Chooses a light, then a point on it. The probability of the choice is in pdf_w. `normal` as in
   LightView. */
static inline LightSample lights_sample(const Scene* scene, const RenderParams* params,
                                        const Surface* surface, real3 normal, uint2 words, uint alias_word)
{
    const LightView view = lights_view(surface, normal);
    const LightChoice choice = light_choose(scene, params, &view, words, alias_word);
    LightSample sample = light_sample_none();
    if (HAS(EFFECT_AREA_LIGHT) && choice.light < params->emitter_count) {
        sample = emitter_sample_chosen(scene, choice.light, choice.probability, view.position,
                                       (real2)(sampler_unit(choice.word), choice.v));
        sample.kind = KIND_AREA;
    } else if (HAS(EFFECT_ENVIRONMENT) && choice.light == light_of_sky(params)) {
        if (params->portal_count != 0u)
            sample = sky_sample_portals(scene, params, &view, choice.word, choice.alias_word, choice.v);
        else if (environment_is_searched(params))
            sample = environment_map_sample(scene, params, choice.word, choice.alias_word, choice.v);
        sample.pdf_w *= choice.probability;
        sample.kind = KIND_SKY;
    } else if (HAS(EFFECT_DELTA_LIGHT) && choice.light != NO_INDEX) {
        const uint index = choice.light - params->emitter_count;
        const real2 u = (real2)(sampler_unit(choice.word), choice.v);
        sample = delta_light_sample(scene, index, view.position, u);
        sample.pdf_w *= choice.probability;
        sample.kind = scene->lights[index].kind == LIGHT_POINT ? KIND_POINT : KIND_SUN;
    }
    sample.light = choice.light;
    light_choose_side(scene, surface, &sample);
    if (HAS(EFFECT_SPOT) && sample.kind == KIND_POINT)
        delta_light_dim(scene, choice.light - params->emitter_count, &sample);
    return sample;
}

/* Radiance from outside the scene along wi: the environment and the discs of suns, as far as `kinds` (KIND_*)
   names them. pdf_w is the density with which the direction was sampled at the vertex of `view`, 0 for camera
   rays and delta lobes, which need no view; each part is weighted against next-event estimation there. */
static CLRT_NOINLINE real3 lights_escape(const Scene* scene, const RenderParams* params,
                                         const LightView* view, real3 wi, real pdf_w, uint kinds)
{
    real3 radiance = (real3)(REAL(0.0));
    if (HAS(EFFECT_ENVIRONMENT) && (kinds & KIND_SKY)) {
        const real2 place = environment_place(params, wi);
        real light_pdf_w = REAL(0.0);
        if (pdf_w > REAL(0.0) && params->choose_environment > 0.0f)
            light_pdf_w =
                light_probability_of_sky(scene, params, view) * sky_pdf_w(scene, params, view, wi, place);
        radiance = environment_eval_at(scene, params, place) * mis_weight(pdf_w, light_pdf_w);
    }
    if (!HAS(EFFECT_DELTA_LIGHT) || !(kinds & KIND_SUN))
        return radiance;
    for (uint i = 0; i < params->light_count; ++i) {
        if (!delta_light_covers(scene, i, wi))
            continue;
        real light_pdf_w = REAL(0.0);
        if (pdf_w > REAL(0.0))
            light_pdf_w = light_probability_of_delta(scene, params, view, i) *
                          warp_cone_pdf_w((real)scene->lights[i].one_minus_cos);
        radiance += vector_from(scene->lights[i].emission) * mis_weight(pdf_w, light_pdf_w);
    }
    return radiance;
}

/* Radiance from outside the scene to the ray of a path's segment, as lights_escape gives it; but a camera ray
   sees the background, where there is one, which counts as KIND_SKY. */
static inline real3 lights_outside(const Scene* scene, const RenderParams* params, uint segment,
                                   const LightView* view, real3 wi, real pdf_w, uint kinds)
{
    if (segment > 1u || BACKGROUND_IS_SEEN(*params) == 0.0f)
        return lights_escape(scene, params, view, wi, pdf_w, kinds);
    return HAS(EFFECT_ENVIRONMENT) && (kinds & KIND_SKY) ? vector_from(params->background)
                                                         : (real3)(REAL(0.0));
}

#endif
