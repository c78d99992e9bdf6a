// SPDX-License-Identifier: Apache-2.0
// The random numbers of a path's vertices. They are drawn before the ray is traced, because they do not wait
// for the hit, and for all paths of a group in one go.
#ifndef CLRT_PATH_NUMBERS_H
#define CLRT_PATH_NUMBERS_H

#include "numerics/sampler.h"

/* More than a path has. */
#define NUMBERS_BOUNCES 131072u

/* Those of one vertex. */
typedef struct {
    uint2 light;
    uint alias;
    real lobe;
    real2 direction;
} PathNumbers;

/* Every epoch of a guided render has nets of its own (path/guide.h): later points of a net fill the gaps of
   its earlier ones, which the guide knows of. The net of the film and the first light sample goes on, because
   what it decides does not depend on the guide. */
static inline PathNumbers numbers_make(const Sampler* sampler, uint segment, uint epoch)
{
    const uint bounce = segment + NUMBERS_BOUNCES * epoch;
    PathNumbers numbers;
    numbers.light = sampler_light_words(sampler, segment == 1u ? segment : bounce);
    numbers.direction = sampler_pair(sampler, bounce, SAMPLE_DIRECTION);
    /* In one net with the direction: each lobe's directions are even, and so are the lobes. */
    const uint2 choices = sampler_partner_words(sampler, bounce, SAMPLE_DIRECTION);
    numbers.lobe = sampler_unit(choices.x);
    numbers.alias = choices.y;
    return numbers;
}

/* Samplers and numbers of several paths, an array for each member, as vectors want them. */
typedef struct {
    uint key[SAMPLES_AT_ONCE], index_reversed[SAMPLES_AT_ONCE], word_key[SAMPLES_AT_ONCE];
    uint light_x[SAMPLES_AT_ONCE], light_y[SAMPLES_AT_ONCE], alias[SAMPLES_AT_ONCE];
    real lobe[SAMPLES_AT_ONCE], direction_x[SAMPLES_AT_ONCE], direction_y[SAMPLES_AT_ONCE];
} NumberLanes;

static inline void numbers_set_sampler(NumberLanes* lanes, uint i, const Sampler* sampler)
{
    lanes->key[i] = sampler->key;
    lanes->index_reversed[i] = sampler->index_reversed;
    lanes->word_key[i] = sampler->word_key;
}

/* Draws the numbers of whole vectors of paths, from number `first` on. */
static inline void numbers_draw_vector(NumberLanes* lanes, uint segment, uint epoch, uint first)
{
    for (uint i = first; i < first + DEVICE_LANES; ++i) {
        const Sampler sampler =
            sampler_of_keys(lanes->key[i], lanes->index_reversed[i], lanes->word_key[i]);
        const PathNumbers numbers = numbers_make(&sampler, segment, epoch);
        lanes->light_x[i] = numbers.light.x;
        lanes->light_y[i] = numbers.light.y;
        lanes->alias[i] = numbers.alias;
        lanes->lobe[i] = numbers.lobe;
        lanes->direction_x[i] = numbers.direction.x;
        lanes->direction_y[i] = numbers.direction.y;
    }
}

/* Draws those of `count` paths at the end of the same segment; behind the last one, samplers are filled up to
   a whole vector. */
static CLRT_NOINLINE void numbers_draw(NumberLanes* lanes, uint segment, uint epoch, uint count)
{
    for (uint first = 0u; first < count; first += DEVICE_LANES)
        numbers_draw_vector(lanes, segment, epoch, first);
}

static inline PathNumbers numbers_of(const NumberLanes* lanes, uint i)
{
    PathNumbers numbers;
    numbers.light = (uint2)(lanes->light_x[i], lanes->light_y[i]);
    numbers.alias = lanes->alias[i];
    numbers.lobe = lanes->lobe[i];
    numbers.direction = (real2)(lanes->direction_x[i], lanes->direction_y[i]);
    return numbers;
}

#endif
