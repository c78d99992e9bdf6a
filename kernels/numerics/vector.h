// SPDX-License-Identifier: Apache-2.0
// Three-component vectors. Own dot and cross products: the built-in ones may round differently on every
// device.
#ifndef CLRT_NUMERICS_VECTOR_H
#define CLRT_NUMERICS_VECTOR_H

#include "real.h"

static inline real3 vector_make(real x, real y, real z) { return (real3)(x, y, z); }

/* The first three components of a shared struct's vec4. */
static inline real3 vector_from(float4 v) { return convert_real3(v.xyz); }

/* One product of all components and two sums: CPUs keep a vector in one register, where this is the shortest
   way. */
static inline real vector_dot(real3 a, real3 b)
{
    const real3 products = a * b;
    return products.x + products.y + products.z;
}

static inline real vector_length(real3 v) { return real_sqrt(vector_dot(v, v)); }

/* Unit vector; v is neither zero nor so small that its square underflows. */
static inline real3 vector_normalize(real3 v) { return v / vector_length(v); }

/* a x b by differences of products (real_difference_of_products, all components at once): each within 1.5
   ulp, so nearly parallel edges keep a normal. */
static inline real3 vector_cross(real3 a, real3 b)
{
    const real3 a1 = a.yzx, a2 = a.zxy, b1 = b.yzx, b2 = b.zxy;
    const real3 cd = a2 * b1;
    return fma(a1, b2, -cd) + fma(-a2, b1, cd);
}

static inline real vector_max_component(real3 v) { return fmax(v.x, fmax(v.y, v.z)); }

/* True if every component is below the limit; a NaN is not. */
static inline bool vector_is_below(real3 v, real limit) { return v.x < limit && v.y < limit && v.z < limit; }

static inline real vector_max_abs(real3 v) { return vector_max_component(fabs(v)); }

/* Luminance of linear RGB with the primaries of sRGB (ITU-R BT.709). */
static inline real vector_luminance(real3 rgb)
{
    return fma(REAL(0.2126), rgb.x, fma(REAL(0.7152), rgb.y, REAL(0.0722) * rgb.z));
}

/* How much a colour weighs where parts are chosen by chance. A choice by lengths gives the least sum of the
   channels' second moments; luminance would choose blue beside green so rarely that the few samples of blue
   are ten times too bright. */
static inline real vector_color_size(real3 rgb) { return vector_length(rgb); }

/* a + t (b - a), exactly a where t is 0. */
static inline real3 vector_mix(real3 a, real3 b, real t) { return a + t * (b - a); }

/* True for a colour, whose components are not negative, that is 0; a NaN is not black. */
static inline bool vector_is_black(real3 color) { return color.x + color.y + color.z == REAL(0.0); }

static inline bool vector_is_zero(real3 v)
{
    return v.x == REAL(0.0) && v.y == REAL(0.0) && v.z == REAL(0.0);
}

static inline bool vector_is_finite(real3 v)
{
    return real_is_finite(v.x) && real_is_finite(v.y) && real_is_finite(v.z);
}

#endif
