// SPDX-License-Identifier: Apache-2.0
// Orthonormal frames: local z is the normal.
#ifndef CLRT_NUMERICS_FRAME_H
#define CLRT_NUMERICS_FRAME_H

#include "vector.h"

typedef struct {
    real3 x, y, z;
} Frame;

/* A frame around the unit vector n (Duff et al. 2017, JCGT 6(1)); continuous but at n.z = 0, valid for -0. */
static inline Frame frame_make(real3 n)
{
    const real sign = copysign(REAL(1.0), n.z);
    const real a = REAL(-1.0) / (sign + n.z);
    const real b = n.x * n.y * a;
    Frame frame;
    frame.x = vector_make(fma(sign * n.x * n.x, a, REAL(1.0)), sign * b, -sign * n.x);
    frame.y = vector_make(b, fma(n.y * n.y, a, sign), -n.y);
    frame.z = n;
    return frame;
}

/* A frame around n whose x axis is the part of t across n; frame_make(n) where t is zero or along n. By cross
   products: they keep their digits where t is nearly along n, where t - (t . n) n would cancel. */
static inline Frame frame_make_tangent(real3 n, real3 t)
{
    const real3 beside = vector_cross(n, t);
    const real length_squared = vector_dot(beside, beside);
    /* Below this share of |t| the direction across n is rounding noise of t itself. */
    const real noise = REAL(16.0) * REAL_ROUNDING;
    if (!(length_squared > noise * noise * vector_dot(t, t)))
        return frame_make(n);
    Frame frame;
    frame.y = beside / real_sqrt(length_squared);
    frame.x = vector_cross(frame.y, n);
    frame.z = n;
    return frame;
}

static inline real3 frame_to_local(const Frame* frame, real3 v)
{
    return vector_make(vector_dot(v, frame->x), vector_dot(v, frame->y), vector_dot(v, frame->z));
}

static inline real3 frame_to_world(const Frame* frame, real3 v)
{
    return v.x * frame->x + v.y * frame->y + v.z * frame->z;
}

#endif
