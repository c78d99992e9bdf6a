// SPDX-License-Identifier: Apache-2.0
// Lambert's lobe: radiance reflected alike in all directions, but for what a reflection above it takes. Local directions, z is
// the normal.
#ifndef CLRT_SCATTERING_BSDF_MATTE_H
#define CLRT_SCATTERING_BSDF_MATTE_H

#include "bsdf_energy.h"
#include "numerics/warp.h"

/* BSDF times cos_i. */
static inline real3 bsdf_matte_eval(const Bsdf* bsdf, real3 wi)
{
    const real3 value = bsdf->matte * (fmax(wi.z, REAL(0.0)) * REAL_INVERSE_PI);
    return bsdf_energy_is_coupled(bsdf) ? value * bsdf_energy_coupling(bsdf, wi) : value;
}

/* The same over the density of bsdf_matte_sample. */
static inline real3 bsdf_matte_weight(const Bsdf* bsdf, real3 wi)
{
    return bsdf_energy_is_coupled(bsdf) ? bsdf->matte * bsdf_energy_coupling(bsdf, wi) : bsdf->matte;
}

static inline real3 bsdf_matte_sample(real2 u) { return warp_cosine_hemisphere(u); }

static inline real bsdf_matte_pdf_w(real3 wi) { return warp_cosine_hemisphere_pdf_w(wi.z); }

#endif
