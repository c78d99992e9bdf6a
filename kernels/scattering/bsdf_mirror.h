// SPDX-License-Identifier: Apache-2.0
// Reflection by a smooth surface: a delta function. Local directions, z is the normal.
#ifndef CLRT_SCATTERING_BSDF_MIRROR_H
#define CLRT_SCATTERING_BSDF_MIRROR_H

#include "bsdf_energy.h"

static inline bool bsdf_mirror_is_delta(const Bsdf* bsdf) { return true; }

static inline real bsdf_mirror_size(const Bsdf* bsdf)
{
    return vector_color_size(bsdf_reflection_color(bsdf, bsdf->wo.z));
}

static inline real3 bsdf_mirror_albedo(const Bsdf* bsdf) { return bsdf_reflection_albedo(bsdf); }

/* No direction but one, which has no density. */
static inline void bsdf_mirror_add(const Bsdf* bsdf, real3 wi, BsdfValue* sum) {}

static inline real3 bsdf_mirror_sample(const Bsdf* bsdf, BsdfChoice choice, real2 u, BsdfSample* sample)
{
    TRACE_SET(sample->lobe, LOBE_MIRROR);
    sample->is_weighted = true;
    sample->weight = bsdf_reflection_color(bsdf, bsdf->wo.z) / bsdf->choose[LOBE_ROW_MIRROR];
    return vector_make(-bsdf->wo.x, -bsdf->wo.y, bsdf->wo.z);
}

#endif
