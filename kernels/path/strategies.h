// SPDX-License-Identifier: Apache-2.0
// Layers of strategies: the picture of a bidirectional path tracer taken apart by how paths were found.
// Strategy (s, t) joins s vertices of a path from a light to t of one from the eye, the light's and the eye's
// own ones included, and finds paths of s + t - 1 segments:
//     s = 0  the path from the eye meets the light (a hit)
//     s = 1  its last vertex is connected to a point on the light (next-event estimation)
//     t = 1  the last vertex of the path from the light is connected to the eye (a splat)
//     else   an inner connection.
// Programs built with -DSTRATEGY_SEGMENTS=K tell apart those of up to K segments: a layer behind the film's
// replicates for each, in the order of segments, then of s, and one for all that is longer. Each contribution
// is weighted as in the picture.
//
// The layers sum to the picture to the last quantum. A splat is rounded once, and that number is added to
// both. What a path from the eye gathers is rounded as a whole: r(x_n), x_i being the sum after contribution
// i. Contribution i is booked as r(x_i) - r(x_{i-1}), all rounded by the same random number: without bias,
// not negative, and the sum is r(x_n).
#ifndef CLRT_PATH_STRATEGIES_H
#define CLRT_PATH_STRATEGIES_H

#include "film/film.h"
#include "film/tile.h"

#ifndef STRATEGY_SEGMENTS
#define STRATEGY_SEGMENTS 0
#endif

#if STRATEGY_SEGMENTS > 0

/* Layers before those of so many segments: paths of one are only ever met, of others s is 0 to their
   number. */
#define STRATEGIES_BELOW(segments) ((segments) < 2u ? 0u : (segments) * ((segments) + 1u) / 2u - 2u)
#define STRATEGY_LAYERS (STRATEGIES_BELOW(STRATEGY_SEGMENTS + 1u) + 1u)

/* What a path from the eye has gathered, in quanta. */
typedef struct {
    long3 gathered;
    long3 layers[STRATEGY_LAYERS];
} StrategySums;

/* The layer of a strategy. */
static inline uint strategies_layer(uint s, uint t)
{
    const uint segments = s + t - 1u;
    return segments > STRATEGY_SEGMENTS ? STRATEGY_LAYERS - 1u : STRATEGIES_BELOW(segments) + s;
}

#else
typedef struct {
    uint unused;
} StrategySums;
#endif

static inline void strategies_begin(StrategySums* sums)
{
#if STRATEGY_SEGMENTS > 0
    sums->gathered = (long3)(0);
    for (uint i = 0; i < STRATEGY_LAYERS; ++i)
        sums->layers[i] = (long3)(0);
#endif
}

/* Books what strategy (s, t) has just added: `radiance` is all that the sample has gathered so far. */
static inline void strategies_book(const RenderParams* params, const Sampler* sampler, uint s, uint t,
                                   real3 radiance, StrategySums* sums)
{
#if STRATEGY_SEGMENTS > 0
    if (film_fault(params, radiance) != COUNT_WORDS)
        return; /* the film leaves the sample out */
    const long3 quanta = film_quanta(params, sampler_word(sampler, 0u, SAMPLE_ROUNDING), radiance);
    sums->layers[strategies_layer(s, t)] += quanta - sums->gathered;
    sums->gathered = quanta;
#endif
}

/* Adds what a sample has gathered to its slot. */
static inline void strategies_film_add(const RenderParams* params, global long* film, uint slot,
                                       const StrategySums* sums)
{
#if STRATEGY_SEGMENTS > 0
    for (uint i = 0; i < STRATEGY_LAYERS; ++i)
        film_add_quanta(film_plane_sums(params, film, slot, params->film_replicates + i), sums->layers[i]);
#endif
}

/* Adds a splat that film_splat has taken, from the end of a light path of so many segments. */
static inline void strategies_splat(const RenderParams* params, global long* film, const Sampler* sampler,
                                    uint segments, real2 position, real3 radiance)
{
#if STRATEGY_SEGMENTS > 0
    uint slot;
    if (film == 0 || !tile_slot_at(params, position, &slot))
        return;
    const uint plane = params->film_replicates + strategies_layer(segments + 1u, 1u);
    const uint word = sampler_word(sampler, segments, SAMPLE_ROUNDING);
    film_add_rounded(params, film_plane_sums(params, film, slot, plane), word, radiance);
#endif
}

#endif
