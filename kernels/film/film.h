// SPDX-License-Identifier: Apache-2.0
// The film: 64-bit fixed-point sums of radiance, three a pixel and replicate, and the counters. Adding
// integers is exact and order-free, so passes, launch sizes, splats (splat.h) and merged runs give the same
// bits.
#ifndef CLRT_FILM_FILM_H
#define CLRT_FILM_FILM_H

#include "film/sum.h"
#include "numerics/sampler.h"
#include "numerics/vector.h"
#include "shared/render_types.h"

/* Rays that a work-item has traced besides its primary rays, paths that max_depth has cut, and primary rays
   that have left the scene: counting those costs nothing where there are none. */
typedef struct {
    uint secondary, shadow;
    uint cut;
    ulong cut_weight; /* sum of what the cut paths would have weighed, in units of 1 / CUT_WEIGHT_UNITS */
    uint missed;
} PixelRays;

/* Counts a path that max_depth has cut; `weight` is that of the radiance which it would have met next. */
static inline void film_count_cut(real3 weight, PixelRays* rays)
{
    const real largest = vector_max_component(weight);
    const real counted = largest < (real)CUT_WEIGHT_LARGEST ? largest : (real)CUT_WEIGHT_LARGEST;
    ++rays->cut;
    rays->cut_weight += convert_ulong(ceil(counted * (real)CUT_WEIGHT_UNITS));
}

/* Adds a work-item's counts over so many samples to its pixel's words. */
static inline void film_add_counts(const PixelRays* rays, uint samples, global uint* words)
{
    words[PIXEL_RAYS_SECONDARY] += rays->secondary;
    words[PIXEL_RAYS_SHADOW] += rays->shadow;
    words[PIXEL_SHOWN] |= rays->missed != samples ? 1u : 0u;
    if (rays->cut == 0u)
        return;
    const ulong weight =
        upsample(words[PIXEL_CUT_WEIGHT_HIGH], words[PIXEL_CUT_WEIGHT_LOW]) + rays->cut_weight;
    words[PIXEL_CUT_PATHS] += rays->cut;
    words[PIXEL_CUT_WEIGHT_LOW] = (uint)weight;
    words[PIXEL_CUT_WEIGHT_HIGH] = (uint)(weight >> 32);
}

/* Which counter a bad sample belongs to; COUNT_WORDS for a good one. */
static inline uint film_fault(const RenderParams* params, real3 radiance)
{
    if (real_is_nan(radiance.x) || real_is_nan(radiance.y) || real_is_nan(radiance.z))
        return COUNT_NAN;
    if (!vector_is_finite(radiance))
        return COUNT_INFINITE;
    if (fmin(radiance.x, fmin(radiance.y, radiance.z)) < REAL(0.0))
        return COUNT_NEGATIVE;
    if (vector_max_component(radiance) > (real)params->largest_contribution)
        return COUNT_OVERFLOW;
    return COUNT_WORDS;
}

/* Counts a bad sample and notes its address for replay. */
static inline void film_report_fault(global volatile uint* counters, uint fault, uint pixel, uint sample)
{
    atomic_inc(counters + fault);
    const uint slot = atomic_inc(counters + COUNT_BAD_SAMPLES);
    if (slot < REPLAY_CAPACITY) {
        counters[COUNT_WORDS + 2u * slot] = pixel;
        counters[COUNT_WORDS + 2u * slot + 1u] = sample;
    }
}

/* Rounds a value in quanta up or down with the probability of its fraction: dark pixels stay unbiased. */
static inline long film_round(real quanta, uint word)
{
    const real whole = floor(quanta);
    return convert_long(whole) + (sampler_unit(word) < quanta - whole ? 1 : 0);
}

/* The three sums of a slot (tile.h) in a plane of the film: planes are the replicates that are kept apart,
   and behind them the layers of paths (path/layers.h). The only place in the kernels that knows how the film
   lies in memory. */
static inline global long* film_plane_sums(const RenderParams* params, global long* film, uint slot,
                                           uint plane)
{
    const ulong slots = (ulong)params->tile_count * TILE_PIXELS;
    return film + 3u * (plane * slots + slot);
}

/* Those of a slot in a replicate. Replicates are folded where not all are kept apart. */
static inline global long* film_sums(const RenderParams* params, global long* film, uint slot, uint replicate)
{
    const uint kept = replicate < params->film_replicates ? replicate : replicate % params->film_replicates;
    return film_plane_sums(params, film, slot, kept);
}

/* A good radiance in quanta, rounded by a random word. */
static inline long3 film_quanta(const RenderParams* params, uint word, real3 radiance)
{
    const real3 quanta = radiance * (real)params->inverse_quantum;
    return (long3)(film_round(quanta.x, word), film_round(quanta.y, word * 0x9e3779b9u),
                   film_round(quanta.z, word * 0x85ebca6bu));
}

/* Adds to the three sums of a pixel. False where one is full. */
static inline bool film_add_quanta(global long* sums, long3 quanta)
{
    const bool red = sum_add(sums, quanta.x);
    const bool green = sum_add(sums + 1, quanta.y);
    const bool blue = sum_add(sums + 2, quanta.z);
    return red && green && blue;
}

/* Adds a good radiance, rounded by a random word. False where a sum is full. */
static inline bool film_add_rounded(const RenderParams* params, global long* sums, uint word, real3 radiance)
{
    return film_add_quanta(sums, film_quanta(params, word, radiance));
}

/* Adds the radiance that a sample has gathered, where it is good. False where a sum is full. */
static inline bool film_add(const RenderParams* params, global long* sums, const Sampler* sampler,
                            real3 radiance)
{
    return film_add_rounded(params, sums, sampler_word(sampler, 0u, SAMPLE_ROUNDING), radiance);
}

#endif
