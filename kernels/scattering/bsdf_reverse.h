// SPDX-License-Identifier: Apache-2.0
// Densities of the reverse direction, which methods that build paths from both ends weigh with: that of
// sampling wo where light is looked at from wi. What a BSDF says of directions depends on whence it is seen
// (the lobes' probabilities, the index ratio, the side), so it is set once more for wi; that serves every
// lobe, and any mixture.
#ifndef CLRT_SCATTERING_BSDF_REVERSE_H
#define CLRT_SCATTERING_BSDF_REVERSE_H

#include "bsdf.h"

/* The same point of the surface as seen from a local direction. The lobes must be those of the material: a
   path filter's BSDF (path/filter.h) no longer knows what lay above the matte lobe. */
static CLRT_NOINLINE void bsdf_set_reversed(const Bsdf* bsdf, real3 wi, Bsdf* reversed)
{
    *reversed = *bsdf;
    reversed->wo = wi;
    if (wi.z < REAL(0.0)) {
        /* Half a turn about x takes the normal to wi's side. A surface that bulges there is hollow here. */
        reversed->frame.y = -bsdf->frame.y;
        reversed->frame.z = -bsdf->frame.z;
        reversed->wo = vector_make(wi.x, -wi.y, -wi.z);
        reversed->normal_g = -bsdf->normal_g;
        reversed->normal_s = -bsdf->normal_s;
        reversed->is_curved = false;
        if (!(HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE)))
            reversed->eta = REAL(1.0) / bsdf->eta;
        if (HAS(EFFECT_COAT | EFFECT_SHEEN) && (bsdf->lobes & LOBE_DIELECTRIC))
            reversed->flags ^= BSDF_INSIDE;
    }
    bsdf_energy_set(reversed);
    bsdf_choose_lobes(reversed);
}

/* Density per steradian of sampling wo from a world direction wi; 0 for delta lobes. */
static inline real bsdf_pdf_w_reverse(const Bsdf* bsdf, real3 wi_world)
{
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    /* One lobe that looks the same from everywhere needs nothing set. */
    if ((bsdf->lobes & BSDF_LOBES) == LOBE_MATTE)
        return wi.z > REAL(0.0) ? warp_cosine_hemisphere_pdf_w(bsdf->wo.z) : REAL(0.0);
    Bsdf reversed;
    bsdf_set_reversed(bsdf, wi, &reversed);
    return bsdf_eval(&reversed, frame_to_world(&bsdf->frame, bsdf->wo)).pdf_w;
}

#endif
