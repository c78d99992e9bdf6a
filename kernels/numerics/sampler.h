// SPDX-License-Identifier: Apache-2.0
// Random numbers by address: every number is a pure function of (seed, pixel, replicate, sample, bounce,
// purpose). Pairs come from Owen-scrambled Sobol points (Owen 1995; hashed scrambling: Laine and Karras 2011;
// padding with shuffled indices: Burley 2020, JCGT 9(4)), single words from a hash.
// -DCLRT_SAMPLER=SAMPLER_INDEPENDENT takes pairs from a hash too: white noise, to measure what the order of
// Sobol points is worth.
#ifndef CLRT_NUMERICS_SAMPLER_H
#define CLRT_NUMERICS_SAMPLER_H

#include "real.h"

#define SAMPLER_SOBOL 0
#define SAMPLER_INDEPENDENT 1
#ifndef CLRT_SAMPLER
#define CLRT_SAMPLER SAMPLER_SOBOL
#endif

/* What a number is for. A bounce owns SAMPLER_PURPOSES addresses; removing an effect moves no other number,
   and what is new takes a number that no other has had. */
#define SAMPLE_FILM 0u
#define SAMPLE_DIRECTION 1u   /* direction within a lobe */
#define SAMPLE_LOBE 2u        /* which lobe */
#define SAMPLE_LIGHT 3u       /* which light, and the point on it */
#define SAMPLE_LIGHT_ALIAS 4u /* second word of an alias table */
#define SAMPLE_SKY 5u         /* direction to the environment, where it is sampled beside the other lights */
#define SAMPLE_ROULETTE 6u
#define SAMPLE_ROUNDING 7u    /* of the film's fixed point */
#define SAMPLE_COVERAGE 8u    /* cut-outs; hashed on with their number along the ray */
#define SAMPLE_CLASS 9u       /* matte or glossy, where a path filter must know and both are possible */
#define SAMPLE_LENS 10u       /* point of the lens; camera rays are bounce 0 */
#define SAMPLE_TIME 11u       /* within the shutter's opening */
#define SAMPLER_PURPOSES 16u

typedef struct {
    uint key;            /* of pixel, replicate and seed */
    uint index_reversed; /* bits of the sample's number within its replicate, reversed */
    uint word_key;       /* key and sample: for single words */
} Sampler;

/* A bijection of 32-bit words with good avalanche (Wellons 2018, "lowbias32"). */
static inline uint sampler_hash(uint x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    x ^= x >> 16;
    return x;
}

static inline uint sampler_reverse_bits(uint x)
{
#ifdef CLRT_REVERSE_BITS
    return CLRT_REVERSE_BITS(x);
#else
    x = ((x >> 1) & 0x55555555u) ^ ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) ^ ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) ^ ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) ^ ((x & 0x00ff00ffu) << 8);
    return rotate(x, 16u);
#endif
}

/* Owen scrambling of a number whose bits are reversed: bit k is flipped depending on the bits below it
   (constants: Vegdahl 2021). */
static inline uint sampler_scramble_reversed(uint x, uint seed)
{
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

/* The second Sobol dimension of an index, bits reversed: Pascal's triangle modulo 2 times the index bits,
   which is a Kronecker power of [1 1; 0 1] and so a butterfly. */
static inline uint sampler_pascal_reversed(uint index)
{
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= (index >> 16) & 0x0000ffffu;
    return index;
}

/* Maps a word to the odd multiples of 2^-24: exact, never 0, never 1, and 1 - u is exact. */
static inline real sampler_unit(uint word) { return (real)((word >> 8) | 1u) * REAL(5.9604644775390625e-8); }

/* The sampler of sample number `index` of a replicate. `pixel` counts in the whole picture. Distinct pixels
   of a replicate never share a key. */
static inline Sampler sampler_make(uint seed, uint pixel, uint replicate, uint index)
{
    Sampler sampler;
    sampler.key = sampler_hash(pixel ^ sampler_hash(replicate + sampler_hash(seed + 0x9e3779b9u)));
    sampler.index_reversed = sampler_reverse_bits(index);
    sampler.word_key = sampler_hash(sampler.key ^ (index * 0x85ebca6bu));
    return sampler;
}

static inline uint sampler_address(uint bounce, uint purpose) { return bounce * SAMPLER_PURPOSES + purpose; }

/* A word that is independent of all others. */
static inline uint sampler_word(const Sampler* sampler, uint bounce, uint purpose)
{
    return sampler_hash(sampler->word_key + sampler_address(bounce, purpose) * 0x9e3779b9u);
}

/* One number of its own in (0, 1). */
static inline real sampler_number(const Sampler* sampler, uint bounce, uint purpose)
{
    return sampler_unit(sampler_word(sampler, bounce, purpose));
}

/* A pair of words that is independent of all others. The second mixes pixel and sample in once more: a
   function of the first alone would put all pairs on one curve. */
static inline uint2 sampler_independent_words(const Sampler* sampler, uint bounce, uint purpose)
{
    const uint x = sampler_hash(sampler_word(sampler, bounce, purpose) ^ 0xa511e9b3u);
    return (uint2)(x, sampler_hash(x ^ sampler_hash(sampler->key + sampler->index_reversed)));
}

/* A pair of words: over a replicate's first 2^m samples, a scrambled (0, m, 2)-net. */
static inline uint2 sampler_sobol_words(const Sampler* sampler, uint bounce, uint purpose)
{
    const uint key = sampler_hash(sampler->key + sampler_address(bounce, purpose) * 0x9e3779b9u);
    /* Shuffle the index, so that different addresses are independent of each other. */
    const uint index = sampler_reverse_bits(sampler_scramble_reversed(sampler->index_reversed, key));
    /* Scramble both dimensions of the Sobol point. */
    const uint x = sampler_scramble_reversed(index, key * 0x9e3779b9u);
    const uint y = sampler_scramble_reversed(sampler_pascal_reversed(index), key * 0x85ebca6bu);
    return (uint2)(sampler_reverse_bits(x), sampler_reverse_bits(y));
}

/* A pair of words of the chosen kind. */
static inline uint2 sampler_pair_words(const Sampler* sampler, uint bounce, uint purpose)
{
    if (CLRT_SAMPLER == SAMPLER_INDEPENDENT)
        return sampler_independent_words(sampler, bounce, purpose);
    return sampler_sobol_words(sampler, bounce, purpose);
}

static inline real2 sampler_pair(const Sampler* sampler, uint bounce, uint purpose)
{
    const uint2 words = sampler_pair_words(sampler, bounce, purpose);
    return (real2)(sampler_unit(words.x), sampler_unit(words.y));
}

#endif
