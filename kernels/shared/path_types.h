// SPDX-License-Identifier: Apache-2.0
// Letters of the path notation, and how the automaton of --paths lies in its tables: src/paths writes them,
// kernels/path/automaton.h reads them.
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

/* A state is a number from 1; 0 is the state that no path leaves: dead. One word a state holds its
   successors, eight bits a letter, from LETTER_MATTE in the lowest. */
#define STATE_DEAD 0u
#define STATE_START 1u
#define STATES_LIMIT 255
#define NEXT_STATE_BITS 8u
#define NEXT_STATE_MASK 0xffu

/* Another word a state holds what can be done there. */
#define STATE_KINDS_MASK 0xfu     /* kinds of light that end an accepted path: KIND_* */
#define STATE_CONTINUES 0x10u     /* a ray that leaves in this state can find light or go on */
#define STATE_SPLITS 0x20u        /* matte and glossy lead to states that accept different paths */
#define STATE_DISTANCE_SHIFT 8u   /* above: fewest scattering events up to an accepting state */

/* The third word, where layers are wanted: KIND_* of layer i in bits 4i..4i+3. */
#define PATH_LAYERS_LIMIT 8
#define LAYER_KINDS_BITS 4u

#endif
