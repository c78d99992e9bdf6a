// SPDX-License-Identifier: Apache-2.0
// Letters of the path notation, and how the automaton of --paths lies in its table: src/paths writes it,
// kernels/path/automaton.h reads it.
#ifndef CLRT_SHARED_PATH_TYPES_H
#define CLRT_SHARED_PATH_TYPES_H

#include "types.h"

/* What a surface does to light: one letter a scattering event. */
#define LETTER_MATTE 0u      /* D */
#define LETTER_GLOSSY 1u     /* G: every lobe that is neither matte nor a delta function */
#define LETTER_MIRROR 2u     /* R: delta reflection, total reflection too */
#define LETTER_REFRACTION 3u /* T: delta refraction */
#define LETTER_COUNT 4u
#define LETTER_BIT(letter) (1u << (letter)) /* in a set of letters */

/* Where light comes from: bits, because a letter of the notation may mean several. */
#define KIND_AREA 1u         /* La: emissive triangles */
#define KIND_POINT 2u    /* Lp: point lights */
#define KIND_SUN 4u   /* Ld: suns, with or without a disc */
#define KIND_SKY 8u   /* Le: environment */
#define KINDS_ALL 15u

/* A state of the automaton is a word. 0 is the state that no path leaves: dead. */
#define STATE_DEAD 0u
#define STATE_NUMBER_MASK 0xffu   /* its number from 1: its row in the table */
#define STATES_LIMIT 255
#define STATE_KINDS_SHIFT 8u      /* kinds of light that end an accepted path there: KIND_*, four bits */
#define STATE_CONTINUES 0x1000u   /* a ray that leaves in this state can find light or go on */
#define STATE_SPLITS 0x2000u      /* matte and glossy lead to states that accept different paths */
#define STATE_DISTANCE_SHIFT 16u  /* above: fewest scattering events up to an accepting state */

/* Layers of paths, and KIND_* of layer i in bits 4i..4i+3. */
#define PATH_LAYERS_LIMIT 8
#define LAYER_KINDS_BITS 4u

SHARED_BEGIN

/* A state's row. Row 0, which is nobody's, leads to the state where paths start, by every letter. */
typedef struct {
    u32 next[LETTER_COUNT]; /* the state behind each letter, all its bits */
    u32 layers;             /* KIND_* that end a path of each layer there */
    u32 unused0, unused1, unused2;
} PathState;
ASSERT_SIZE(PathState, 32);

SHARED_END

#endif
