// SPDX-License-Identifier: Apache-2.0
// Instances: one mesh, the prototype, seen at the places to which affine maps put it.
//
// Triangles go to the ray: the corners are put to their places in the world by one rounded expression, and
// all that follows, test, distance, point and its error bound, is that of any other triangle of the world. So
// a corner that triangles share rounds alike in all of them, whatever the map; distances agree between
// instances and the scene; and an instance gives the bits of its triangles written out at these places. Only
// boxes are met in the prototype's frame, where the ray comes with a slack for all that rounds on its way.
#ifndef CLRT_GEOMETRY_INSTANCE_H
#define CLRT_GEOMETRY_INSTANCE_H

#include "box.h"
#include "shared/scene_types.h"

/* A coordinate of a prototype's point in the world, by a row of the map. traverse_bvh8.h has it eight
   wide. */
static inline real instance_coordinate(vec4 row, real3 p)
{
    return fma((real)row.x, p.x, fma((real)row.y, p.y, fma((real)row.z, p.z, (real)row.w)));
}

/* A prototype's point in the world. */
static inline real3 instance_point(global const Instance* instance, real3 p)
{
    return vector_make(instance_coordinate(instance->to_world[0], p),
                       instance_coordinate(instance->to_world[1], p),
                       instance_coordinate(instance->to_world[2], p));
}

/* A prototype's normal in the world, by the transpose of the inverse: unit, or 0 where it is 0. */
static inline real3 instance_normal(global const Instance* instance, real3 n)
{
    const real3 turned = n.x * vector_from(instance->to_prototype[0]) +
                         n.y * vector_from(instance->to_prototype[1]) +
                         n.z * vector_from(instance->to_prototype[2]);
    /* No square underflows or overflows. */
    const real largest = vector_max_abs(turned);
    return largest > REAL(0.0) ? vector_normalize(turned / largest) : turned;
}

/* A direction of the world in the prototype's frame. */
static inline real3 instance_direction(global const Instance* instance, real3 d)
{
    return vector_make(vector_dot(vector_from(instance->to_prototype[0]), d),
                       vector_dot(vector_from(instance->to_prototype[1]), d),
                       vector_dot(vector_from(instance->to_prototype[2]), d));
}

/* By how much the planes of a prototype's boxes move out along an axis. Let W be the inverse of the map's
   linear part M, T what the map adds, s = sum_j |W_ij| along axis i, and D = max_j |o - T|_j +
   max_j (|M| |p|)_j, which bounds every coordinate of corner - origin, and of t d where a triangle is met. In
   units of u s:
   - the triangle as triangle.h sees it is off the rounded corners by 10 D (box.h, with |c| <= D);
   - the corners are off M p + T by three roundings of at most E = max_j (|M| |p| + |T|)_j: 3 E;
   - o - T rounds by D, W by D, three products and sums of W (o - T) by 3 D, and of t W d by 4 D with W's;
   - the slab test takes the 5 roundings of box.h, of coordinates up to D, and cwbvh's lattice 3 more: 8 D.
   That is 27 D + 3 E; what is of second order is in 30 D + 4 E. INSTANCE_SLACK holds the part that is the
   same for all rays, s (30 max_j (|M| |p|)_j + 4 E). */
#define INSTANCE_PAD_ROUNDINGS REAL(30.0)

/* What rounds along an axis of the prototype, for an origin `distance` away. */
static inline real instance_slack(vec4 row, real distance)
{
    const real sum = fabs((real)row.x) + fabs((real)row.y) + fabs((real)row.z);
    return FLOAT_ROUNDING * fma(INSTANCE_PAD_ROUNDINGS * distance, sum, (real)INSTANCE_SLACK(row));
}

/* The ray as the boxes of an instance's prototype see it. Distances along it are those in the world. */
static inline BoxRay instance_box_ray(global const Instance* instance, const Ray* ray)
{
    const real3 middle = vector_make((real)instance->to_world[0].w, (real)instance->to_world[1].w,
                                     (real)instance->to_world[2].w);
    const real3 way = ray->origin - middle;
    const real distance = vector_max_abs(way);
    const real3 slack = vector_make(instance_slack(instance->to_prototype[0], distance),
                                    instance_slack(instance->to_prototype[1], distance),
                                    instance_slack(instance->to_prototype[2], distance));
    return box_ray_make_slack(instance_direction(instance, way),
                              instance_direction(instance, ray->direction), slack);
}

#endif
