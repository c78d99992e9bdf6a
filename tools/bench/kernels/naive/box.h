// SPDX-License-Identifier: Apache-2.0
// Plain slab test in place of geometry/box.h: nothing accounts for rounding. For comparison only.
#ifndef CLRT_GEOMETRY_BOX_H
#define CLRT_GEOMETRY_BOX_H

#include "geometry/ray.h"

/* Smallest |component| of a direction: 1/d stays finite, as the traversals' min and max want. */
#define BOX_SMALLEST_DIRECTION REAL(1e-18)

#define BOX_EXIT_FACTOR REAL(1.0)

/* Per-ray constants of a valid ray: distance to a plane = fma(plane, reciprocal, entry or exit). */
typedef struct {
    real3 reciprocal;
    real3 entry;
    real3 exit;
} BoxRay;

static inline BoxRay box_ray_make(const Ray* ray, real scene_extent)
{
    BoxRay box;
    const real3 d = ray->direction;
    box.reciprocal = REAL(1.0) / copysign(max(fabs(d), (real3)(BOX_SMALLEST_DIRECTION)), d);
    box.entry = -ray->origin * box.reciprocal;
    box.exit = box.entry;
    return box;
}

/* True for rays that may be traced: finite origin and direction, direction not zero. */
static inline bool ray_is_valid(const Ray* ray)
{
    return vector_is_finite(ray->origin) && vector_is_finite(ray->direction) &&
           !vector_is_zero(ray->direction) && ray->t_max > REAL(0.0);
}

#endif
