// SPDX-License-Identifier: Apache-2.0
// Which light next-event estimation samples at a vertex, and how probable a light was there that a ray has
// met by chance: the one place that knows the rule. Lights have numbers: the emissive triangles first, then
// points and suns, then the environment.
#ifndef CLRT_LIGHTS_LIGHT_CHOICE_H
#define CLRT_LIGHTS_LIGHT_CHOICE_H

#include "delta_light.h"
#include "emitter.h"
#include "environment_sample.h"
#include "light_tree.h"

/* A chosen light, and what is left of the random numbers for the point on it. */
typedef struct {
    uint light;       /* its number; NO_INDEX: none can add anything */
    uint word;        /* as sampler_unit's: the point's first coordinate, or a map's texel */
    uint alias_word;
    real v;           /* the point's second coordinate */
    real probability; /* of an emissive triangle over its area */
} LightChoice;

static inline LightChoice light_choice_make(uint light, uint word, uint alias_word, real v, real probability)
{
    const LightChoice choice = {light, word, alias_word, v, probability};
    return choice;
}

static inline uint light_of_sky(const RenderParams* params)
{
    return params->emitter_count + params->light_count;
}

static inline bool light_choice_is_by_tree(const RenderParams* params)
{
    return HAS(EFFECT_LIGHT_TREE) && LIGHT_TREE_IS_USED(*params) != 0.0f;
}

/* True where the environment map is the only light that is chosen. */
static inline bool light_is_sky(const RenderParams* params)
{
    return environment_is_searched(params) && !light_choice_is_by_tree(params) &&
           params->choose_environment == 1.0f;
}

/* True where light samples are drawn from the map alone, whatever the vertex. */
static inline bool light_is_drawn(const RenderParams* params)
{
    return light_is_sky(params) && params->portal_count == 0u;
}

/* Probabilities of the kinds of light. */
typedef struct {
    real emitter, sky, light;
} LightKinds;

/* By the tables: first a kind (emissive triangles, environment, points and suns), then a light of that kind.
   What is left of the first word after choosing the light, and of the second after choosing the kind, gives
   the point. */
static inline LightChoice light_choose_by_tables(const Scene* scene, const RenderParams* params,
                                                 LightKinds kinds, uint2 words, uint alias_word)
{
    const real v = sampler_unit(words.y);
    const real emitter = kinds.emitter;
    const real sky = kinds.sky;
    const real light = kinds.light;
    if (HAS(EFFECT_AREA_LIGHT) && v < emitter) {
        const uint chosen = emitter_choose(scene, params, words.x, alias_word);
        return light_choice_make(chosen, warp_rest_word(words.x, params->emitter_count, alias_word),
                                 alias_word, v / emitter, emitter * (real)scene->emitters[chosen].pdf_a);
    }
    if (HAS(EFFECT_ENVIRONMENT) && v < emitter + sky)
        return light_choice_make(light_of_sky(params), words.x, alias_word, (v - emitter) / sky, sky);
    if (HAS(EFFECT_DELTA_LIGHT) && light > REAL(0.0)) {
        const uint chosen = delta_light_choose(scene, params, words.x, alias_word);
        return light_choice_make(params->emitter_count + chosen,
                                 warp_rest_word(words.x, params->light_count, alias_word), alias_word,
                                 (v - emitter - sky) / light,
                                 light * (real)scene->lights[chosen].probability);
    }
    return light_choice_make(NO_INDEX, 0u, 0u, v, REAL(0.0));
}

/* By the tree: the first word, with the alias word for digits below its own, chooses and gives, by what is
   left, a coordinate of the point. A map's texel is chosen by the second, which is known before the vertex
   (environment_prefetch_slot). */
static inline LightChoice light_choose_by_tree(const Scene* scene, const RenderParams* params,
                                               const LightView* view, uint2 words, uint alias_word)
{
    const ulong number = ((ulong)words.x << 32 | alias_word) >> 1;
    const LightInterval chosen = light_tree_choose(scene, view, number);
    const real v = sampler_unit(words.y);
    if (chosen.width == 0ul)
        return light_choice_make(NO_INDEX, 0u, 0u, v, REAL(0.0));
    const uint rest = light_tree_rest(number - chosen.low, chosen.width);
    const real probability = light_tree_probability(chosen.width);
    if (chosen.link == light_of_sky(params))
        return light_choice_make(chosen.link, words.y, alias_word, sampler_unit(rest), probability);
    return light_choice_make(chosen.link, rest, alias_word, v,
                             probability * (real)scene->light_places[chosen.link].density);
}

static inline LightChoice light_choose(const Scene* scene, const RenderParams* params, const LightView* view,
                                       uint2 words, uint alias_word)
{
    if (light_choice_is_by_tree(params))
        return light_choose_by_tree(scene, params, view, words, alias_word);
    const LightKinds kinds = {(real)params->choose_emitter, (real)params->choose_environment,
                              (real)params->choose_light};
    return light_choose_by_tables(scene, params, kinds, words, alias_word);
}

/* The probability of an emissive triangle over its area. */
static inline real light_probability_of_emitter(const Scene* scene, const RenderParams* params,
                                                const LightView* view, uint emitter)
{
    if (light_choice_is_by_tree(params))
        return light_tree_probability(light_tree_width(scene, view, emitter)) *
               (real)scene->light_places[emitter].density;
    return (real)params->choose_emitter * (real)scene->emitters[emitter].pdf_a;
}

/* The probability of a point or sun. */
static inline real light_probability_of_delta(const Scene* scene, const RenderParams* params,
                                              const LightView* view, uint index)
{
    if (light_choice_is_by_tree(params))
        return light_tree_probability(light_tree_width(scene, view, params->emitter_count + index));
    return (real)(params->choose_light * scene->lights[index].probability);
}

/* The probability of the environment map. */
static inline real light_probability_of_sky(const Scene* scene, const RenderParams* params,
                                            const LightView* view)
{
    if (light_choice_is_by_tree(params))
        return light_tree_probability(light_tree_width(scene, view, light_of_sky(params)));
    return (real)params->choose_environment;
}

#endif
