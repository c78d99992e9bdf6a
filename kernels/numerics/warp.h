// SPDX-License-Identifier: Apache-2.0
// Maps from the unit square to discs, hemispheres, cones and triangles, each with its density.
#ifndef CLRT_NUMERICS_WARP_H
#define CLRT_NUMERICS_WARP_H

#include "sampler.h"
#include "vector.h"

/* Uniform point of the unit disc by concentric squares (Shirley and Chiu 1997). */
static inline real2 warp_disc(real2 u)
{
    const real a = fma(REAL(2.0), u.x, REAL(-1.0));
    const real b = fma(REAL(2.0), u.y, REAL(-1.0));
    const bool wide = fabs(a) > fabs(b);
    const real radius = wide ? a : b;
    /* Both are zero only at the centre, which no sampler value maps to; radius 0 gives the centre anyway. */
    const real ratio = radius != REAL(0.0) ? (wide ? b : a) / radius : REAL(0.0);
    const real2 sc = real_sin_cos_quarter(ratio * (REAL_PI * REAL(0.25)));
    return wide ? (real2)(radius * sc.y, radius * sc.x) : (real2)(radius * sc.x, radius * sc.y);
}

/* Direction with density cos / pi around +z (Malley's method). */
static inline real3 warp_cosine_hemisphere(real2 u)
{
    const real2 d = warp_disc(u);
    return vector_make(d.x, d.y, real_root(REAL(1.0) - fma(d.x, d.x, d.y * d.y)));
}

static inline real warp_cosine_hemisphere_pdf_w(real cos_theta)
{
    return fmax(cos_theta, REAL(0.0)) * REAL_INVERSE_PI;
}

/* Uniform direction of the upper hemisphere. */
static inline real3 warp_hemisphere(real2 u)
{
    const real sin_theta = real_root((REAL(1.0) - u.x) * (REAL(1.0) + u.x));
    const real2 sc = real_sin_cos_turn(u.y);
    return vector_make(sin_theta * sc.y, sin_theta * sc.x, u.x);
}

static inline real warp_hemisphere_pdf_w(void) { return REAL(0.5) * REAL_INVERSE_PI; }

/* Uniform direction within a cone around +z; `one_minus_cos` belongs to its half angle. */
static inline real3 warp_cone(real2 u, real one_minus_cos)
{
    const real h = u.x * one_minus_cos; /* 1 - cos of the direction's angle */
    const real sin_theta = real_root(h * (REAL(2.0) - h));
    const real2 sc = real_sin_cos_turn(u.y);
    return vector_make(sin_theta * sc.y, sin_theta * sc.x, REAL(1.0) - h);
}

static inline real warp_cone_pdf_w(real one_minus_cos)
{
    return REAL(1.0) / (REAL(2.0) * REAL_PI * one_minus_cos);
}

/* Barycentric weights of corners 1 and 2 of a uniform point of a triangle (Heitz 2019, low distortion). */
static inline real2 warp_triangle(real2 u)
{
    /* Half of the smaller coordinate is one weight, the rest of the larger the other. */
    const real half_smaller = REAL(0.5) * min(u.x, u.y);
    return u - (real2)(half_smaller);
}

/* An index below count from a word, each with the probability of its share of 2^32. */
static inline uint warp_index(uint word, uint count) { return mul_hi(word, count); }

/* The word that is left of a word after warp_index took its share; `fill` replaces the digits that a large
   count has used up. */
static inline uint warp_rest_word(uint word, uint count, uint fill)
{
    return word * count + mul_hi(fill, count);
}

/* The same as a number in (0, 1). */
static inline real warp_rest(uint word, uint count, uint fill)
{
    return sampler_unit(warp_rest_word(word, count, fill));
}

#endif
