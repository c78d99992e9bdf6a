// SPDX-License-Identifier: Apache-2.0
// Lambert's lobe: radiance reflected alike in all directions, but for what a reflection above it takes. Local
// directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_MATTE_H
#define CLRT_SCATTERING_BSDF_MATTE_H

#include "bsdf_energy.h"
#include "numerics/warp.h"

static inline bool bsdf_matte_is_delta(const Bsdf* bsdf) { return false; }

static inline real bsdf_matte_size(const Bsdf* bsdf) { return bsdf->matte_size; }

/* What a reflection above leaves head-on, as Fresnel's does. */
static inline real3 bsdf_matte_albedo(const Bsdf* bsdf)
{
    return (bsdf->flags & BSDF_COUPLED) ? bsdf->matte * ((real3)(REAL(1.0)) - bsdf->specular) : bsdf->matte;
}

/* BSDF times cos_i, as if nothing reflected above it. */
static inline real3 bsdf_matte_uncoupled(const Bsdf* bsdf, real3 wi)
{
    return bsdf->matte * (fmax(wi.z, REAL(0.0)) * REAL_INVERSE_PI);
}

/* BSDF times cos_i. */
static inline real3 bsdf_matte_eval(const Bsdf* bsdf, real3 wi)
{
    const real3 value = bsdf_matte_uncoupled(bsdf, wi);
    return bsdf_energy_is_coupled(bsdf) ? value * bsdf_energy_coupling(bsdf, wi) : value;
}

/* The same over the density of bsdf_matte_sample. */
static inline real3 bsdf_matte_weight(const Bsdf* bsdf, real3 wi)
{
    return bsdf_energy_is_coupled(bsdf) ? bsdf->matte * bsdf_energy_coupling(bsdf, wi) : bsdf->matte;
}

static inline real bsdf_matte_pdf_w(real3 wi) { return warp_cosine_hemisphere_pdf_w(wi.z); }

static inline void bsdf_matte_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    sum->value += bsdf_matte_eval(bsdf, wi);
    sum->pdf_w += bsdf->choose[LOBE_ROW_MATTE] * bsdf_matte_pdf_w(wi);
}

/* Alone, it is sampled exactly. */
static inline real3 bsdf_matte_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    const real3 wi = warp_cosine_hemisphere(u);
    TRACE_SET(sample->lobe, LOBE_MATTE);
    sample->is_weighted = bsdf->lobes == LOBE_MATTE && !bsdf_is_covered(bsdf);
    if (!sample->is_weighted)
        return wi;
    sample->pdf_w = bsdf_matte_pdf_w(wi);
    /* Along the horizon there is no sample: a density of 0 would say that the lobe is a delta function. */
    sample->weight = sample->pdf_w > REAL(0.0) ? bsdf_matte_weight(bsdf, wi) : (real3)(REAL(0.0));
    return wi;
}

#endif
