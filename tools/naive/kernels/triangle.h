// SPDX-License-Identifier: Apache-2.0
// The ray-triangle test of Moeller and Trumbore (1997) in place of geometry/triangle.h: an edge shared by two triangles
// rounds differently in each, so rays slip through. For comparison only.
#ifndef CLRT_GEOMETRY_TRIANGLE_H
#define CLRT_GEOMETRY_TRIANGLE_H

#include "geometry/ray.h"

/* Per-ray constants. Axes are not permuted: kx, ky, kz are x, y, z. */
typedef struct {
    uint kx, ky, kz;
    real ox, oy, oz;
    real dx, dy, dz;
} RayShear;

/* The components kx, ky, kz: the axes stay as they are. */
static inline real3 ray_permuted(real3 v, uint kz)
{
    (void)kz;
    return v;
}

static inline RayShear ray_shear_make(const Ray* ray)
{
    RayShear shear;
    shear.kx = 0u;
    shear.ky = 1u;
    shear.kz = 2u;
    shear.ox = ray->origin.x;
    shear.oy = ray->origin.y;
    shear.oz = ray->origin.z;
    shear.dx = ray->direction.x;
    shear.dy = ray->direction.y;
    shear.dz = ray->direction.z;
    return shear;
}

/* One triangle or eight; gives what geometry/triangle.h gives: weights of the corners times det, distance times det. */
#define TRIANGLE_DEFINE(NAME, REALN)                                                                          \
    static inline void NAME(const RayShear* ray, const REALN* x, const REALN* y, const REALN* z, REALN* u,    \
                            REALN* v, REALN* w, REALN* det, REALN* t_det)                                     \
    {                                                                                                         \
        const REALN e1x = x[1] - x[0], e1y = y[1] - y[0], e1z = z[1] - z[0];                                  \
        const REALN e2x = x[2] - x[0], e2y = y[2] - y[0], e2z = z[2] - z[0];                                  \
        const REALN px = ray->dy * e2z - ray->dz * e2y;                                                       \
        const REALN py = ray->dz * e2x - ray->dx * e2z;                                                       \
        const REALN pz = ray->dx * e2y - ray->dy * e2x;                                                       \
        const REALN tx = ray->ox - x[0], ty = ray->oy - y[0], tz = ray->oz - z[0];                            \
        const REALN qx = ty * e1z - tz * e1y;                                                                 \
        const REALN qy = tz * e1x - tx * e1z;                                                                 \
        const REALN qz = tx * e1y - ty * e1x;                                                                 \
        *det = e1x * px + e1y * py + e1z * pz;                                                                \
        *v = tx * px + ty * py + tz * pz;                                                                     \
        *w = ray->dx * qx + ray->dy * qy + ray->dz * qz;                                                      \
        *u = *det - *v - *w;                                                                                  \
        *t_det = e2x * qx + e2y * qy + e2z * qz;                                                              \
    }

TRIANGLE_DEFINE(triangle_edges, real)
TRIANGLE_DEFINE(triangle_edges_8, real8)

#endif
