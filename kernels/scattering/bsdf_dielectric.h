// SPDX-License-Identifier: Apache-2.0
// Reflection and refraction at the boundary of two dielectrics, smooth or with GGX microfacets (Walter et al.
// 2007): by one facet, and by more (bsdf_energy.h). Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_DIELECTRIC_H
#define CLRT_SCATTERING_BSDF_DIELECTRIC_H

#include "bsdf_energy.h"
#include "dispersion.h"
#include "microfacet.h"

/* True if light is only reflected as by a mirror and refracted straight: no roughness, or nothing to refract
   at. */
static inline bool bsdf_dielectric_is_delta(const Bsdf* bsdf)
{
    return !HAS(EFFECT_ROUGH_REFRACTION) || bsdf->alpha_x == REAL(0.0) || bsdf->eta == REAL(1.0);
}

/* Nothing is absorbed: what is left of the light of more than one facet. */
static inline real bsdf_glass_size(const Bsdf* bsdf)
{
    return bsdf_is_part_glass(bsdf) ? vector_color_size((real3)(bsdf->glass))
                                    : REAL(1.0) - bsdf->multiple_size;
}

static inline real3 bsdf_glass_albedo(const Bsdf* bsdf)
{
    return (real3)(bsdf_is_part_glass(bsdf) ? bsdf->glass : REAL(1.0));
}

static inline real bsdf_dielectric_size(const Bsdf* bsdf) { return bsdf_glass_size(bsdf); }

static inline real3 bsdf_dielectric_albedo(const Bsdf* bsdf) { return bsdf_glass_albedo(bsdf); }

/* Adds one facet's light and that of more, where the lobe is chosen with probability `choose`. */
static inline void bsdf_glass_add(const Bsdf* bsdf, real3 wi, real choose, BsdfValue single, BsdfValue* sum)
{
    single.pdf_w *= choose - bsdf->choose_multiple;
    if (bsdf->choose_multiple != REAL(0.0) && wi.z != REAL(0.0)) {
        single.value += bsdf_energy_multiple_glass(bsdf, wi);
        const real side = wi.z > REAL(0.0) ? bsdf->multiple_reflects : REAL(1.0) - bsdf->multiple_reflects;
        single.pdf_w = fma(bsdf->choose_multiple * side, bsdf_energy_multiple_pdf_w(), single.pdf_w);
    }
    sum->value += single.value;
    sum->pdf_w += single.pdf_w;
}

/* The half vector of wo and wi on the normal's side, and the squared length of the sum that it is made from;
   both zero where there is none. */
static inline real3 bsdf_dielectric_half(const Bsdf* bsdf, real3 wi, real* length_squared)
{
    const real3 sum = wi.z > REAL(0.0) ? bsdf->wo + wi : bsdf->eta * bsdf->wo + wi;
    *length_squared = vector_dot(sum, sum);
    if (!(*length_squared > REAL(0.0)))
        return (real3)(REAL(0.0));
    return sum * (copysign(REAL(1.0), sum.z) / real_sqrt(*length_squared));
}

/* One facet of a rough boundary: BSDF times |cos_i| and the density of sampling wi. */
static inline BsdfValue bsdf_dielectric_eval_single(const Bsdf* bsdf, real3 wi)
{
    BsdfValue result = bsdf_value_none();
    const real3 wo = bsdf->wo;
    real length_squared;
    const real3 h = bsdf_dielectric_half(bsdf, wi, &length_squared);
    const real cos_oh = vector_dot(wo, h);
    const real cos_ih = vector_dot(wi, h);
    /* wo must see the front of the microfacet, wi the side that matches. */
    if (!(wo.z > MICROFACET_SMALLEST_COS) || wi.z == REAL(0.0) || !(cos_oh > REAL(0.0)) ||
        cos_ih * wi.z <= REAL(0.0))
        return result;
    real cos_t;
    const real f = fresnel_dielectric(cos_oh, bsdf->eta, &cos_t);
    const real lambda_o = microfacet_lambda(wo, bsdf->alpha_x, bsdf->alpha_y);
    const real lambda_i = microfacet_lambda(wi, bsdf->alpha_x, bsdf->alpha_y);
    const real d_over_cos = microfacet_d(h, bsdf->alpha_x, bsdf->alpha_y) / wo.z;
    const real g1 = REAL(1.0) / (REAL(1.0) + lambda_o);
    const real g2 = REAL(1.0) / (REAL(1.0) + lambda_o + lambda_i);
    if (wi.z > REAL(0.0)) {
        result.value = bsdf_glass_color(bsdf) * (REAL(0.25) * f * d_over_cos * g2);
        result.pdf_w = REAL(0.25) * f * d_over_cos * g1;
        return result;
    }
    /* Walter et al., eq. 17: density of wi per density of h. Its denominator eta cos_oh + cos_ih is the
       length of the sum. */
    const real spread = (REAL(1.0) - f) * d_over_cos * cos_oh * fabs(cos_ih) / length_squared;
    /* Eq. 21 times cos_i; the index on wi's side cancels. */
    result.value = bsdf->transmission * bsdf_cross(bsdf, spread * g2);
    result.pdf_w = spread * g1;
    return result;
}

static inline void bsdf_dielectric_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    if (bsdf_dielectric_is_delta(bsdf))
        return;
    const BsdfValue single = bsdf_dielectric_eval_single(bsdf, wi);
    bsdf_glass_add(bsdf, wi, bsdf->choose[LOBE_ROW_DIELECTRIC], single, sum);
}

/* Samples light of more than one facet, to both sides. */
static inline real3 bsdf_glass_sample_multiple(const Bsdf* bsdf, uint lobe, bool reflects, real2 u,
                                               BsdfSample* sample)
{
    TRACE_SET(sample->lobe, reflects ? lobe : lobe | TRACE_LOBE_REFRACTS);
    real3 wi = bsdf_energy_multiple_sample(u);
    wi.z = reflects ? wi.z : -wi.z;
    sample->eta = reflects ? REAL(1.0) : bsdf_crossed_eta(bsdf);
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

/* A sampled facet, and the way that light goes there. */
typedef struct {
    real3 normal;
    real cos_o, cos_t; /* to wo, and to the refracted ray */
    real forced;       /* what its weight is multiplied by: F or 1 - F where the other way is closed, else 1 */
    bool reflects;
} GlassFacet;

/* Samples a facet of a lobe of glass, which reflects with probability F, by the number u_way in (0, 1). */
static inline GlassFacet bsdf_glass_facet(const Bsdf* bsdf, uint lobe, real u_way, real2 u,
                                          BsdfSample* sample)
{
    GlassFacet facet;
    facet.normal = bsdf->alpha_x == REAL(0.0)
                       ? vector_make(REAL(0.0), REAL(0.0), REAL(1.0))
                       : microfacet_sample(bsdf->wo, bsdf->alpha_x, bsdf->alpha_y, u);
    facet.cos_o = clamp(vector_dot(bsdf->wo, facet.normal), REAL(0.0), REAL(1.0));
    const real f = fresnel_dielectric(facet.cos_o, bsdf->eta, &facet.cos_t);
    const real choose = bsdf_dielectric_choose(bsdf, f);
    facet.reflects = u_way < choose;
    facet.forced = REAL(1.0);
    if (HAS(EFFECT_PATH_FILTER) && choose != f)
        facet.forced = facet.reflects ? f : REAL(1.0) - f;
    TRACE_SET(sample->lobe, facet.reflects ? lobe : lobe | TRACE_LOBE_REFRACTS);
    return facet;
}

static inline real3 bsdf_dielectric_sample_single(const Bsdf* bsdf, real u_way, real2 u, BsdfSample* sample)
{
    const real3 wo = bsdf->wo;
    const bool smooth = bsdf_dielectric_is_delta(bsdf);
    const GlassFacet facet = bsdf_glass_facet(bsdf, LOBE_DIELECTRIC, u_way, u, sample);
    const bool reflects = facet.reflects;
    const real3 wi = reflects ? REAL(2.0) * facet.cos_o * facet.normal - wo
                              : fresnel_refract(wo, facet.normal, facet.cos_o, facet.cos_t, bsdf->eta);
    /* A microfacet may send light through the macroscopic surface the wrong way, and the horizon sees none:
       such paths end. */
    sample->is_weighted = true;
    if ((wi.z > REAL(0.0)) != reflects || !(wo.z > MICROFACET_SMALLEST_COS))
        return wi;
    sample->eta = reflects ? REAL(1.0) : bsdf->eta;
    sample->is_weighted = smooth || (bsdf->lobes == LOBE_DIELECTRIC &&
                                     bsdf->choose_multiple == REAL(0.0) && !bsdf_is_covered(bsdf));
    if (!sample->is_weighted)
        return wi;
    sample->weight = reflects ? bsdf_glass_color(bsdf) : bsdf->transmission * bsdf_cross(bsdf, REAL(1.0));
    sample->weight *= facet.forced;
    if (HAS(EFFECT_DISPERSION))
        sample->weight *= dispersion_factor(bsdf, reflects, facet.cos_o);
    if (!smooth) {
        sample->weight *= microfacet_g2(wo, wi, bsdf->alpha_x, bsdf->alpha_y) /
                          microfacet_g1(wo, bsdf->alpha_x, bsdf->alpha_y);
        sample->pdf_w = bsdf_dielectric_eval_single(bsdf, wi).pdf_w;
    } else
        sample->weight /= bsdf->choose[LOBE_ROW_DIELECTRIC];
    return wi;
}

static inline real3 bsdf_dielectric_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    const real multiple = bsdf_dielectric_is_delta(bsdf) ? REAL(0.0) : bsdf->choose_multiple;
    const real share = choice.u - choice.before;
    if (HAS(EFFECT_ROUGH_REFRACTION) && share < multiple)
        return bsdf_glass_sample_multiple(bsdf, LOBE_DIELECTRIC, share < multiple * bsdf->multiple_reflects, u,
                                          sample);
    const real u_way = (share - multiple) / (bsdf->choose[LOBE_ROW_DIELECTRIC] - multiple);
    return bsdf_dielectric_sample_single(bsdf, u_way, u, sample);
}

#endif
