// SPDX-License-Identifier: Apache-2.0
// Sheen: fibres that stand up from a cloth and reflect towards grazing angles. "Charlie" (Estevez and Kulla
// 2017) with their fit of Smith's Lambda, without the softening at the terminator, which is not reciprocal.
// Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_SHEEN_H
#define CLRT_SCATTERING_BSDF_SHEEN_H

#include "bsdf_cover.h"
#include "numerics/real_functions.h"
#include "numerics/warp.h"

/* The fit of Lambda ends at the horizon, where the true one grows with 1 / cos: what is seen more aslant is as
   dark as here. */
#define SHEEN_SMALLEST_COS REAL(1e-3)

static inline bool bsdf_sheen_is_delta(const Bsdf* bsdf) { return false; }

static inline real bsdf_sheen_size(const Bsdf* bsdf)
{
    return cover_size(bsdf, bsdf_cover(bsdf)->coat_left - bsdf_cover(bsdf)->left);
}

/* Head-on. */
static inline real3 bsdf_sheen_albedo(const Bsdf* bsdf)
{
    return bsdf_cover(bsdf)->sheen * cover_sheen_albedo(bsdf_cover(bsdf)->sheen_alpha, REAL(1.0));
}

/* a / (1 + b x^c) + d x + e with the numbers of alpha 0 and alpha 1 (table 1) mixed by t. */
static inline real sheen_exponent(real x, real t)
{
    const real a = albedo_mix(REAL(21.5473), REAL(25.3245), t);
    const real b = albedo_mix(REAL(3.82987), REAL(3.32435), t);
    const real c = albedo_mix(REAL(0.19823), REAL(0.16801), t);
    const real d = albedo_mix(REAL(-1.97760), REAL(-1.27393), t);
    const real e = albedo_mix(REAL(-4.32054), REAL(-4.85967), t);
    return a / fma(b, real_pow(x, c), REAL(1.0)) + fma(d, x, e);
}

static inline real sheen_lambda(real cos_w, real alpha)
{
    const real t = (REAL(1.0) - alpha) * (REAL(1.0) - alpha);
    const real x = fmin(cos_w, REAL(1.0));
    if (x < REAL(0.5))
        return real_exp(sheen_exponent(x, t));
    return real_exp(REAL(2.0) * sheen_exponent(REAL(0.5), t) - sheen_exponent(REAL(1.0) - x, t));
}

/* Density of normals around h: (2 + 1 / alpha) sin^(1 / alpha) / (2 pi). */
static inline real sheen_d(real3 h, real alpha)
{
    const real sine_squared = fma(h.x, h.x, h.y * h.y);
    return (REAL(2.0) + REAL(1.0) / alpha) * real_pow(sine_squared, REAL(0.5) / alpha) * REAL(0.5) *
           REAL_INVERSE_PI;
}

static inline void bsdf_sheen_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    const real3 wo = bsdf->wo;
    if (!(wo.z > REAL(0.0) && wi.z > REAL(0.0)) || (bsdf->flags & BSDF_INSIDE))
        return;
    const real alpha = bsdf_cover(bsdf)->sheen_alpha;
    const real cos_o = fmax(wo.z, SHEEN_SMALLEST_COS), cos_i = fmax(wi.z, SHEEN_SMALLEST_COS);
    const real visible = REAL(1.0) + sheen_lambda(cos_o, alpha) + sheen_lambda(cos_i, alpha);
    const real d_over_4_cos = sheen_d(vector_normalize(wo + wi), alpha) / (REAL(4.0) * cos_o);
    sum->value += bsdf_cover(bsdf)->sheen * (d_over_4_cos / visible * (wi.z / cos_i));
    sum->pdf_w = fma(bsdf->choose[LOBE_ROW_SHEEN], warp_hemisphere_pdf_w(), sum->pdf_w);
}

/* All directions alike: it is wide, and highest near the horizon. */
static inline real3 bsdf_sheen_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    TRACE_SET(sample->lobe, LOBE_SHEEN);
    return warp_hemisphere(u);
}

#endif
