// SPDX-License-Identifier: Apache-2.0
// How the sums over the primary hits of a pixel lie: kernels/integrators/aov.cl makes them,
// src/render/hit_layers.cpp adds them up.
#ifndef CLRT_SHARED_AOV_TYPES_H
#define CLRT_SHARED_AOV_TYPES_H

#include "types.h"

SHARED_BEGIN

/* 64-bit sums in fixed point. */
#define AOV_ALBEDO 0u   /* r, g, b */
#define AOV_NORMAL 3u   /* x, y, z: for shading, unit */
#define AOV_POSITION 6u /* x, y, z: normalised frame, within 2 of its origin; on a ground within 64 */
#define AOV_EMISSION 9u /* luminance that is emitted towards the camera, over AOV_EMISSION_UNIT */
#define AOV_SUMS 10u

/* 32-bit words. */
#define AOV_HITS 0u     /* samples that hit something */
#define AOV_OBJECT 1u   /* of the first of them */
#define AOV_MATERIAL 2u
#define AOV_WORDS 3u

/* Mattes: how many samples see which object and which material first. The first MATTE_SLOTS of each kind that
   a pixel's samples come to have a slot, two more than are written; more would cost memory for what is a few
   percent of a pixel. */
#define MATTE_OBJECTS 0u
#define MATTE_MATERIALS 1u
#define MATTE_SLOTS 8u
#define MATTE_INDEX 0u   /* words of a slot: object or material */
#define MATTE_SAMPLES 1u /* 0: the slot is free */
#define MATTE_SLOT_WORDS 2u
#define MATTE_KIND_WORDS (MATTE_SLOT_WORDS * MATTE_SLOTS)
#define MATTE_WORDS (2u * MATTE_KIND_WORDS)

/* One in fixed point is 2^AOV_BITS: floats from 2^-7 on are exact. Values are below 64, so that 2^26 samples
   fit, more than a film of 64 replicates holds. */
#define AOV_BITS 31
#define AOV_LARGEST 64
/* Of emission: lamps are bright, and faint ones count for nothing. */
#define AOV_EMISSION_UNIT 65536

SHARED_END

#endif
