// SPDX-License-Identifier: Apache-2.0
// Rough reflection by GGX microfacets: by one facet, sampled by visible normals, and by more (bsdf_energy.h).
// Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_GLOSSY_H
#define CLRT_SCATTERING_BSDF_GLOSSY_H

#include "bsdf_energy.h"
#include "microfacet.h"

static inline bool bsdf_glossy_is_delta(const Bsdf* bsdf) { return false; }

/* Of one facet: that of more is added apart (bsdf_choose_lobes). */
static inline real bsdf_glossy_size(const Bsdf* bsdf)
{
    return vector_color_size(bsdf_reflection_color(bsdf, bsdf->wo.z));
}

static inline real3 bsdf_glossy_albedo(const Bsdf* bsdf) { return bsdf_reflection_albedo(bsdf); }

/* One facet: BSDF times cos_i (Walter et al. 2007, eq. 20) and its density. */
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

/* The density alone, of finding the one local direction by one facet as seen from the other. */
static inline real bsdf_glossy_pdf_w_single(const Bsdf* bsdf, real3 wo, real3 wi)
{
    if (!(wo.z > MICROFACET_SMALLEST_COS && wi.z > REAL(0.0)))
        return REAL(0.0);
    const real d_over_4_cos =
        microfacet_d(vector_normalize(wo + wi), bsdf->alpha_x, bsdf->alpha_y) / (REAL(4.0) * wo.z);
    return d_over_4_cos / (REAL(1.0) + microfacet_lambda(wo, bsdf->alpha_x, bsdf->alpha_y));
}

/* Adds the lobe with a known loss L(wi). */
static inline void bsdf_glossy_add_by(const Bsdf* bsdf, real loss, real3 wi, BsdfValue* sum)
{
    BsdfValue lobe = bsdf_glossy_eval_single(bsdf, wi);
    const real multiple = bsdf_energy_multiple_choice(bsdf, LOBE_GLOSSY);
    lobe.pdf_w *= bsdf->choose[LOBE_ROW_GLOSSY] - multiple;
    if (wi.z > REAL(0.0) && bsdf_energy_has_multiple(bsdf, LOBE_GLOSSY)) {
        lobe.value += bsdf_energy_multiple_by(bsdf, loss, wi);
        lobe.pdf_w = fma(multiple, bsdf_energy_multiple_pdf_w(), lobe.pdf_w);
    }
    sum->value += lobe.value;
    sum->pdf_w += lobe.pdf_w;
}

static inline void bsdf_glossy_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    const bool is_needed = wi.z > REAL(0.0) && bsdf_energy_has_multiple(bsdf, LOBE_GLOSSY);
    bsdf_glossy_add_by(bsdf, is_needed ? albedo_reflection_loss(&bsdf->rough, wi) : REAL(0.0), wi, sum);
}

/* A direction reflected by one facet; z <= 0 means that none was found. */
static inline real3 bsdf_glossy_sample_single(const Bsdf* bsdf, real2 u)
{
    const real3 h = microfacet_sample(bsdf->wo, bsdf->alpha_x, bsdf->alpha_y, u);
    return REAL(2.0) * vector_dot(bsdf->wo, h) * h - bsdf->wo;
}

static inline real3 bsdf_glossy_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    TRACE_SET(sample->lobe, LOBE_GLOSSY);
    const bool is_multiple = choice.u < choice.before + bsdf_energy_multiple_choice(bsdf, LOBE_GLOSSY);
    const real3 wi = is_multiple ? bsdf_energy_multiple_sample(u) : bsdf_glossy_sample_single(bsdf, u);
    /* Below the surface this lobe finds nothing, whatever the glass beside it lets pass there. */
    if (bsdf_is_part_glass(bsdf) && !(wi.z > REAL(0.0)))
        sample->is_weighted = true;
    return wi;
}

#endif
