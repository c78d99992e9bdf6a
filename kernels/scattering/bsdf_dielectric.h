// SPDX-License-Identifier: Apache-2.0
// Reflection and refraction at the boundary of two dielectrics, smooth or with GGX microfacets (Walter et al. 2007): by one facet,
// and by more (bsdf_energy.h). Radiance is scaled by the squared index ratio where it crosses (Veach 1997, sec. 5.2). Local directions.
#ifndef CLRT_SCATTERING_BSDF_DIELECTRIC_H
#define CLRT_SCATTERING_BSDF_DIELECTRIC_H

#include "bsdf_energy.h"
#include "microfacet.h"

/* True if light is only reflected as by a mirror and refracted straight: no roughness, or nothing to refract at. */
static inline bool bsdf_dielectric_is_smooth(const Bsdf* bsdf)
{
    return !HAS(EFFECT_ROUGH_REFRACTION) || bsdf->alpha_x == REAL(0.0) || bsdf->eta == REAL(1.0);
}

/* The half vector of wo and wi on the normal's side, and the squared length of the sum that it is made from; both zero
   where there is none. */
static inline real3 bsdf_dielectric_half(const Bsdf* bsdf, real3 wi, real* length_squared)
{
    const real3 sum = wi.z > REAL(0.0) ? bsdf->wo + wi : bsdf->eta * bsdf->wo + wi;
    *length_squared = vector_dot(sum, sum);
    if (!(*length_squared > REAL(0.0)))
        return (real3)(REAL(0.0));
    return sum * (copysign(REAL(1.0), sum.z) / real_sqrt(*length_squared));
}

/* One facet: BSDF times |cos_i| of the rough dielectric and the density of sampling wi; both 0 for the smooth one. */
static inline BsdfValue bsdf_dielectric_eval_single(const Bsdf* bsdf, real3 wi)
{
    BsdfValue result;
    result.value = (real3)(REAL(0.0));
    result.pdf_w = REAL(0.0);
    const real3 wo = bsdf->wo;
    real length_squared;
    const real3 h = bsdf_dielectric_half(bsdf, wi, &length_squared);
    const real cos_oh = vector_dot(wo, h);
    const real cos_ih = vector_dot(wi, h);
    /* wo must see the front of the microfacet, wi the side that matches. */
    if (bsdf_dielectric_is_smooth(bsdf) || !(wo.z > MICROFACET_SMALLEST_COS) || wi.z == REAL(0.0) ||
        !(cos_oh > REAL(0.0)) || cos_ih * wi.z <= REAL(0.0))
        return result;
    real cos_t;
    const real f = fresnel_dielectric(cos_oh, bsdf->eta, &cos_t);
    const real lambda_o = microfacet_lambda(wo, bsdf->alpha_x, bsdf->alpha_y);
    const real lambda_i = microfacet_lambda(wi, bsdf->alpha_x, bsdf->alpha_y);
    const real d_over_cos = microfacet_d(h, bsdf->alpha_x, bsdf->alpha_y) / wo.z;
    const real g1 = REAL(1.0) / (REAL(1.0) + lambda_o);
    const real g2 = REAL(1.0) / (REAL(1.0) + lambda_o + lambda_i);
    if (wi.z > REAL(0.0)) {
        result.value = bsdf->specular * (REAL(0.25) * f * d_over_cos * g2);
        result.pdf_w = REAL(0.25) * f * d_over_cos * g1;
        return result;
    }
    /* Walter et al., eq. 17: density of wi per density of h. Its denominator eta cos_oh + cos_ih is the length of the sum. */
    const real spread = (REAL(1.0) - f) * d_over_cos * cos_oh * fabs(cos_ih) / length_squared;
    /* Eq. 21 times cos_i, times eta^2 for radiance; the index on wi's side cancels. */
    result.value = bsdf->transmission * (spread * g2 * bsdf->eta * bsdf->eta);
    result.pdf_w = spread * g1;
    return result;
}

/* All of it, and the density of the mixture. */
static inline BsdfValue bsdf_dielectric_eval(const Bsdf* bsdf, real3 wi)
{
    BsdfValue result = bsdf_dielectric_eval_single(bsdf, wi);
    if (bsdf->choose_multiple == REAL(0.0) || wi.z == REAL(0.0))
        return result;
    result.value += bsdf_energy_multiple(bsdf, wi);
    const real side = wi.z > REAL(0.0) ? bsdf->multiple_reflects : REAL(1.0) - bsdf->multiple_reflects;
    result.pdf_w = fma(bsdf->choose_multiple * side, bsdf_energy_multiple_pdf_w(),
                       (REAL(1.0) - bsdf->choose_multiple) * result.pdf_w);
    return result;
}

/* Samples light of more than one facet, to both sides; u_lobe is below its share of the mixture. */
static inline real3 bsdf_dielectric_sample_multiple(const Bsdf* bsdf, real u_lobe, real2 u, BsdfSample* sample)
{
    const bool reflects = u_lobe < bsdf->choose_multiple * bsdf->multiple_reflects;
    TRACE_SET(sample->lobe, reflects ? LOBE_DIELECTRIC : TRACE_LOBE_REFRACTION);
    real3 wi = bsdf_energy_multiple_sample(u);
    wi.z = reflects ? wi.z : -wi.z;
    const BsdfValue eval = bsdf_dielectric_eval(bsdf, wi);
    sample->eta = reflects ? REAL(1.0) : bsdf->eta;
    sample->pdf_w = eval.pdf_w;
    sample->weight = eval.pdf_w > REAL(0.0) ? eval.value / eval.pdf_w : (real3)(REAL(0.0)); /* the horizon */
    return wi;
}

/* Probability of reflecting where F would reflect: F itself, unless one of the two ways is closed. */
static inline real bsdf_dielectric_choose(const Bsdf* bsdf, real f)
{
    if (!HAS(EFFECT_PATH_FILTER))
        return f;
    if (bsdf->flags & BSDF_NO_REFRACTION)
        return REAL(1.0);
    /* Total reflection leaves nothing to refract: the weight becomes 0. */
    return (bsdf->flags & BSDF_NO_REFLECTION) ? REAL(0.0) : f;
}

/* One facet: reflects with probability F, else refracts. Gives the local direction; fills weight, density and index ratio. */
static inline real3 bsdf_dielectric_sample_single(const Bsdf* bsdf, real u_lobe, real2 u, BsdfSample* sample)
{
    const real3 wo = bsdf->wo;
    const bool smooth = bsdf_dielectric_is_smooth(bsdf);
    const real3 h = smooth ? vector_make(REAL(0.0), REAL(0.0), REAL(1.0))
                           : microfacet_sample(wo, bsdf->alpha_x, bsdf->alpha_y, u);
    const real cos_oh = clamp(vector_dot(wo, h), REAL(0.0), REAL(1.0));
    real cos_t;
    const real f = fresnel_dielectric(cos_oh, bsdf->eta, &cos_t);
    const real choose = bsdf_dielectric_choose(bsdf, f);
    const bool reflects = u_lobe < choose;
    TRACE_SET(sample->lobe, reflects ? LOBE_DIELECTRIC : TRACE_LOBE_REFRACTION);
    const real3 wi = reflects ? REAL(2.0) * cos_oh * h - wo : fresnel_refract(wo, h, cos_oh, cos_t, bsdf->eta);
    /* A microfacet may send light through the macroscopic surface the wrong way, and the horizon sees none: such paths
       end. */
    if ((wi.z > REAL(0.0)) != reflects || !(wo.z > MICROFACET_SMALLEST_COS))
        return wi;
    sample->eta = reflects ? REAL(1.0) : bsdf->eta;
    sample->weight = reflects ? bsdf->specular : bsdf->transmission * (bsdf->eta * bsdf->eta);
    if (HAS(EFFECT_PATH_FILTER) && choose != f)
        sample->weight *= reflects ? f : REAL(1.0) - f;
    if (!smooth) {
        sample->weight *=
            microfacet_g2(wo, wi, bsdf->alpha_x, bsdf->alpha_y) / microfacet_g1(wo, bsdf->alpha_x, bsdf->alpha_y);
        const BsdfValue eval = bsdf_dielectric_eval(bsdf, wi);
        sample->pdf_w = eval.pdf_w;
        /* Beside light of more than one facet the direction carries both. */
        if (bsdf->choose_multiple > REAL(0.0))
            sample->weight = eval.pdf_w > REAL(0.0) ? eval.value / eval.pdf_w : (real3)(REAL(0.0));
    }
    return wi;
}

/* Samples a direction and gives it back local; fills weight, density and index ratio. */
static inline real3 bsdf_dielectric_sample(const Bsdf* bsdf, real u_lobe, real2 u, BsdfSample* sample)
{
    const real multiple = bsdf->choose_multiple;
    if (!HAS(EFFECT_ROUGH_REFRACTION) || multiple == REAL(0.0))
        return bsdf_dielectric_sample_single(bsdf, u_lobe, u, sample);
    if (u_lobe < multiple)
        return bsdf_dielectric_sample_multiple(bsdf, u_lobe, u, sample);
    return bsdf_dielectric_sample_single(bsdf, (u_lobe - multiple) / (REAL(1.0) - multiple), u, sample);
}

#endif
