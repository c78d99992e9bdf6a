// SPDX-License-Identifier: Apache-2.0
// What a pilot sums besides the picture (kernels/film/moments.h).
#ifndef CLRT_SHARED_MOMENT_TYPES_H
#define CLRT_SHARED_MOMENT_TYPES_H

#include "types.h"

/* Planes of the film behind the replicates. Squares are of channels. */
#define MOMENTS_GATHERED 0  /* radiance of the paths from the eye, as weighted against others */
#define MOMENTS_SPLATTED 1  /* squares: of what such a path gathers, and of each splat */
#define MOMENTS_ALONE 2     /* squares of what a path from the eye would gather alone */
#define MOMENTS_RAYS 3      /* counts: rays of paths from the lights, from them to the camera, between both */
#define MOMENTS_HIDDEN 4    /* radiance of lamps behind slabs that nothing but hits finds, as path finds it */
#define MOMENTS_MISSED 5    /* and by how much more the squares of those hits are */
#define MOMENTS_PLANES 6

/* A square of 2^12 squared quanta counts 1: of the level, the power of two nearest the mean radiance
   (film/film.h), a square is told to 2^-28. */
#define MOMENT_UNIT 4096.0f
/* One addition at most, so that 32 of them fit a sum: the square of 2^15 levels. */
#define MOMENT_LARGEST 2.8823037615171174e17f /* 2^58 */

#endif
