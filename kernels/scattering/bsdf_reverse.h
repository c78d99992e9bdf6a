// SPDX-License-Identifier: Apache-2.0
// Densities of the reverse direction, which methods that build paths from both ends weigh with: that of
// sampling wo where light is looked at from wi. What a BSDF says of directions depends on whence it is seen
// (the lobes' probabilities, the index ratio, the side), so it is set once more for wi; that serves every
// lobe, and any mixture. Where nothing but a matte lobe and a rough reflection are, the little is found that
// their densities need.
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

/* True where there is a rough reflection and, below it or not, a matte lobe, and nothing else. */
static inline bool bsdf_reverse_is_opaque(const Bsdf* bsdf)
{
    return HAS(EFFECT_GLOSSY) && (bsdf->lobes & BSDF_LOBES & ~LOBE_MATTE) == LOBE_GLOSSY &&
           !bsdf_is_part_glass(bsdf);
}

/* The density of sampling wo from a local direction wi where that is so. */
static CLRT_NOINLINE real bsdf_reverse_pdf_w_opaque(const Bsdf* bsdf, real3 wi)
{
    if (!(wi.z > REAL(0.0)))
        return REAL(0.0);
    const Albedo albedo = bsdf_energy_needed_albedo(bsdf, bsdf_energy_is_coupled(bsdf), wi);
    const bool is_matte = (bsdf->lobes & LOBE_MATTE) != 0u;
    real matte = is_matte ? bsdf_energy_matte_size(bsdf, albedo) : REAL(0.0);
    real single = vector_color_size(bsdf_reflection_color(bsdf, wi.z));
    const real multiple = bsdf->multiple_color * albedo.loss;
    if (matte + single + multiple == REAL(0.0)) /* as bsdf_choose_lobes */
        *(is_matte ? &matte : &single) = REAL(1.0);
    return (matte * bsdf_matte_pdf_w(bsdf->wo) + single * bsdf_glossy_pdf_w_single(bsdf, wi, bsdf->wo) +
            multiple * bsdf_energy_multiple_pdf_w()) /
           (matte + single + multiple);
}

/* Density per steradian of sampling wo from a world direction wi; 0 for delta lobes. */
static inline real bsdf_pdf_w_reverse(const Bsdf* bsdf, real3 wi_world)
{
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    /* One lobe that looks the same from everywhere needs nothing set. */
    if ((bsdf->lobes & BSDF_LOBES) == LOBE_MATTE)
        return wi.z > REAL(0.0) ? warp_cosine_hemisphere_pdf_w(bsdf->wo.z) : REAL(0.0);
    if (bsdf_reverse_is_opaque(bsdf))
        return bsdf_reverse_pdf_w_opaque(bsdf, wi);
    Bsdf reversed;
    bsdf_set_reversed(bsdf, wi, &reversed);
    return bsdf_eval(&reversed, frame_to_world(&bsdf->frame, bsdf->wo)).pdf_w;
}

#endif
