// SPDX-License-Identifier: Apache-2.0
// The GGX (Trowbridge-Reitz) distribution of microfacet normals, anisotropic, with Smith's height-correlated
// masking and shadowing (Heitz 2014, JCGT 3(2)). Directions are local, z is the normal; only components are
// used, no angles, so small alpha loses no digits.
#ifndef CLRT_SCATTERING_MICROFACET_H
#define CLRT_SCATTERING_MICROFACET_H

#include "numerics/warp.h"

/* Density of normals around h, per steradian of h. */
static inline real microfacet_d(real3 h, real alpha_x, real alpha_y)
{
    const real x = h.x / alpha_x;
    const real y = h.y / alpha_y;
    const real s = fma(x, x, fma(y, y, h.z * h.z));
    return REAL(1.0) / (REAL_PI * alpha_x * alpha_y * s * s);
}

/* Eyes closer to the horizon than this cosine see no microfacets, so that dividing by it stays finite. */
#define MICROFACET_SMALLEST_COS REAL(1e-18)

/* Smith's Lambda: (sqrt(1 + a / z^2) - 1) / 2 with a = (alpha tan)^2 z^2, without its cancellation and
   without a / z^2, which overflows near the horizon. Infinite on the horizon. */
static inline real microfacet_lambda(real3 w, real alpha_x, real alpha_y)
{
    const real x = alpha_x * w.x;
    const real y = alpha_y * w.y;
    const real z = fabs(w.z);
    const real a = fma(x, x, y * y);
    return REAL(0.5) * a / (z * (z + real_sqrt(fma(z, z, a))));
}

/* Fraction of normals visible from w. */
static inline real microfacet_g1(real3 w, real alpha_x, real alpha_y)
{
    return REAL(1.0) / (REAL(1.0) + microfacet_lambda(w, alpha_x, alpha_y));
}

/* Fraction visible from both, on the same side. */
static inline real microfacet_g2(real3 wo, real3 wi, real alpha_x, real alpha_y)
{
    return REAL(1.0) /
           (REAL(1.0) + microfacet_lambda(wo, alpha_x, alpha_y) + microfacet_lambda(wi, alpha_x, alpha_y));
}

/* A normal visible from wo (wo.z > 0), by a spherical cap (Dupuy and Benyoub 2023, CGF 42(8)). */
static inline real3 microfacet_sample(real3 wo, real alpha_x, real alpha_y, real2 u)
{
    const real3 stretched = vector_normalize(vector_make(wo.x * alpha_x, wo.y * alpha_y, wo.z));
    const real2 sc = real_sin_cos_turn(u.x);
    const real z = fma(REAL(1.0) - u.y, REAL(1.0) + stretched.z, -stretched.z);
    const real r = real_root((REAL(1.0) - z) * (REAL(1.0) + z));
    const real3 h = vector_make(r * sc.y, r * sc.x, z) + stretched;
    return vector_normalize(vector_make(h.x * alpha_x, h.y * alpha_y, fmax(h.z, REAL(0.0))));
}

/* Density of microfacet_sample per steradian of h; cos_oh = wo . h > 0. */
static inline real microfacet_pdf_w(real3 wo, real3 h, real cos_oh, real alpha_x, real alpha_y)
{
    return microfacet_g1(wo, alpha_x, alpha_y) * cos_oh * microfacet_d(h, alpha_x, alpha_y) / wo.z;
}

#endif
