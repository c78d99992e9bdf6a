// SPDX-License-Identifier: Apache-2.0
// The BSDF of a material: the sum of its lobes. Lobes are chosen by their weight; where lobes overlap, the density is
// that of the mixture. Nothing passes where the shading normal and the surface disagree about the side.
#ifndef CLRT_SCATTERING_BSDF_H
#define CLRT_SCATTERING_BSDF_H

#include "bsdf_dielectric.h"
#include "bsdf_glossy.h"
#include "bsdf_matte.h"
#include "geometry/surface.h"

/* True if some lobe is no delta function, so that connecting to a light can succeed. */
static inline bool bsdf_has_smooth_lobe(const Bsdf* bsdf)
{
    if (bsdf->lobes & (LOBE_MATTE | LOBE_GLOSSY))
        return true;
    return (bsdf->lobes & LOBE_DIELECTRIC) && !bsdf_dielectric_is_smooth(bsdf);
}

/* True if a world direction is on wo's side of the surface. */
static inline bool bsdf_reflects(const Bsdf* bsdf, real3 wi_world)
{
    return surface_side(bsdf->normal_g, bsdf->normal_s, bsdf->is_curved, wi_world);
}

/* True if a world direction is on the side of the surface that its local form is on in the frame, which a map may tilt. */
static inline bool bsdf_sides_agree(const Bsdf* bsdf, real3 wi_world, real3 wi)
{
    return bsdf_reflects(bsdf, wi_world) == (wi.z > REAL(0.0));
}

/* Sum of the lobes and density of the mixture; wi local, sides already compared. */
static inline BsdfValue bsdf_eval_local(const Bsdf* bsdf, real3 wi)
{
    BsdfValue sum;
    sum.value = (real3)(REAL(0.0));
    sum.pdf_w = REAL(0.0);
    if (HAS(EFFECT_MATTE) && (bsdf->lobes & LOBE_MATTE)) {
        sum.value = bsdf_matte_eval(bsdf, wi);
        sum.pdf_w = bsdf->choose_matte * bsdf_matte_pdf_w(wi);
    }
    if (HAS(EFFECT_GLOSSY) && (bsdf->lobes & LOBE_GLOSSY)) {
        const BsdfValue glossy = bsdf_glossy_eval(bsdf, wi);
        sum.value += glossy.value;
        sum.pdf_w += glossy.pdf_w;
    }
    if (HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC))
        sum = bsdf_dielectric_eval(bsdf, wi);
    return sum;
}

/* The same for a world direction. */
static inline BsdfValue bsdf_eval(const Bsdf* bsdf, real3 wi_world)
{
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    if (bsdf_sides_agree(bsdf, wi_world, wi))
        return bsdf_eval_local(bsdf, wi);
    BsdfValue none;
    none.value = (real3)(REAL(0.0));
    none.pdf_w = REAL(0.0);
    return none;
}

/* Sets the lobes' probabilities by how much each reflects towards wo. */
static inline void bsdf_choose_lobes(Bsdf* bsdf)
{
    bsdf->choose_matte = (bsdf->lobes == LOBE_MATTE) ? REAL(1.0) : REAL(0.0);
    bsdf->choose_glossy = REAL(0.0);
    bsdf->choose_multiple = REAL(0.0);
    if (HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC))
        bsdf->choose_multiple = bsdf->multiple_size;
    if (!HAS(EFFECT_GLOSSY | EFFECT_MIRROR) || !(bsdf->lobes & (LOBE_GLOSSY | LOBE_MIRROR)))
        return;
    const bool glossy = HAS(EFFECT_GLOSSY) && (bsdf->lobes & LOBE_GLOSSY);
    const real matte = (bsdf->lobes & LOBE_MATTE) ? bsdf->matte_size : REAL(0.0);
    const real multiple = glossy ? bsdf->multiple_size : REAL(0.0);
    const real sum = matte + multiple + vector_color_size(bsdf_reflection_color(bsdf, bsdf->wo.z));
    /* Where nothing is reflected, the matte lobe stands for nothing as well as the others. */
    const bool is_dark = sum == REAL(0.0);
    bsdf->choose_matte = !is_dark ? matte / sum : (bsdf->lobes & LOBE_MATTE) ? REAL(1.0) : REAL(0.0);
    bsdf->choose_multiple = !is_dark ? multiple / sum : REAL(0.0);
    bsdf->choose_glossy = glossy ? REAL(1.0) - bsdf->choose_matte - bsdf->choose_multiple : REAL(0.0);
}

/* Completes a sample of the matte or the glossy lobe: density and weight of the mixture. */
static inline void bsdf_complete(const Bsdf* bsdf, real3 wi, BsdfSample* sample)
{
    /* Alone, Lambert's lobe is sampled exactly. */
    if (bsdf->lobes == LOBE_MATTE) {
        sample->pdf_w = bsdf_matte_pdf_w(wi);
        /* Along the horizon there is no sample: a density of 0 would say that the lobe is a delta function. */
        sample->weight = sample->pdf_w > REAL(0.0) ? bsdf_matte_weight(bsdf, wi) : (real3)(REAL(0.0));
        return;
    }
    const BsdfValue eval = bsdf_eval_local(bsdf, wi);
    sample->pdf_w = eval.pdf_w;
    sample->weight = eval.pdf_w == REAL(0.0) ? (real3)(REAL(0.0)) : eval.value / eval.pdf_w;
}

/* Samples a direction. u_lobe chooses the lobe, u the direction. */
static CLRT_NOINLINE BsdfSample bsdf_sample(const Bsdf* bsdf, real u_lobe, real2 u)
{
    BsdfSample sample;
    sample.pdf_w = REAL(0.0);
    sample.eta = REAL(1.0);
    sample.weight = (real3)(REAL(0.0));
    TRACE_SET(sample.lobe, 0u);
    real3 wi = (real3)(REAL(0.0));
    if (HAS(EFFECT_MATTE) && u_lobe < bsdf->choose_matte) {
        TRACE_SET(sample.lobe, LOBE_MATTE);
        wi = bsdf_matte_sample(u);
        bsdf_complete(bsdf, wi, &sample);
    } else if (HAS(EFFECT_GLOSSY) && (bsdf->lobes & LOBE_GLOSSY)) {
        TRACE_SET(sample.lobe, LOBE_GLOSSY);
        wi = u_lobe < bsdf->choose_matte + bsdf->choose_multiple ? bsdf_energy_multiple_sample(u)
                                                                 : bsdf_glossy_sample(bsdf, u);
        bsdf_complete(bsdf, wi, &sample);
    } else if (HAS(EFFECT_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC)) {
        wi = bsdf_dielectric_sample(bsdf, u_lobe, u, &sample);
    } else if (HAS(EFFECT_MIRROR) && (bsdf->lobes & LOBE_MIRROR)) {
        TRACE_SET(sample.lobe, LOBE_MIRROR);
        wi = vector_make(-bsdf->wo.x, -bsdf->wo.y, bsdf->wo.z);
        sample.weight = bsdf_reflection_color(bsdf, bsdf->wo.z) / (REAL(1.0) - bsdf->choose_matte);
    }
    sample.wi = frame_to_world(&bsdf->frame, wi);
    sample.reflects = bsdf_reflects(bsdf, sample.wi);
    sample.is_valid = !vector_is_black(sample.weight) && sample.reflects == (wi.z > REAL(0.0));
    return sample;
}

#endif
