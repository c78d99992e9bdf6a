// SPDX-License-Identifier: Apache-2.0
// Lights that are no geometry: points, and suns with or without a disc.
#ifndef CLRT_LIGHTS_DELTA_LIGHT_H
#define CLRT_LIGHTS_DELTA_LIGHT_H

#include "light_sample.h"
#include "numerics/frame.h"

/* True of suns that rays can meet. */
static inline bool delta_light_has_disc(global const Light* light)
{
    return light->kind == LIGHT_SUN && light->one_minus_cos > 0.0f;
}

/* True if a point light shines within a cone. */
static inline bool delta_light_is_spot(global const Light* light)
{
    return HAS(EFFECT_SPOT) && LIGHT_SHARPNESS(*light) > 0.0f;
}

/* The part of its intensity that a point light sends along w, unit. Of a spot the square of what is left to
   the outer cosine, over what is between both; 1 - cos of the angle between unit vectors is |a - b|^2 / 2. */
static inline real delta_light_falloff(global const Light* light, real3 w)
{
    if (!delta_light_is_spot(light))
        return REAL(1.0);
    const real3 apart = w - (real3)((real)light->axis_x, (real)light->axis_y, (real)light->axis_z);
    const real left = (real)light->one_minus_cos - REAL(0.5) * vector_dot(apart, apart);
    const real share = clamp(left * (real)LIGHT_SHARPNESS(*light), REAL(0.0), REAL(1.0));
    return share * share;
}

/* The light from one entry of the array at a position, before a spot's falloff; u chooses the direction
   within a sun's disc. */
static CLRT_NOINLINE LightSample delta_light_sample(const Scene* scene, uint index, real3 position, real2 u)
{
    global const Light* light = scene->lights + index;
    LightSample sample = light_sample_none();
    const real3 vector = vector_from(light->vector);
    sample.radiance = vector_from(light->emission);
    sample.pdf_w = REAL(1.0);
    if (light->kind == LIGHT_POINT) {
        const real3 way = vector - position;
        const real distance_squared = vector_dot(way, way);
        /* At the light itself the inverse square has no value. */
        if (distance_squared == REAL(0.0))
            return light_sample_none();
        sample.wi = way / real_sqrt(distance_squared);
        sample.radiance /= distance_squared;
        sample.target = vector;
        sample.is_distant = false;
        return sample;
    }
    sample.wi = vector;
    if (light->one_minus_cos > 0.0f) {
        const Frame frame = frame_make(vector);
        sample.wi = frame_to_world(&frame, warp_cone(u, (real)light->one_minus_cos));
        sample.pdf_w = warp_cone_pdf_w((real)light->one_minus_cos);
        sample.is_delta = false;
    }
    return sample;
}

/* Dims a sample of a spot by its falloff, once its direction is final (light_choose_side); outside of the
   cone there is no light. */
static inline void delta_light_dim(const Scene* scene, uint index, LightSample* sample)
{
    if (!HAS(EFFECT_SPOT) || scene->lights[index].kind != LIGHT_POINT)
        return;
    const real falloff = delta_light_falloff(scene->lights + index, -sample->wi);
    sample->radiance *= falloff;
    sample->pdf_w = falloff > REAL(0.0) ? sample->pdf_w : REAL(0.0);
}

/* Index of the light that a word and an alias word choose. */
static inline uint delta_light_choose(const Scene* scene, const RenderParams* params, uint word,
                                      uint alias_word)
{
    const uint slot = warp_index(word, params->light_count);
    return alias_word < scene->lights[slot].threshold ? slot : scene->lights[slot].alias;
}

/* True if a direction lies within the disc of a sun. */
static inline bool delta_light_covers(const Scene* scene, uint index, real3 wi)
{
    global const Light* light = scene->lights + index;
    if (!delta_light_has_disc(light))
        return false;
    /* 1 - cos of the angle between unit vectors is |a - b|^2 / 2. */
    const real3 apart = wi - vector_from(light->vector);
    return REAL(0.5) * vector_dot(apart, apart) <= (real)light->one_minus_cos;
}

#endif
