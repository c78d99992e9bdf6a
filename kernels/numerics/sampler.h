// SPDX-License-Identifier: Apache-2.0
// Random numbers by address: every number is a pure function of (seed, pixel, replicate, sample, bounce,
// purpose). Pairs, and pairs of pairs, come from Owen-scrambled digital nets (Owen 1995; hashed scrambling:
// Laine and Karras 2011; padding with shuffled indices: Burley 2020, JCGT 9(4)), single words from a hash.
// -DCLRT_SAMPLER=SAMPLER_INDEPENDENT takes pairs from a hash too: white noise, to measure what the order of
// the nets is worth. In builds with -DSAMPLER_CHAINS=1 a sampler may stand at a Markov chain's proposal
// (chain.h): its words are then those of the chain, moved a little.
//
// An address has four dimensions, a pair and its partner. Each pair is Sobol's first two dimensions, a
// (0, 2)-sequence in base 2; the partner's index is multiplied by a matrix before, which makes all four a
// (0, 4)-sequence in base 4: of 4^m points, every box of 4^-a by 4^-b by 4^-c by 4^-d, a + b + c + d = m,
// holds one (Faure 1982 for prime bases, Niederreiter 1987 for powers of primes). Sobol's dimensions 3 and 4
// by Joe and Kuo's direction numbers give no such four and cost 32 steps each.
#ifndef CLRT_NUMERICS_SAMPLER_H
#define CLRT_NUMERICS_SAMPLER_H

#include "real.h"

#ifndef SAMPLER_CHAINS
#define SAMPLER_CHAINS 0
#endif

#define SAMPLER_SOBOL 0
#define SAMPLER_INDEPENDENT 1
#ifndef CLRT_SAMPLER
#define CLRT_SAMPLER SAMPLER_SOBOL
#endif

/* What a number is for. A bounce owns SAMPLER_PURPOSES addresses; removing an effect moves no other number,
   and what is new takes a number that no other has had. */
#define SAMPLE_FILM 0u        /* partner: the light sample of the first vertex */
#define SAMPLE_DIRECTION 1u   /* direction within a lobe; partner: which lobe, and an alias table's second */
#define SAMPLE_LIGHT 3u       /* which light, and the point on it, of the vertices behind the first */
#define SAMPLE_LIGHT_ALIAS 4u /* second word of an alias table */
#define SAMPLE_SKY 5u         /* direction to the environment, where it is sampled beside the other lights */
#define SAMPLE_ROULETTE 6u
#define SAMPLE_ROUNDING 7u    /* of the film's fixed point */
#define SAMPLE_COVERAGE 8u    /* cut-outs; hashed on with their number along the ray */
#define SAMPLE_CLASS 9u       /* matte or glossy, where a path filter must know and both are possible */
#define SAMPLE_LENS 10u       /* point of the lens; camera rays are bounce 0 */
#define SAMPLE_TIME 11u       /* within the shutter's opening: the first of a pair */
#define SAMPLE_PARTNER 12u    /* which vertex of a light path a vertex of the eye's is connected to */
#define SAMPLE_SPLAT 13u      /* which of the pixels around it a splat goes to */
#define SAMPLE_STRATEGY 14u   /* how a chain's path is found; bounce 0 */
#define SAMPLE_STEP 15u       /* of a chain: whether it is large, and (bounce 1) whether it is taken */
#define SAMPLER_PURPOSES 16u

#include "chain.h"

typedef struct {
    uint key;            /* of pixel, replicate and seed */
    uint index_reversed; /* bits of the sample's number within its replicate, reversed */
    uint word_key;       /* key and sample: for single words */
#if SAMPLER_CHAINS
    global uint* chain;  /* words of the chain that is to move; 0: none is */
    bool is_large;       /* it moves anywhere instead of a little */
#endif
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

/* A sampler by its keys, of no chain. */
static inline Sampler sampler_of_keys(uint key, uint index_reversed, uint word_key)
{
    Sampler sampler;
    sampler.key = key;
    sampler.index_reversed = index_reversed;
    sampler.word_key = word_key;
#if SAMPLER_CHAINS
    sampler.chain = 0;
    sampler.is_large = false;
#endif
    return sampler;
}

/* The same replicate's sampler of another sample, number `index`. */
static inline Sampler sampler_at(uint key, uint index)
{
    return sampler_of_keys(key, sampler_reverse_bits(index), sampler_hash(key ^ (index * 0x85ebca6bu)));
}

/* The sampler of sample number `index` of a replicate. `pixel` counts in the whole picture. Distinct pixels
   of a replicate never share a key. */
static inline Sampler sampler_make(uint seed, uint pixel, uint replicate, uint index)
{
    return sampler_at(sampler_hash(pixel ^ sampler_hash(replicate + sampler_hash(seed + 0x9e3779b9u))), index);
}

/* One of the `count` branches of a sample, which are samples count * index + which of the replicate: the
   branches of a sample are even among themselves, and those of all samples are one net. */
static inline Sampler sampler_branch(const Sampler* sampler, uint count, uint which)
{
    if (count == 1u)
        return *sampler;
    return sampler_at(sampler->key, sampler_reverse_bits(sampler->index_reversed) * count + which);
}

static inline uint sampler_address(uint bounce, uint purpose) { return bounce * SAMPLER_PURPOSES + purpose; }

/* A word that is independent of all others. */
static inline uint sampler_word(const Sampler* sampler, uint bounce, uint purpose)
{
    const uint word = sampler_hash(sampler->word_key + sampler_address(bounce, purpose) * 0x9e3779b9u);
#if SAMPLER_CHAINS
    if (sampler->chain != 0)
        return sampler->is_large ? word : chain_word(sampler->chain, chain_place(bounce, purpose), word);
#endif
    return word;
}

/* One number of its own in (0, 1). */
static inline real sampler_number(const Sampler* sampler, uint bounce, uint purpose)
{
    return sampler_unit(sampler_word(sampler, bounce, purpose));
}

/* The generator matrix of the partner's index: Pascal's triangle over the field of four elements, its entry
   in row i and column j of the base-4 digits w^(j - i) times (j choose i), w^2 = w + 1. This is D^-1 P D: D
   multiplies digit j by w^j, P is the butterfly of sampler_pascal_reversed on digits instead of bits. */
static inline uint sampler_partner_index(uint index)
{
    /* Lower bits of the digits with j mod 3 = 0, 1, 2: there D multiplies by 1, w, w^2. */
    const uint j0 = 0x41041041u, j1 = 0x04104104u, j2 = 0x10410410u;
    const uint swaps = j1 | j2;
    /* w (b0, b1) = (b1, b0 + b1) and w^2 (b0, b1) = (b0 + b1, b0). */
    index = (((index >> 1) & swaps) | ((index & swaps) << 1)) ^ (index & (3u * j0 | 2u * j1 | j2));
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    index ^= (index >> 16) & 0x0000ffffu;
    return (((index >> 1) & swaps) | ((index & swaps) << 1)) ^ (index & (3u * j0 | j1 | 2u * j2));
}

/* A pair of words that is independent of all others. The second mixes pixel and sample in once more: a
   function of the first alone would put all pairs on one curve. */
CLRT_INLINE uint2 sampler_independent_words(const Sampler* sampler, uint address, bool is_partner)
{
    const uint word = sampler_hash(sampler->word_key + address * 0x9e3779b9u);
    const uint x = sampler_hash(word ^ (is_partner ? 0x63d83595u : 0xa511e9b3u));
    return (uint2)(x, sampler_hash(x ^ sampler_hash(sampler->key + sampler->index_reversed)));
}

/* A pair of words: over a replicate's first 2^m samples, a scrambled (0, m, 2)-net; with its partner, over
   the first 4^m, a (0, m, 4)-net in base 4. */
CLRT_INLINE uint2 sampler_net_words(const Sampler* sampler, uint address, bool is_partner)
{
    const uint key = sampler_hash(sampler->key + address * 0x9e3779b9u);
    /* Shuffle the index, so that different addresses are independent of each other. */
    const uint shuffled = sampler_reverse_bits(sampler_scramble_reversed(sampler->index_reversed, key));
    const uint index = is_partner ? sampler_partner_index(shuffled) : shuffled;
    /* Scramble both dimensions of the Sobol point. */
    const uint x = sampler_scramble_reversed(index, key * (is_partner ? 0xc2b2ae35u : 0x9e3779b9u));
    const uint y = sampler_scramble_reversed(sampler_pascal_reversed(index),
                                             key * (is_partner ? 0x27d4eb2fu : 0x85ebca6bu));
    return (uint2)(sampler_reverse_bits(x), sampler_reverse_bits(y));
}

/* A pair of words of the chosen kind, or its partner. */
CLRT_INLINE uint2 sampler_words(const Sampler* sampler, uint address, bool is_partner)
{
#if SAMPLER_CHAINS
    if (sampler->chain != 0) {
        /* Nets are for samples that know nothing of each other. */
        const uint2 random = sampler_independent_words(sampler, address, is_partner);
        return sampler->is_large ? random : chain_words(sampler->chain, address, is_partner, random);
    }
#endif
    if (CLRT_SAMPLER == SAMPLER_INDEPENDENT)
        return sampler_independent_words(sampler, address, is_partner);
    return sampler_net_words(sampler, address, is_partner);
}

/* Its pairs and partners are drawn for vectors of paths, which a call would keep from being vectors. */
CLRT_INLINE uint2 sampler_pair_words(const Sampler* sampler, uint bounce, uint purpose)
{
    return sampler_words(sampler, sampler_address(bounce, purpose), false);
}

CLRT_INLINE uint2 sampler_partner_words(const Sampler* sampler, uint bounce, uint purpose)
{
    return sampler_words(sampler, sampler_address(bounce, purpose), true);
}

static inline real2 sampler_pair(const Sampler* sampler, uint bounce, uint purpose)
{
    const uint2 words = sampler_pair_words(sampler, bounce, purpose);
    return (real2)(sampler_unit(words.x), sampler_unit(words.y));
}

/* The words of a light sample at a vertex; the first one, where the camera looks, is number 1. Its light
   sample and the position on the film are one net, because together they place the edges of shadows. */
static inline uint2 sampler_light_words(const Sampler* sampler, uint vertex)
{
    const bool is_first = vertex == 1u;
    const uint address = is_first ? sampler_address(0u, SAMPLE_FILM) : sampler_address(vertex, SAMPLE_LIGHT);
    return sampler_words(sampler, address, is_first);
}

#endif
