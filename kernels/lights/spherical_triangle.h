// SPDX-License-Identifier: Apache-2.0
// Triangles as seen from a point: their solid angle, and points on them whose directions are uniform in it.
#ifndef CLRT_LIGHTS_SPHERICAL_TRIANGLE_H
#define CLRT_LIGHTS_SPHERICAL_TRIANGLE_H

#include "geometry/surface.h"
#include "numerics/real_functions.h"

/* Triangles that look smaller than SMALLEST are sampled by area, which is nearly as good there and cheaper.
   So are those that fill all but 1e-2 of a half space: the point is in their plane but for roundings, which
   decide the angle. */
#define SPHERICAL_TRIANGLE_SMALLEST REAL(0.25)
#define SPHERICAL_TRIANGLE_LARGEST REAL(6.27)

/* A triangle seen from a point; a, b, c are the unit vectors to its corners. */
typedef struct {
    real3 lengths;    /* distances of the corners */
    real volume;      /* |det(a, b, c)| */
    real apex;        /* c . (a + b) */
    real base;        /* 1 + a . b */
    real opening;     /* 1 + c . a */
    real solid_angle; /* 0 where points are to be chosen by area */
} SphericalTriangle;

/* Tells triangles that need a look at their solid angle from those that are far: farther than their longer
   edge and, as a small triangle at its centroid would be, smaller than SMALLEST. p0 is relative to the point;
   `normal` as below. */
static inline bool spherical_triangle_is_near(real3 p0, real3 e1, real3 e2, real3 normal)
{
    const real3 centroid = p0 + (e1 + e2) * REAL(0.33333333);
    const real square = vector_dot(centroid, centroid);
    const real scale = REAL(0.5) / (SURFACE_EDGE_SCALE * SURFACE_EDGE_SCALE);
    const real volume = fabs(vector_dot(p0, normal)) * scale;
    return volume > SPHERICAL_TRIANGLE_SMALLEST * square * real_sqrt(square) ||
           square < fmax(vector_dot(e1, e1), vector_dot(e2, e2));
}

/* `p0`, `p1`, `p2` are the corners relative to the point, `normal` is surface_cross of the edges. The solid
   angle is 2 atan2(volume, base + apex) (van Oosterom and Strackee 1983). */
static CLRT_NOINLINE SphericalTriangle spherical_triangle_make(real3 p0, real3 p1, real3 p2, real3 normal)
{
    SphericalTriangle seen;
    const real3 squares = (real3)(vector_dot(p0, p0), vector_dot(p1, p1), vector_dot(p2, p2));
    seen.lengths = real_sqrt(squares);
    seen.solid_angle = REAL(0.0);
    const real product = seen.lengths.x * seen.lengths.y * seen.lengths.z;
    if (product == REAL(0.0))
        return seen;
    /* By the nearest corner: its roundings weigh least. */
    const bool is_first = squares.x < squares.y && squares.x < squares.z;
    const real3 nearest = is_first ? p0 : (squares.y < squares.z ? p1 : p2);
    const real scale = REAL(1.0) / (SURFACE_EDGE_SCALE * SURFACE_EDGE_SCALE);
    seen.volume = fabs(vector_dot(nearest, normal)) * scale / product;
    /* Sums of unit vectors, so that nothing cancels where corners are nearly opposite. */
    const real3 a = p0 / seen.lengths.x;
    const real3 c = p2 / seen.lengths.z;
    const real3 ab = a + p1 / seen.lengths.y;
    const real3 ca = c + a;
    seen.apex = vector_dot(c, ab);
    seen.base = REAL(0.5) * vector_dot(ab, ab);
    seen.opening = REAL(0.5) * vector_dot(ca, ca);
    /* Half the angle is less than its tangent. */
    const real cotangent = seen.base + seen.apex;
    if (seen.volume < (REAL(0.5) * SPHERICAL_TRIANGLE_SMALLEST) * cotangent)
        return seen;
    const real solid_angle = REAL(2.0) * real_atan2(seen.volume, cotangent);
    if (solid_angle >= SPHERICAL_TRIANGLE_SMALLEST && solid_angle <= SPHERICAL_TRIANGLE_LARGEST)
        seen.solid_angle = solid_angle;
    return seen;
}

/* Barycentric weights of corners 1 and 2 of the point whose direction u stands for; uniform in solid angle.
   After Arvo (1995): u.x cuts off a triangle a b d of that share of the angle, d on the arc from a to c; u.y
   is the share of 1 - cos along the arc from b to d. Without its angles (after Peters 2021): the middle of a
   and d is x a + y c. All directions come as sums of the corners' with weights >= 0, so no rounding leaves
   the triangle. */
static CLRT_NOINLINE real2 spherical_triangle_sample(const SphericalTriangle* seen, real2 u)
{
    const real2 sc = real_sin_cos_turn(u.x * seen->solid_angle * (REAL(0.25) * REAL_INVERSE_PI));
    const real y = seen->base * sc.x;
    const real difference = fmax(seen->volume * sc.y - seen->apex * sc.x - y, REAL(0.0)); /* x - y */
    const real squares = fma(difference, difference, REAL(2.0) * y * (y + difference) * seen->opening);
    /* d = (to_a a + to_c c) / squares, and 1 + b . d = volume^2 base / squares. */
    const real to_a = difference * (difference + REAL(2.0) * y);
    const real to_c = REAL(2.0) * y * fma(y, seen->opening, difference);
    const real rest = seen->volume * seen->volume * seen->base / squares;
    /* The direction is (1 - v (1 - b . d) - t b . d) b + t d. */
    const real t = real_sqrt(u.y * fma(u.y, rest, REAL(2.0) * (REAL(1.0) - u.y)) / rest);
    const real to_b = fmax(REAL(1.0) - t + (REAL(2.0) - rest) * (t - u.y), REAL(0.0));
    /* Where its line meets the plane. */
    const real w0 = t * to_a / (squares * seen->lengths.x);
    const real w1 = to_b / seen->lengths.y;
    const real w2 = t * to_c / (squares * seen->lengths.z);
    return (real2)(w1, w2) / (w0 + w1 + w2);
}

#endif
