// SPDX-License-Identifier: Apache-2.0
// Lambert's lobe: radiance reflected alike in all directions. Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_MATTE_H
#define CLRT_SCATTERING_BSDF_MATTE_H

#include "bsdf_types.h"
#include "numerics/warp.h"

/* BSDF times cos_i. */
static inline real3 bsdf_matte_eval(real3 reflectance, real3 wi)
{
    return reflectance * (fmax(wi.z, REAL(0.0)) * REAL_INVERSE_PI);
}

static inline real3 bsdf_matte_sample(real2 u) { return warp_cosine_hemisphere(u); }

static inline real bsdf_matte_pdf_w(real3 wi) { return warp_cosine_hemisphere_pdf_w(wi.z); }

#endif
