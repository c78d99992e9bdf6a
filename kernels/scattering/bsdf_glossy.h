// SPDX-License-Identifier: Apache-2.0
// Rough reflection by GGX microfacets: by one facet, sampled by visible normals, and by more (bsdf_energy.h). Local directions,
// z is the normal.
#ifndef CLRT_SCATTERING_BSDF_GLOSSY_H
#define CLRT_SCATTERING_BSDF_GLOSSY_H

#include "bsdf_energy.h"
#include "microfacet.h"

/* The colour of a reflection whose half vector meets the directions at this cosine. */
static inline real3 bsdf_reflection_color(const Bsdf* bsdf, real cos_h)
{
    return bsdf->fresnel == FRESNEL_SCHLICK ? fresnel_schlick(bsdf->specular, cos_h) : bsdf->specular;
}

/* One facet: BSDF times cos_i (Walter et al. 2007, eq. 20) and the density of sampling wi by visible normals. */
static inline BsdfValue bsdf_glossy_eval_single(const Bsdf* bsdf, real3 wi)
{
    BsdfValue result;
    result.value = (real3)(REAL(0.0));
    result.pdf_w = REAL(0.0);
    const real3 wo = bsdf->wo;
    if (!(wo.z > MICROFACET_SMALLEST_COS && wi.z > REAL(0.0)))
        return result;
    const real3 h = vector_normalize(wo + wi);
    const real lambda_o = microfacet_lambda(wo, bsdf->alpha_x, bsdf->alpha_y);
    const real lambda_i = microfacet_lambda(wi, bsdf->alpha_x, bsdf->alpha_y);
    const real d_over_4_cos = microfacet_d(h, bsdf->alpha_x, bsdf->alpha_y) / (REAL(4.0) * wo.z);
    result.value =
        bsdf_reflection_color(bsdf, vector_dot(wo, h)) * (d_over_4_cos / (REAL(1.0) + lambda_o + lambda_i));
    /* Density of h over the Jacobian 4 wo.h of the reflection; wo.h cancels. */
    result.pdf_w = d_over_4_cos / (REAL(1.0) + lambda_o);
    return result;
}

/* All of it, and the density of the glossy lobe's share of the mixture. */
static inline BsdfValue bsdf_glossy_eval(const Bsdf* bsdf, real3 wi)
{
    BsdfValue result = bsdf_glossy_eval_single(bsdf, wi);
    result.pdf_w *= bsdf->choose_glossy;
    if (!(wi.z > REAL(0.0)))
        return result;
    result.value += bsdf_energy_multiple(bsdf, wi);
    result.pdf_w = fma(bsdf->choose_multiple, bsdf_energy_multiple_pdf_w(), result.pdf_w);
    return result;
}

/* A direction reflected by one facet; z <= 0 means that none was found. */
static inline real3 bsdf_glossy_sample(const Bsdf* bsdf, real2 u)
{
    const real3 h = microfacet_sample(bsdf->wo, bsdf->alpha_x, bsdf->alpha_y, u);
    return REAL(2.0) * vector_dot(bsdf->wo, h) * h - bsdf->wo;
}

#endif
