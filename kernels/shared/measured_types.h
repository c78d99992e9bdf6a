// SPDX-License-Identifier: Apache-2.0
// Measured isotropic BRDFs: tables over Rusinkiewicz's half and difference angles (1998), as in the MERL
// database (Matusik et al. 2003), and by what directions are sampled (scattering/bsdf_measured.h).
#ifndef CLRT_SHARED_MEASURED_TYPES_H
#define CLRT_SHARED_MEASURED_TYPES_H

#include "types.h"

SHARED_BEGIN

/* Half vectors are sampled by cells of their angle to the normal: cell i begins at (i / MEASURED_CELLS)^2 of
   a right angle. */
#define MEASURED_CELLS 90u

/* Directions to the eye that have tables: the cosine of number i is (i / (MEASURED_VIEWS - 1))^2. */
#define MEASURED_VIEWS 16u

/* How light is sampled that leaves along one direction. */
typedef struct {
    vec4 albedo; /* rgb: share of light from everywhere that it sends there; w: MEASURED_COSINE_SHARE */
    float density[MEASURED_CELLS]; /* of half vectors, per steradian, times the share that they sample */
    float cumulative[MEASURED_CELLS]; /* probability of the cells up to this one; the last: 1 */
} MeasuredView;
ASSERT_SIZE(MeasuredView, 736);

#define MEASURED_COSINE_SHARE(view) ((view).albedo.w) /* of directions that a cosine lobe samples */

/* One BRDF, in an array of words, at a multiple of four of them. Its values follow: three halves each, r, g
   and b times `scale` per steradian, two halves to a word, the first in the lower bits. They lie at the
   middles of equal steps of sqrt(half angle), of the difference angle, both up to a right angle, and of the
   difference's azimuth from 0 to pi; the last runs fastest. */
typedef struct {
    u32 half_count, difference_count, azimuth_count;
    float scale; /* a power of two */
    MeasuredView views[MEASURED_VIEWS];
} MeasuredBrdf;
ASSERT_SIZE(MeasuredBrdf, 11792);

SHARED_END

#endif
