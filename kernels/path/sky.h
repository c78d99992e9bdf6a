// SPDX-License-Identifier: Apache-2.0
// Light samples of the environment map, drawn for several paths in the lanes of vectors. Where the map is the
// only light, what is drawn from it does not depend on the vertex.
#ifndef CLRT_PATH_SKY_H
#define CLRT_PATH_SKY_H

#include "lights/lights.h"
#include "numbers.h"

/* What is drawn, and by which numbers, an array for each member. */
typedef struct {
    uint word[SAMPLES_AT_ONCE], alias_word[SAMPLES_AT_ONCE];
    real v[SAMPLES_AT_ONCE];
    real wi_x[SAMPLES_AT_ONCE], wi_y[SAMPLES_AT_ONCE], wi_z[SAMPLES_AT_ONCE], pdf_w[SAMPLES_AT_ONCE];
    real red[SAMPLES_AT_ONCE], green[SAMPLES_AT_ONCE], blue[SAMPLES_AT_ONCE];
} SkyLanes;

static inline void sky_set_numbers(SkyLanes* lanes, uint i, const PathNumbers* numbers)
{
    lanes->word[i] = numbers->light.x;
    lanes->v[i] = sampler_unit(numbers->light.y);
    lanes->alias_word[i] = numbers->alias;
}

/* Draws for a whole vector of paths, from number `first` on. */
CLRT_GIVES_STRUCT void sky_draw_vector(const Scene* scene, const RenderParams* params, uint format,
                                       SkyLanes* restrict lanes, uint first)
{
    for (uint i = first; i < first + DEVICE_LANES; ++i) {
        const SkySample sample =
            environment_draw(scene, params, format, lanes->word[i], lanes->alias_word[i], lanes->v[i]);
        lanes->wi_x[i] = sample.wi_x;
        lanes->wi_y[i] = sample.wi_y;
        lanes->wi_z[i] = sample.wi_z;
        lanes->pdf_w[i] = sample.pdf_w;
        lanes->red[i] = sample.radiance.red;
        lanes->green[i] = sample.radiance.green;
        lanes->blue[i] = sample.radiance.blue;
    }
}

/* Draws for `count` paths; behind the last one, numbers are filled up to a whole vector. */
static CLRT_NOINLINE void sky_draw(const Scene* scene, const RenderParams* params,
                                   SkyLanes* restrict lanes, uint count)
{
    for (uint first = 0u; first < count; first += DEVICE_LANES) {
        if (params->environment_format == SKY_TEXEL_RGBE)
            sky_draw_vector(scene, params, SKY_TEXEL_RGBE, lanes, first);
        else if (params->environment_format == SKY_TEXEL_HALF)
            sky_draw_vector(scene, params, SKY_TEXEL_HALF, lanes, first);
        else
            sky_draw_vector(scene, params, SKY_TEXEL_FLOAT, lanes, first);
    }
}

static inline SkySample sky_of(const SkyLanes* lanes, uint i)
{
    const SkySample sample = {lanes->wi_x[i], lanes->wi_y[i], lanes->wi_z[i], lanes->pdf_w[i],
                              {lanes->red[i], lanes->green[i], lanes->blue[i]}};
    return sample;
}

#endif
