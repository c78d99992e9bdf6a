// SPDX-License-Identifier: Apache-2.0
// Reflection and refraction at the boundary of two dielectrics, smooth or with GGX microfacets (Walter et al. 2007).
// Radiance is scaled by the squared index ratio where it crosses (Veach 1997, sec. 5.2). Local directions.
#ifndef CLRT_SCATTERING_BSDF_DIELECTRIC_H
#define CLRT_SCATTERING_BSDF_DIELECTRIC_H

#include "bsdf_types.h"
#include "fresnel.h"
#include "microfacet.h"

/* The half vector of a pair on the normal's side; zero where there is none. */
static inline real3 bsdf_dielectric_half(const Bsdf* bsdf, real3 wo, real3 wi)
{
    const real3 sum = wi.z > REAL(0.0) ? wo + wi : bsdf->eta * wo + wi;
    const real length_squared = vector_dot(sum, sum);
    if (!(length_squared > REAL(0.0)))
        return (real3)(REAL(0.0));
    return sum * (copysign(REAL(1.0), sum.z) / real_sqrt(length_squared));
}

/* Density of refracting into wi per density of the half vector: |wi.h| / (eta wo.h + wi.h)^2. */
static inline real bsdf_dielectric_jacobian(const Bsdf* bsdf, real cos_oh, real cos_ih)
{
    const real d = fma(bsdf->eta, cos_oh, cos_ih);
    return fabs(cos_ih) / (d * d);
}

/* BSDF times |cos_i| of the rough dielectric; 0 for the smooth one. */
static inline real3 bsdf_dielectric_eval(const Bsdf* bsdf, real3 wo, real3 wi)
{
    const real3 h = bsdf_dielectric_half(bsdf, wo, wi);
    const real cos_oh = vector_dot(wo, h);
    const real cos_ih = vector_dot(wi, h);
    /* wo must see the front of the microfacet, wi the side that matches. */
    if (bsdf->alpha_x == REAL(0.0) || !(wo.z > REAL(0.0)) || wi.z == REAL(0.0) || !(cos_oh > REAL(0.0)) ||
        cos_ih * wi.z <= REAL(0.0))
        return (real3)(REAL(0.0));
    real cos_t;
    const real f = fresnel_dielectric(cos_oh, bsdf->eta, &cos_t);
    const real d = microfacet_d(h, bsdf->alpha_x, bsdf->alpha_y);
    const real g = microfacet_g2(wo, wi, bsdf->alpha_x, bsdf->alpha_y);
    if (wi.z > REAL(0.0))
        return bsdf->specular * (f * d * g / (REAL(4.0) * wo.z));
    /* Eq. 21 of Walter et al. times cos_i, scaled by eta^2 for radiance; the index of wi's side cancels. */
    const real spread = bsdf_dielectric_jacobian(bsdf, cos_oh, cos_ih);
    return bsdf->transmission * ((REAL(1.0) - f) * d * g * cos_oh * spread * bsdf->eta * bsdf->eta / wo.z);
}

static inline real bsdf_dielectric_pdf_w(const Bsdf* bsdf, real3 wo, real3 wi)
{
    const real3 h = bsdf_dielectric_half(bsdf, wo, wi);
    const real cos_oh = vector_dot(wo, h);
    const real cos_ih = vector_dot(wi, h);
    if (bsdf->alpha_x == REAL(0.0) || !(wo.z > REAL(0.0)) || wi.z == REAL(0.0) || !(cos_oh > REAL(0.0)) ||
        cos_ih * wi.z <= REAL(0.0))
        return REAL(0.0);
    real cos_t;
    const real f = fresnel_dielectric(cos_oh, bsdf->eta, &cos_t);
    const real pdf_h = microfacet_pdf_w(wo, h, cos_oh, bsdf->alpha_x, bsdf->alpha_y);
    if (wi.z > REAL(0.0))
        return f * pdf_h / (REAL(4.0) * cos_oh);
    return (REAL(1.0) - f) * pdf_h * bsdf_dielectric_jacobian(bsdf, cos_oh, cos_ih);
}

/* Reflects with probability F, else refracts. Gives the local direction, the weight (BSDF |cos_i| / pdf) and the index
   ratio crossed. */
static inline real3 bsdf_dielectric_sample(const Bsdf* bsdf, real3 wo, real u_lobe, real2 u, real3* weight, real* eta)
{
    const bool smooth = !HAS(EFFECT_ROUGH_REFRACTION) || bsdf->alpha_x == REAL(0.0);
    const real3 h = smooth ? vector_make(REAL(0.0), REAL(0.0), REAL(1.0))
                           : microfacet_sample(wo, bsdf->alpha_x, bsdf->alpha_y, u);
    const real cos_oh = clamp(vector_dot(wo, h), REAL(0.0), REAL(1.0));
    real cos_t;
    const real f = fresnel_dielectric(cos_oh, bsdf->eta, &cos_t);
    const bool reflects = u_lobe < f;
    const real3 wi = reflects ? REAL(2.0) * cos_oh * h - wo : fresnel_refract(wo, h, cos_oh, cos_t, bsdf->eta);
    *eta = reflects ? REAL(1.0) : bsdf->eta;
    *weight = reflects ? bsdf->specular : bsdf->transmission * (bsdf->eta * bsdf->eta);
    /* A microfacet may send light through the macroscopic surface the wrong way: such paths end. */
    if ((wi.z > REAL(0.0)) != reflects)
        *weight = (real3)(REAL(0.0));
    else if (!smooth)
        *weight *= microfacet_g2(wo, wi, bsdf->alpha_x, bsdf->alpha_y) / microfacet_g1(wo, bsdf->alpha_x, bsdf->alpha_y);
    return wi;
}

#endif
