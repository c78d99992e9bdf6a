// SPDX-License-Identifier: Apache-2.0
// A clear coat of index 1.5: reflection by GGX microfacets with Schlick's Fresnel, never smooth. What it
// loses between facets goes to what is below (bsdf_cover.h). Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_COAT_H
#define CLRT_SCATTERING_BSDF_COAT_H

#include "bsdf_cover.h"
#include "microfacet.h"

static inline bool bsdf_coat_is_delta(const Bsdf* bsdf) { return false; }

static inline real bsdf_coat_size(const Bsdf* bsdf)
{
    return cover_size(bsdf, REAL(1.0) - bsdf_cover(bsdf)->coat_left);
}

static inline real3 bsdf_coat_albedo(const Bsdf* bsdf)
{
    return (real3)(bsdf_cover(bsdf)->coat * COVER_COAT_F0);
}

static inline void bsdf_coat_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    const real3 wo = bsdf->wo;
    if (!(wo.z > MICROFACET_SMALLEST_COS && wi.z > REAL(0.0)) || (bsdf->flags & BSDF_INSIDE))
        return;
    const real alpha = bsdf_cover(bsdf)->coat_alpha;
    const real3 h = vector_normalize(wo + wi);
    const real lambda_o = microfacet_lambda(wo, alpha, alpha);
    const real lambda_i = microfacet_lambda(wi, alpha, alpha);
    const real d_over_4_cos = microfacet_d(h, alpha, alpha) / (REAL(4.0) * wo.z);
    const real f = fma(REAL(1.0) - COVER_COAT_F0, fresnel_schlick_grazing(vector_dot(wo, h)), COVER_COAT_F0);
    sum->value += (real3)(bsdf_cover(bsdf)->coat * f * d_over_4_cos / (REAL(1.0) + lambda_o + lambda_i));
    sum->pdf_w = fma(bsdf->choose[LOBE_ROW_COAT], d_over_4_cos / (REAL(1.0) + lambda_o), sum->pdf_w);
}

static inline real3 bsdf_coat_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    TRACE_SET(sample->lobe, LOBE_COAT);
    const real alpha = bsdf_cover(bsdf)->coat_alpha;
    const real3 h = microfacet_sample(bsdf->wo, alpha, alpha, u);
    const real3 wi = REAL(2.0) * vector_dot(bsdf->wo, h) * h - bsdf->wo;
    /* Below the surface the coat finds nothing, whatever glass under it lets pass there. */
    sample->is_weighted = !(wi.z > REAL(0.0));
    return wi;
}

#endif
