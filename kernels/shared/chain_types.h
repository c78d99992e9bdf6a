// SPDX-License-Identifier: Apache-2.0
// Markov chains of `mlt` (kernels/integrators/mlt.h): what one keeps, and what a launch of them needs.
#ifndef CLRT_SHARED_CHAIN_TYPES_H
#define CLRT_SHARED_CHAIN_TYPES_H

#include "types.h"

SHARED_BEGIN

/* Words that a chain keeps for each vertex of its path, and for the ends of it (numerics/chain.h). */
#define CHAIN_BOUNCE_WORDS 14u

/* The longest path whose words are kept, in segments. */
#define CHAIN_MAX_DEPTH 64

/* Chains have paths of two segments or more: one segment is the camera's ray, which needs no chain. */
#define CHAIN_SHORTEST 2u

/* What a chain is at, and what it has come by. */
typedef struct {
    float red, green, blue; /* radiance that the path brings, over the density of its random numbers */
    float score;            /* what chains visit paths in proportion to; 0: the chain stands still */
    float x, y;             /* film position (render_types.h) */
    u32 length;             /* of the path, segments; the same for ever */
    u32 steps;              /* proposals so far, */
    u32 large_steps;        /* those among them that were new paths, */
    u32 taken_small, taken_large; /* and how many of both kinds were taken */
    u32 unused0;
} Chain;
ASSERT_SIZE(Chain, 48);

/* What a launch does. */
#define CHAIN_FIND 0u  /* scores new paths */
#define CHAIN_START 1u /* starts every chain at one of them */
#define CHAIN_WALK 2u  /* takes the chains through samples first_sample .. first_sample + sample_count - 1 */

typedef struct {
    u32 task;      /* CHAIN_* */
    u32 chains;    /* of a replicate */
    u32 steps;     /* of a chain in one sample a pixel */
    u32 paths;     /* that are scored for a replicate and length */
    u32 lengths;   /* from CHAIN_SHORTEST on */
    u32 epoch;     /* keys all random numbers: chains of another one are others */
    u32 first;     /* path that the first work-item scores; they count through replicates, lengths, paths */
    u32 unused0;
} ChainLaunch;
ASSERT_SIZE(ChainLaunch, 32);

SHARED_END

#endif
