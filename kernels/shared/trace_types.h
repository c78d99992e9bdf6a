// SPDX-License-Identifier: Apache-2.0
// The record of one sample: events in the order of evaluation, each a quantity and up to three values.
// Kernels built with -DCLRT_TRACE write it (kernels/trace), src/replay reads it.
#ifndef CLRT_SHARED_TRACE_TYPES_H
#define CLRT_SHARED_TRACE_TYPES_H

#include "types.h"

/* Choices: integers that decide how the path goes on. */
#define TRACE_VERTEX 1u        /* a vertex: bounce from 1, its ray's number in a tree of rays (else 0) */
#define TRACE_TRIANGLE 2u      /* hit; NO_INDEX: none */
#define TRACE_FRONT 3u         /* 1: seen from the front */
#define TRACE_LOBE 4u          /* chosen: LOBE_*, TRACE_LOBE_REFRACTS */
#define TRACE_CONTINUES 5u     /* 1: the sampled direction is worth a ray */
#define TRACE_STATE 6u         /* of the automaton of --paths behind the event */
#define TRACE_SURVIVES 7u      /* 1: Russian roulette goes on */
#define TRACE_WAITING 8u       /* rays of a tree that are still to be traced */
#define TRACE_LIGHT_KIND 9u    /* KIND_* of the sampled light; 0: none found */
#define TRACE_CONNECTS 10u     /* 1: the light would arrive */
#define TRACE_VISIBLE 11u      /* 1: and does, at least in part */
#define TRACE_CUT 12u          /* 1: only max_depth ends the path here, or the lobes that it forbids */
#define TRACE_CHOICES_END 16u

/* Quantities: real numbers, one to three. */
#define TRACE_RAY_ORIGIN 16u
#define TRACE_RAY_DIRECTION 17u
#define TRACE_DISTANCE 18u     /* t of the hit */
#define TRACE_BARYCENTRIC 19u  /* weights of corners 1 and 2, and 0 */
#define TRACE_POSITION 20u
#define TRACE_NORMAL_G 21u
#define TRACE_NORMAL_S 22u
#define TRACE_OFFSET 23u       /* bound by which rays leave the surface */
#define TRACE_EMITTED 24u      /* radiance of the surface */
#define TRACE_SKY 25u          /* radiance from outside the scene, weighted */
#define TRACE_ADDED 26u        /* to the sample's radiance */
#define TRACE_WI 27u           /* sampled direction */
#define TRACE_WEIGHT 28u       /* BSDF times cosine over pdf */
#define TRACE_PDF 29u          /* per steradian; 0 for a delta lobe */
#define TRACE_ETA 30u          /* relative index crossed */
#define TRACE_THROUGHPUT 31u
#define TRACE_SURVIVAL 32u     /* probability of Russian roulette */
#define TRACE_LIGHT_DIRECTION 33u
#define TRACE_LIGHT_RADIANCE 34u
#define TRACE_LIGHT_PDF 35u
#define TRACE_LIGHT_BSDF 36u   /* BSDF times cosine towards the light */
#define TRACE_LIGHT_BSDF_PDF 37u
#define TRACE_LIGHT_WEIGHT 38u /* of multiple importance sampling */
#define TRACE_CONNECTION 39u   /* what arrives if nothing is in between */
#define TRACE_SHARE 40u        /* share of it that is not blocked */
#define TRACE_RADIANCE 41u     /* of the whole sample */
#define TRACE_LAYER 42u        /* of one layer of paths */
#define TRACE_QUANTITIES 43u

/* Values of TRACE_LOBE: those of LOBE_*, with this bit where the lobe refracts. */
#define TRACE_LOBE_REFRACTS 0x10000u

/* A record: a head of words, then events. Words are 64 bits wide, so that a double fits; a float lies in the
   low half. */
#define TRACE_HEAD_WORDS 8u
#define TRACE_HEAD_COUNT 0u     /* events of the sample; more than fit are only counted */
#define TRACE_HEAD_DECISIONS 1u /* hash of all choices */
#define TRACE_HEAD_FAULT 2u     /* COUNT_* that the film counts it under, COUNT_WORDS if it is good */
#define TRACE_HEAD_FILM 3u      /* three sums that the film gets, in quanta */
#define TRACE_EVENT_WORDS 4u    /* quantity, three values */

/* The buffer of addresses: these words, then some of each sample. */
#define TRACE_ADDRESS_COUNT 0u
#define TRACE_ADDRESS_CAPACITY 1u /* events a record has room for */
#define TRACE_ADDRESS_FIRST 2u
#define TRACE_ADDRESS_WORDS 3u
#define TRACE_ADDRESS_PIXEL 0u    /* y width + x */
#define TRACE_ADDRESS_SAMPLE 1u
#define TRACE_ADDRESS_EMISSION 2u /* EMISSION_*, whence the emission comes that the pixel sees */

#endif
