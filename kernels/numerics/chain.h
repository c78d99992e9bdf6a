// SPDX-License-Identifier: Apache-2.0
// The random numbers of a Markov chain in primary sample space (Kelemen et al. 2002): a chain keeps the words
// that made its path; a proposal moves each of them a little. Words wrap around, as the unit interval that
// they stand for should, and a step is as probable as the one back. A proposal is a function of the chain and
// of its sampler's keys: nothing is stored before it is taken. Included by sampler.h.
#ifndef CLRT_NUMERICS_CHAIN_H
#define CLRT_NUMERICS_CHAIN_H

#include "shared/chain_types.h"

/* Steps have a size between 2^-CHAIN_SMALLEST_STEP and 2^(CHAIN_STEP_OCTAVES - CHAIN_SMALLEST_STEP), every
   octave with the same probability: small ones keep to narrow lights, large ones leave them (Kelemen's
   1/1024 to 1/64). */
#define CHAIN_SMALLEST_STEP 10u
#define CHAIN_STEP_OCTAVES 4u

/* Where a chain keeps the words of a bounce and purpose; a pair's lie one behind the other, its partner's
   behind them. */
static inline uint chain_place(uint bounce, uint purpose)
{
    uint place = 0u; /* SAMPLE_FILM at bounce 0, SAMPLE_DIRECTION behind it */
    switch (purpose) {
    case SAMPLE_LIGHT: place = 4u; break;
    case SAMPLE_LENS: place = 6u; break;
    case SAMPLE_TIME: place = 8u; break;
    case SAMPLE_LIGHT_ALIAS: place = 10u; break;
    case SAMPLE_COVERAGE: place = 11u; break;
    case SAMPLE_SPLAT: place = 12u; break;
    case SAMPLE_STRATEGY: place = 13u; break;
    }
    return CHAIN_BOUNCE_WORDS * bounce + place;
}

/* A word of the chain, moved by a step that a random word chooses: octave and sign by its upper bits. */
static inline uint chain_word(global const uint* chain, uint place, uint random)
{
    const uint shift = 32u - CHAIN_SMALLEST_STEP + (random >> 30);
    const uint smallest = 1u << shift;
    const uint step = smallest + ((random << 3) >> (32u - shift));
    return chain[place] + ((random & 0x20000000u) ? step : 0u - step);
}

/* The same for a pair. */
static inline uint2 chain_words(global const uint* chain, uint address, bool is_partner, uint2 random)
{
    const uint place = chain_place(address / SAMPLER_PURPOSES, address % SAMPLER_PURPOSES) + (is_partner ? 2u : 0u);
    return (uint2)(chain_word(chain, place, random.x), chain_word(chain, place + 1u, random.y));
}

#endif
