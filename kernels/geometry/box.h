// SPDX-License-Identifier: Apache-2.0
// Conservative slab test: a ray that meets a triangle, in the arithmetic of triangle.h, meets its boxes.
#ifndef CLRT_GEOMETRY_BOX_H
#define CLRT_GEOMETRY_BOX_H

#include "ray.h"

/* Smallest |component| of a direction in slab tests: 1/d stays finite, and a ray within a face's plane is
   decided by the pad. */
#define BOX_SMALLEST_DIRECTION REAL(1e-18)

/* Units of u by which planes move out, as a share of reach = max(|origin|, extent). What must be met is the
   triangle as triangle.h sees it, with c = corner - origin sheared to x: off by at most u (2 |c_x| + 4 |c_z|)
   where divisions are exact and u (2 |c_x| + 8 |c_z|) where they are within 2.5 units in the last place; |c|
   <= 2 reach makes that 20. Rounding origin * reciprocal and adding the pad take 2 more, rounding their
   product with the exit factor and that of the reciprocal 2 more, second-order terms less than one. The
   reciprocal's own error is a share of the distance. */
#define BOX_PAD_ROUNDINGS REAL(26.0)

/* 1 + 2 gamma(7): entry and exit distances are each off by a share of up to 5 u for the reciprocal (2.5 units
   in the last place) and u for the fma (as in Ize 2013); the product of the ray's end with this factor takes
   u more. */
#define BOX_EXIT_FACTOR (REAL(1.0) + REAL(14.0) * REAL_ROUNDING * REAL(1.0000005))

/* Per-ray constants of a valid ray. A slab is entered at fma(near plane, reciprocal, entry_offset) and left
   at fma(far plane, exit_reciprocal, exit_offset), which is later by the exit factor: multiplying here spares
   every box test a multiplication that its result would wait for. A box is met within (0, t_max] if its
   largest entry distance is not beyond its smallest exit distance and t_max times the exit factor. */
typedef struct {
    real3 reciprocal, entry_offset;
    real3 exit_reciprocal, exit_offset;
} BoxRay;

/* Of a ray in the frame of the boxes, with planes moved out by `slack` along each axis. */
static inline BoxRay box_ray_make_slack(real3 origin, real3 direction, real3 slack)
{
    BoxRay box;
    const real3 clamped =
        copysign(max(fabs(direction), (real3)(BOX_SMALLEST_DIRECTION)), direction);
    box.reciprocal = REAL(1.0) / clamped;
    const real3 pad = fabs(box.reciprocal) * slack;
    const real3 offset = origin * box.reciprocal;
    box.entry_offset = -offset - pad;
    box.exit_reciprocal = box.reciprocal * BOX_EXIT_FACTOR;
    box.exit_offset = (pad - offset) * BOX_EXIT_FACTOR;
    return box;
}

/* The largest |coordinate| of a ray's origin and the scene. */
static inline real box_ray_reach(const Ray* ray, real scene_extent)
{
    const real3 o = fabs(ray->origin);
    return max(max(o.x, o.y), max(o.z, scene_extent));
}

/* With planes moved out by `roundings` units. */
static inline BoxRay box_ray_make_padded(const Ray* ray, real scene_extent, real roundings)
{
    const real reach = box_ray_reach(ray, scene_extent);
    return box_ray_make_slack(ray->origin, ray->direction, (real3)(roundings * FLOAT_ROUNDING * reach));
}

static inline BoxRay box_ray_make(const Ray* ray, real scene_extent)
{
    return box_ray_make_padded(ray, scene_extent, BOX_PAD_ROUNDINGS);
}

/* True for rays that may be traced: finite origin and direction, direction not zero. */
static inline bool ray_is_valid(const Ray* ray)
{
    return vector_is_finite(ray->origin) && vector_is_finite(ray->direction) &&
           !vector_is_zero(ray->direction) && ray->t_max > REAL(0.0);
}

#endif
