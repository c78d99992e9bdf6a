// SPDX-License-Identifier: Apache-2.0
// Rough reflection by GGX microfacets, sampled by visible normals. Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_GLOSSY_H
#define CLRT_SCATTERING_BSDF_GLOSSY_H

#include "bsdf_types.h"
#include "fresnel.h"
#include "microfacet.h"

/* The colour of a reflection whose half vector meets the directions at this cosine. */
static inline real3 bsdf_reflection_color(const Bsdf* bsdf, real cos_h)
{
    return bsdf->fresnel == FRESNEL_SCHLICK ? fresnel_schlick(bsdf->specular, cos_h) : bsdf->specular;
}

/* BSDF times cos_i (Walter et al. 2007, eq. 20). */
static inline real3 bsdf_glossy_eval(const Bsdf* bsdf, real3 wo, real3 wi)
{
    if (!(wo.z > REAL(0.0) && wi.z > REAL(0.0)))
        return (real3)(REAL(0.0));
    const real3 h = vector_normalize(wo + wi);
    const real d = microfacet_d(h, bsdf->alpha_x, bsdf->alpha_y);
    const real g = microfacet_g2(wo, wi, bsdf->alpha_x, bsdf->alpha_y);
    return bsdf_reflection_color(bsdf, vector_dot(wo, h)) * (d * g / (REAL(4.0) * wo.z));
}

/* A reflected direction; z <= 0 means that none was found. */
static inline real3 bsdf_glossy_sample(const Bsdf* bsdf, real3 wo, real2 u)
{
    const real3 h = microfacet_sample(wo, bsdf->alpha_x, bsdf->alpha_y, u);
    return REAL(2.0) * vector_dot(wo, h) * h - wo;
}

static inline real bsdf_glossy_pdf_w(const Bsdf* bsdf, real3 wo, real3 wi)
{
    if (!(wo.z > REAL(0.0) && wi.z > REAL(0.0)))
        return REAL(0.0);
    const real3 h = vector_normalize(wo + wi);
    /* Density of h over the Jacobian 4 wo.h of the reflection; wo.h cancels. */
    return microfacet_g1(wo, bsdf->alpha_x, bsdf->alpha_y) * microfacet_d(h, bsdf->alpha_x, bsdf->alpha_y) /
           (REAL(4.0) * wo.z);
}

#endif
