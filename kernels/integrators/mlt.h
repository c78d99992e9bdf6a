// SPDX-License-Identifier: Apache-2.0
// Metropolis light transport (Veach and Guibas 1997) in primary sample space (Kelemen et al. 2002), over all
// strategies of path+light (path/chain_path.h). Simulates L(D|G|S)*E: what the camera's ray meets is gathered
// pixel by pixel, and all longer paths are walked by Markov chains.
//
// Chains visit paths in proportion to a score, luminance times the importance of the tile, and a path that is
// visited counts radiance over score times the mean score of all paths. The mean score comes from new paths;
// the same paths, drawn in proportion to their scores, are where chains start, so that every state of a chain
// has the distribution of all, in expectation, from the first on (Veach 1997, 11.3.1). Both the proposal and
// the path that it leaves are splatted, each by the probability of being next.
#ifndef CLRT_INTEGRATORS_MLT_H
#define CLRT_INTEGRATORS_MLT_H

#include "light.h"
#include "path/chain_path.h"

/* Probability of a step to a new path, which leaves what small steps cannot. */
#define CHAIN_LARGE_STEP REAL(0.3)

/* What chains read and write besides scene and film. Arrays go through replicates, and within them through
   lengths and paths, or through chains. */
typedef struct {
    global Chain* chains;
    global uint* words;             /* CHAIN_BOUNCE_WORDS for each vertex that a path can have, and one more */
    global float* scores;           /* of new paths */
    global const uint* starts;      /* of each chain: the path that it starts at, NO_INDEX for none */
    global const float* scales;     /* of each replicate: what a splat counts, times its score over radiance */
    global const float* importance; /* of each tile */
} ChainArrays;

/* Random numbers of a replicate in an epoch; `stream` tells who draws them, `index` is the sample's. */
static inline Sampler chain_sampler(const RenderParams* params, const ChainLaunch* launch, uint replicate,
                                    uint stream, uint index)
{
    const uint key = sampler_hash(params->seed + sampler_hash(launch->epoch + 0x6d6c7400u));
    return sampler_at(sampler_hash(stream ^ sampler_hash(replicate + key)), index);
}

/* Streams of new paths, one for each length: behind those of the chains. */
#define CHAIN_FIND_STREAM 0x80000000u

/* The score of a path; 0 for one that brings nothing. */
static inline real chain_score(const RenderParams* params, const ChainArrays* arrays, const ChainPath* path)
{
    uint slot;
    if (film_fault(params, path->radiance) != COUNT_WORDS || !tile_slot_at(params, path->film, &slot))
        return REAL(0.0);
    return vector_luminance(path->radiance) * (real)arrays->importance[slot / TILE_PIXELS];
}

/* Counts a path that is no light. */
static inline void chain_count_fault(const RenderParams* params, const ChainPath* path,
                                     global volatile uint* counters)
{
    const uint fault = film_fault(params, path->radiance);
    if (fault != COUNT_WORDS)
        atomic_inc(counters + fault);
}

/* The new path number `path` of those of a replicate, and its length. */
static inline Sampler chain_new_sampler(const RenderParams* params, const ChainLaunch* launch,
                                        uint replicate, uint path, uint* length)
{
    const uint stratum = path / launch->paths;
    *length = CHAIN_SHORTEST + stratum;
    return chain_sampler(params, launch, replicate, CHAIN_FIND_STREAM + stratum, path % launch->paths);
}

/* Scores a new path. */
static inline void chain_find(const Scene* scene, const RenderParams* params, const ChainLaunch* launch,
                              const ChainArrays* arrays, uint item, global volatile uint* counters,
                              PixelRays* rays)
{
    const uint of_replicate = launch->paths * launch->lengths;
    uint length;
    const Sampler sampler =
        chain_new_sampler(params, launch, item / of_replicate, item % of_replicate, &length);
    const ChainPath path = chain_path(scene, params, &sampler, length, rays);
    chain_count_fault(params, &path, counters);
    arrays->scores[item] = (float)chain_score(params, arrays, &path);
}

static inline global uint* chain_own_words(const RenderParams* params, const ChainArrays* arrays, uint item)
{
    return arrays->words + (ulong)item * (CHAIN_BOUNCE_WORDS * (params->max_depth + 1u));
}

/* Keeps the words of a pair. */
static inline void chain_keep_pair(const Sampler* sampler, uint bounce, uint purpose, bool is_partner,
                                   global uint* words)
{
    const uint2 pair = sampler_words(sampler, sampler_address(bounce, purpose), is_partner);
    global uint* place = words + chain_place(bounce, purpose) + (is_partner ? 2u : 0u);
    place[0] = pair.x;
    place[1] = pair.y;
}

static inline void chain_keep_word(const Sampler* sampler, uint bounce, uint purpose, global uint* words)
{
    words[chain_place(bounce, purpose)] = sampler_word(sampler, bounce, purpose);
}

/* Makes the sampler's words, as far as a path of `length` segments asks for them, the chain's. */
static CLRT_NOINLINE void chain_keep(const Sampler* sampler, uint length, global uint* words)
{
    for (uint bounce = 0u; bounce <= length; ++bounce) {
        const uint pair = bounce == 0u ? SAMPLE_FILM : SAMPLE_DIRECTION;
        chain_keep_pair(sampler, bounce, pair, false, words);
        chain_keep_pair(sampler, bounce, pair, true, words);
        chain_keep_pair(sampler, bounce, SAMPLE_LIGHT, false, words);
        chain_keep_pair(sampler, bounce, SAMPLE_LENS, false, words);
        chain_keep_pair(sampler, bounce, SAMPLE_TIME, false, words);
        chain_keep_word(sampler, bounce, SAMPLE_LIGHT_ALIAS, words);
        chain_keep_word(sampler, bounce, SAMPLE_COVERAGE, words);
        chain_keep_word(sampler, bounce, SAMPLE_SPLAT, words);
        chain_keep_word(sampler, bounce, SAMPLE_STRATEGY, words);
    }
}

static inline void chain_set_path(const ChainPath* path, real score, Chain* chain)
{
    chain->red = (float)path->radiance.x;
    chain->green = (float)path->radiance.y;
    chain->blue = (float)path->radiance.z;
    chain->score = (float)score;
    chain->x = (float)path->film.x;
    chain->y = (float)path->film.y;
}

/* Starts a chain. */
static inline void chain_start(const Scene* scene, const RenderParams* params, const ChainLaunch* launch,
                               const ChainArrays* arrays, uint item, PixelRays* rays)
{
    Chain chain = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, CHAIN_SHORTEST, 0u, 0u, 0u, 0u, 0u};
    const uint start = arrays->starts[item];
    if (start != NO_INDEX) {
        const Sampler sampler =
            chain_new_sampler(params, launch, item / launch->chains, start, &chain.length);
        const ChainPath path = chain_path(scene, params, &sampler, chain.length, rays);
        chain_set_path(&path, chain_score(params, arrays, &path), &chain);
        chain_keep(&sampler, chain.length, chain_own_words(params, arrays, item));
    }
    arrays->chains[item] = chain;
}

/* Splats what a path brings, times `weight`. */
static inline void chain_splat(const RenderParams* params, global long* film, uint replicate,
                               const Sampler* rounding, uint number, real2 position, real3 radiance,
                               real weight, global volatile uint* counters)
{
    if (!(weight > REAL(0.0)))
        return;
    const uint fault =
        film_splat(params, film, replicate, rounding, number, position, radiance * weight);
    if (fault != COUNT_WORDS)
        atomic_inc(counters + fault);
}

/* Takes a step of a chain: proposes a path, splats both, and takes it or stays. */
static CLRT_NOINLINE void chain_step(const Scene* scene, const RenderParams* params,
                                     const ChainLaunch* launch, const ChainArrays* arrays, uint item,
                                     global long* film, global volatile uint* counters, Chain* chain,
                                     PixelRays* rays)
{
    const uint replicate = item / launch->chains;
    global uint* words = chain_own_words(params, arrays, item);
    const Sampler fresh = chain_sampler(params, launch, replicate, item % launch->chains, chain->steps++);
    Sampler proposal = fresh;
    proposal.chain = words;
    proposal.is_large = sampler_number(&fresh, 0u, SAMPLE_STEP) < CHAIN_LARGE_STEP;
    const ChainPath path = chain_path(scene, params, &proposal, chain->length, rays);
    chain_count_fault(params, &path, counters);

    const real score = chain_score(params, arrays, &path);
    const real here = (real)chain->score;
    const real chance = score < here ? score / here : REAL(1.0);
    const real scale = (real)arrays->scales[replicate];
    if (score > REAL(0.0))
        chain_splat(params, film, replicate, &fresh, 1u, path.film, path.radiance, chance * scale / score,
                    counters);
    chain_splat(params, film, replicate, &fresh, 2u, (real2)((real)chain->x, (real)chain->y),
                vector_make((real)chain->red, (real)chain->green, (real)chain->blue),
                (REAL(1.0) - chance) * scale / here, counters);

    chain->large_steps += proposal.is_large ? 1u : 0u;
    if (!(sampler_number(&fresh, 1u, SAMPLE_STEP) < chance))
        return;
    *(proposal.is_large ? &chain->taken_large : &chain->taken_small) += 1u;
    chain_keep(&proposal, chain->length, words);
    chain_set_path(&path, score, chain);
}

/* Samples of a replicate among the first `samples` ones of a pixel. */
static inline uint chain_samples(const RenderParams* params, uint replicate, uint samples)
{
    return (samples + params->replicates - 1u - replicate) / params->replicates;
}

/* Takes a chain through the launch's samples of its replicate. */
static inline void chain_walk(const Scene* scene, const RenderParams* params, const ChainLaunch* launch,
                              const ChainArrays* arrays, uint item, global long* film,
                              global volatile uint* counters, PixelRays* rays)
{
    Chain chain = arrays->chains[item];
    if (!(chain.score > 0.0f))
        return;
    const uint replicate = item / launch->chains;
    const uint samples = chain_samples(params, replicate, params->first_sample + params->sample_count) -
                         chain_samples(params, replicate, params->first_sample);
    for (uint i = 0u; i < samples * launch->steps; ++i)
        chain_step(scene, params, launch, arrays, item, film, counters, &chain, rays);
    arrays->chains[item] = chain;
}

/* Adds counts to a pixel's words: whichever, they are looked at as a sum. */
static inline void chain_count_rays(const RenderParams* params, const PixelRays* rays, uint item,
                                    global volatile uint* pixel_rays)
{
    const uint slot = item % (params->tile_count * TILE_PIXELS);
    global volatile uint* words = pixel_rays + tile_index(slot, PIXEL_RAYS_WORDS);
    atomic_add(words + PIXEL_RAYS_SECONDARY, rays->secondary);
    atomic_add(words + PIXEL_RAYS_SHADOW, rays->shadow);
    atomic_add(words + PIXEL_CUT_PATHS, rays->cut);
}

static CLRT_NOINLINE void mlt_chain(const Scene* scene, const RenderParams* params, const ChainLaunch* launch,
                                    const ChainArrays* arrays, uint item, global long* film,
                                    global volatile uint* pixel_rays, global volatile uint* counters)
{
    PixelRays rays = {0u, 0u, 0u, 0ul, 0u};
    const uint items =
        params->replicates * (launch->task == CHAIN_FIND ? launch->paths * launch->lengths : launch->chains);
    if (item >= items)
        return;
    if (launch->task == CHAIN_FIND)
        chain_find(scene, params, launch, arrays, item, counters, &rays);
    else if (launch->task == CHAIN_START)
        chain_start(scene, params, launch, arrays, item, &rays);
    else
        chain_walk(scene, params, launch, arrays, item, film, counters, &rays);
    chain_count_rays(params, &rays, item, pixel_rays);
}

/* What the camera's rays meet. */
static CLRT_NOINLINE void mlt_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples,
                                       uint count, PixelRays* rays)
{
    for (uint k = 0; k < count; ++k)
        light_gather(scene, params, &samples[k], rays);
}

#endif
