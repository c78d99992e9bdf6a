// SPDX-License-Identifier: Apache-2.0
// How the inputs and models of the denoising filter lie: src/denoise/feature_filter.cpp writes them,
// kernels/denoise/regression.h reads them.
#ifndef CLRT_SHARED_DENOISE_TYPES_H
#define CLRT_SHARED_DENOISE_TYPES_H

#include "types.h"

/* A pixel's row, 16 floats; the first is not used. */
#define DENOISE_PLACE 1    /* column and row of the pixel over DENOISE_RADIUS */
#define DENOISE_ALBEDO 3   /* r, g, b */
#define DENOISE_NORMAL 6   /* x, y, z */
#define DENOISE_SHARE 9    /* of the samples that hit something; far more where a lamp is seen */
#define DENOISE_COLOURS 10 /* r, g, b of the first and of the second quarter */
#define DENOISE_ROW 16

/* Unknowns of a model: the colour at its pixel, then how it changes with place, albedo and normal, and with
   the distance from the plane of the pixel's surface. */
#define DENOISE_UNKNOWNS 10
#define DENOISE_MODEL 30   /* floats of a model: the unknowns of red, of green, of blue */

/* Pixels from the middle of a window to its border. */
#define DENOISE_RADIUS 8
/* A model is fitted at one pixel in so many, across and down. */
#define DENOISE_STRIDE 2

#endif
