// SPDX-License-Identifier: Apache-2.0
// All lights together: one of them chosen for next-event estimation, and what a ray that leaves the scene
// sees.
#ifndef CLRT_LIGHTS_LIGHTS_H
#define CLRT_LIGHTS_LIGHTS_H

#include "delta_light.h"
#include "emitter.h"
#include "environment.h"
#include "numerics/mis.h"
#include "numerics/sampler.h"

/* Chooses a kind of light (emissive triangles, environment, points and suns) by the host's probabilities,
   then a light of that kind, then a point on it, as seen from the point where rays start that the surface
   reflects. The probability of the choice is in pdf_w. One pair of words serves all: what is left of the
   first after choosing the light, and of the second after choosing the kind, gives the point. */
static inline LightSample lights_sample(const Scene* scene, const RenderParams* params,
                                        const Surface* surface, real3 n, uint2 words, uint alias_word)
{
    const real v = sampler_unit(words.y);
    const real emitter = (real)params->choose_emitter;
    const real sky = (real)params->choose_environment;
    const real light = (real)params->choose_light;
    const real3 from = surface_lifted(surface);
    LightSample sample = light_sample_none();
    if (HAS(EFFECT_AREA_LIGHT) && v < emitter) {
        sample = emitter_sample(scene, params, from, words.x, alias_word, v / emitter);
        sample.pdf_w *= emitter;
        sample.kind = KIND_AREA;
    } else if (HAS(EFFECT_ENVIRONMENT_MAP) && v < emitter + sky) {
        sample = environment_sample(scene, params, n, words.x, alias_word, (v - emitter) / sky);
        sample.pdf_w *= sky;
        sample.kind = KIND_SKY;
    } else if (HAS(EFFECT_DELTA_LIGHT) && light > REAL(0.0)) {
        const uint index = delta_light_choose(scene, params, words.x, alias_word);
        const real2 u =
            (real2)(warp_rest(words.x, params->light_count, alias_word), (v - emitter - sky) / light);
        sample = delta_light_sample(scene, index, from, u);
        sample.pdf_w *= light * (real)scene->lights[index].probability;
        sample.kind = scene->lights[index].kind == LIGHT_POINT ? KIND_POINT : KIND_SUN;
    }
    light_choose_side(scene, surface, &sample);
    return sample;
}

/* Radiance from outside the scene along wi: the environment and the discs of suns, as far as `kinds` (KIND_*)
   names them. pdf_w is the density with which the direction was sampled, 0 for camera rays and delta lobes;
   each part is weighted against next-event estimation. */
static CLRT_NOINLINE real3 lights_escape(const Scene* scene, const RenderParams* params, real3 wi, real pdf_w,
                                         uint kinds)
{
    real3 radiance = (real3)(REAL(0.0));
    if (HAS(EFFECT_ENVIRONMENT) && (kinds & KIND_SKY)) {
        real light_pdf_w = REAL(0.0);
        if (HAS(EFFECT_ENVIRONMENT_MAP) && pdf_w > REAL(0.0) && params->choose_environment > 0.0f)
            light_pdf_w = (real)params->choose_environment * environment_map_pdf_w(scene, params, wi);
        radiance = environment_eval(scene, params, wi) * mis_weight(pdf_w, light_pdf_w);
    }
    if (!HAS(EFFECT_DELTA_LIGHT) || !(kinds & KIND_SUN))
        return radiance;
    for (uint i = 0; i < params->light_count; ++i) {
        if (!delta_light_covers(scene, i, wi))
            continue;
        const real choose = (real)(params->choose_light * scene->lights[i].probability);
        const real light_pdf_w = choose * warp_cone_pdf_w((real)scene->lights[i].one_minus_cos);
        radiance += vector_from(scene->lights[i].emission) * mis_weight(pdf_w, light_pdf_w);
    }
    return radiance;
}

/* Radiance from outside the scene to the ray of a path's segment, as lights_escape gives it; but a camera ray
   sees the background, where there is one, which counts as KIND_SKY. */
static inline real3 lights_outside(const Scene* scene, const RenderParams* params, uint segment, real3 wi,
                                   real pdf_w, uint kinds)
{
    if (segment > 1u || BACKGROUND_IS_SEEN(*params) == 0.0f)
        return lights_escape(scene, params, wi, pdf_w, kinds);
    return HAS(EFFECT_ENVIRONMENT) && (kinds & KIND_SKY) ? vector_from(params->background)
                                                         : (real3)(REAL(0.0));
}

#endif
