// SPDX-License-Identifier: Apache-2.0
// Watertight ray-triangle test (Woop, Benthin and Wald 2013, JCGT 2(1)): corners are sheared so that the ray
// runs along an axis, a corner shared by triangles rounds alike in all of them, and the sign of each edge
// function is exact (differences of products after Kahan), so a ray cannot slip between two triangles. Ties
// count as inside.
#ifndef CLRT_GEOMETRY_TRIANGLE_H
#define CLRT_GEOMETRY_TRIANGLE_H

#include "ray.h"

/* Per-ray constants. kz is the axis along which the direction is longest; kx and ky are the others in cyclic
   order. */
typedef struct {
    uint kx, ky, kz;
    real ox, oy, oz; /* origin, permuted */
    real sx, sy, sz;
} RayShear;

/* The components kx, ky, kz of a vector. Selects among vectors: compilers make branches of a choice among
   scalars, and no processor predicts along which axis a ray is longest. */
static inline real3 ray_permuted(real3 v, uint kz)
{
    const real3 axis = (real3)((real)kz);
    return axis == REAL(0.0) ? v.yzx : (axis == REAL(1.0) ? v.zxy : v);
}

static inline RayShear ray_shear_make(const Ray* ray)
{
    const real3 d = ray->direction;
    const real3 a = fabs(d);
    RayShear shear;
    shear.kz = a.x > a.y ? (a.x > a.z ? 0u : 2u) : (a.y > a.z ? 1u : 2u);
    shear.kx = shear.kz == 2u ? 0u : shear.kz + 1u;
    shear.ky = shear.kx == 2u ? 0u : shear.kx + 1u;
    const real3 origin = ray_permuted(ray->origin, shear.kz);
    const real3 permuted = ray_permuted(d, shear.kz);
    shear.ox = origin.x;
    shear.oy = origin.y;
    shear.oz = origin.z;
    shear.sz = REAL(1.0) / permuted.z;
    shear.sx = permuted.x * shear.sz;
    shear.sy = permuted.y * shear.sz;
    return shear;
}

/* The test's arithmetic for one triangle or eight: one text for both widths, so that every layout computes
   the same bits. Corners in permuted axes; u, v, w are the edge functions (weights of corners 0, 1, 2 times
   det), t_det is the distance times det. The ray meets the triangle's plane inside when u, v, w have no two
   different signs and det is not 0. */
#define TRIANGLE_DEFINE(NAME, REALN)                                                                         \
    static inline void NAME(const RayShear* ray, const REALN* x, const REALN* y, const REALN* z, REALN* u,   \
                            REALN* v, REALN* w, REALN* det, REALN* t_det)                                    \
    {                                                                                                        \
        /* Move the origin to the ray's, shear the ray onto the axis. */                                     \
        const REALN az = z[0] - ray->oz;                                                                     \
        const REALN bz = z[1] - ray->oz;                                                                     \
        const REALN cz = z[2] - ray->oz;                                                                     \
        const REALN ax = fma((REALN)(-ray->sx), az, x[0] - ray->ox);                                         \
        const REALN ay = fma((REALN)(-ray->sy), az, y[0] - ray->oy);                                         \
        const REALN bx = fma((REALN)(-ray->sx), bz, x[1] - ray->ox);                                         \
        const REALN by = fma((REALN)(-ray->sy), bz, y[1] - ray->oy);                                         \
        const REALN cx = fma((REALN)(-ray->sx), cz, x[2] - ray->ox);                                         \
        const REALN cy = fma((REALN)(-ray->sy), cz, y[2] - ray->oy);                                         \
        /* Edge functions with exact signs. */                                                               \
        const REALN cybx = cy * bx;                                                                          \
        const REALN aycx = ay * cx;                                                                          \
        const REALN byax = by * ax;                                                                          \
        *u = fma(cx, by, -cybx) + fma(-cy, bx, cybx);                                                        \
        *v = fma(ax, cy, -aycx) + fma(-ay, cx, aycx);                                                        \
        *w = fma(bx, ay, -byax) + fma(-by, ax, byax);                                                        \
        *det = *u + *v + *w;                                                                                 \
        *t_det = ray->sz * fma(*u, az, fma(*v, bz, *w * cz));                                                \
    }

TRIANGLE_DEFINE(triangle_edges, real)
TRIANGLE_DEFINE(triangle_edges_8, real8)

#endif
