// SPDX-License-Identifier: Apache-2.0
// A wall of glass without thickness: it reflects as glass does, and what it does not reflect passes without
// being bent: straight on where it is smooth, and where it is rough spread as what is reflected. Light passes
// one boundary (KHR_materials_transmission), so both sides are alike. Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_PANE_H
#define CLRT_SCATTERING_BSDF_PANE_H

#include "bsdf_dielectric.h"

static inline bool bsdf_pane_is_delta(const Bsdf* bsdf) { return bsdf->alpha_x == REAL(0.0); }

/* The share that a smooth pane reflects, but for its colour. */
static inline real bsdf_pane_fresnel(const Bsdf* bsdf)
{
    real cos_t;
    return fresnel_dielectric(clamp(bsdf->wo.z, REAL(0.0), REAL(1.0)), bsdf->eta, &cos_t);
}

static inline real bsdf_pane_size(const Bsdf* bsdf)
{
    return bsdf_glass_size(bsdf) * (bsdf_pane_is_delta(bsdf) ? bsdf_pane_fresnel(bsdf) : REAL(1.0));
}

static inline real3 bsdf_pane_albedo(const Bsdf* bsdf) { return bsdf_glass_albedo(bsdf); }

/* What a smooth pane lets pass straight on towards wo. That is alike in both directions and no scattering, so
   no part of the value and of the samples here (path/visibility.h). */
static inline real3 bsdf_pane_passes(const Bsdf* bsdf)
{
    const real3 passes = bsdf->transmission * (REAL(1.0) - bsdf_pane_fresnel(bsdf));
    return bsdf_is_covered(bsdf) ? passes * cover_factors(bsdf, -bsdf->wo).other : passes;
}

/* The probability with which paths pass: that of the glass, but for its colour. */
static inline real bsdf_pane_passing(const Bsdf* bsdf)
{
    const real passing = REAL(1.0) - bsdf_pane_fresnel(bsdf);
    return bsdf_is_part_glass(bsdf) ? bsdf->glass * passing : passing;
}

/* One facet: BSDF times |cos_i| and the density of sampling wi. */
static inline BsdfValue bsdf_pane_eval_single(const Bsdf* bsdf, real3 wi)
{
    BsdfValue result = bsdf_value_none();
    const real3 wo = bsdf->wo;
    const real3 mirrored = vector_make(wi.x, wi.y, fabs(wi.z));
    if (!(wo.z > MICROFACET_SMALLEST_COS && mirrored.z > REAL(0.0)))
        return result;
    const real3 h = vector_normalize(wo + mirrored);
    real cos_t;
    const real f = fresnel_dielectric(clamp(vector_dot(wo, h), REAL(0.0), REAL(1.0)), bsdf->eta, &cos_t);
    const real lambda_o = microfacet_lambda(wo, bsdf->alpha_x, bsdf->alpha_y);
    const real lambda_i = microfacet_lambda(mirrored, bsdf->alpha_x, bsdf->alpha_y);
    const bool reflects = wi.z > REAL(0.0);
    const real part = reflects ? f : REAL(1.0) - f;
    const real d_over_4_cos =
        part * microfacet_d(h, bsdf->alpha_x, bsdf->alpha_y) / (REAL(4.0) * wo.z);
    result.value = (reflects ? bsdf_glass_color(bsdf) : bsdf->transmission) *
                   (d_over_4_cos / (REAL(1.0) + lambda_o + lambda_i));
    result.pdf_w = d_over_4_cos / (REAL(1.0) + lambda_o);
    return result;
}

static inline void bsdf_pane_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    if (bsdf_pane_is_delta(bsdf))
        return;
    bsdf_glass_add(bsdf, wi, bsdf->choose[LOBE_ROW_PANE], bsdf_pane_eval_single(bsdf, wi), sum);
}

static inline real3 bsdf_pane_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    const real3 wo = bsdf->wo;
    if (bsdf_pane_is_delta(bsdf)) {
        TRACE_SET(sample->lobe, LOBE_PANE);
        sample->is_weighted = true;
        sample->weight = bsdf_glass_color(bsdf) * (bsdf_pane_fresnel(bsdf) / bsdf->choose[LOBE_ROW_PANE]);
        return vector_make(-wo.x, -wo.y, wo.z);
    }
    const real multiple = bsdf->choose_multiple;
    const real share = choice.u - choice.before;
    if (share < multiple)
        return bsdf_glass_sample_multiple(bsdf, LOBE_PANE, share < multiple * bsdf->multiple_reflects, u,
                                          sample);
    const real u_way = (share - multiple) / (bsdf->choose[LOBE_ROW_PANE] - multiple);
    const GlassFacet facet = bsdf_glass_facet(bsdf, LOBE_PANE, u_way, u, sample);
    real3 wi = REAL(2.0) * facet.cos_o * facet.normal - wo;
    /* A microfacet may send light below the surface: such paths end. */
    sample->is_weighted = !(wi.z > REAL(0.0));
    if (!sample->is_weighted && !facet.reflects)
        wi.z = -wi.z;
    return wi;
}

#endif
