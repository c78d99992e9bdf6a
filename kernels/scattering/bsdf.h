// SPDX-License-Identifier: Apache-2.0
// The BSDF of a material: the sum of its lobes. Lobes are chosen by their weight; where lobes overlap, the density is
// that of the mixture. Nothing passes where shading and geometric normal disagree about the side.
#ifndef CLRT_SCATTERING_BSDF_H
#define CLRT_SCATTERING_BSDF_H

#include "bsdf_dielectric.h"
#include "bsdf_glossy.h"
#include "bsdf_matte.h"

/* True if some lobe is no delta function, so that connecting to a light can succeed. */
static inline bool bsdf_has_smooth_lobe(const Bsdf* bsdf)
{
    if (bsdf->lobes & (LOBE_MATTE | LOBE_GLOSSY))
        return true;
    return HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC) && bsdf->alpha_x > REAL(0.0);
}

/* True if the world direction and its local form are on the same side of both normals. */
static inline bool bsdf_sides_agree(const Bsdf* bsdf, real3 wi_world, real3 wi)
{
    return (vector_dot(wi_world, bsdf->normal_g) > REAL(0.0)) == (wi.z > REAL(0.0));
}

/* BSDF times |cos_i| of all lobes that are no delta functions. World directions. */
static inline real3 bsdf_eval(const Bsdf* bsdf, real3 wo_world, real3 wi_world)
{
    const real3 wo = frame_to_local(&bsdf->frame, wo_world);
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    real3 value = (real3)(REAL(0.0));
    if (!bsdf_sides_agree(bsdf, wi_world, wi))
        return value;
    if (HAS(EFFECT_MATTE) && (bsdf->lobes & LOBE_MATTE))
        value += bsdf_matte_eval(bsdf->matte, wi);
    if (HAS(EFFECT_GLOSSY) && (bsdf->lobes & LOBE_GLOSSY))
        value += bsdf_glossy_eval(bsdf, wo, wi);
    if (HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC))
        value += bsdf_dielectric_eval(bsdf, wo, wi);
    return value;
}

/* Density of bsdf_sample, delta lobes left out. World directions. */
static inline real bsdf_pdf_w(const Bsdf* bsdf, real3 wo_world, real3 wi_world)
{
    const real3 wo = frame_to_local(&bsdf->frame, wo_world);
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    real pdf_w = REAL(0.0);
    if (HAS(EFFECT_MATTE) && (bsdf->lobes & LOBE_MATTE))
        pdf_w += bsdf->choose_matte * bsdf_matte_pdf_w(wi);
    if (HAS(EFFECT_GLOSSY) && (bsdf->lobes & LOBE_GLOSSY))
        pdf_w += bsdf->choose_glossy * bsdf_glossy_pdf_w(bsdf, wo, wi);
    if (HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC))
        pdf_w += bsdf_dielectric_pdf_w(bsdf, wo, wi);
    return pdf_w;
}

/* Sets the lobes' probabilities by how much each reflects towards wo. */
static inline void bsdf_choose_lobes(Bsdf* bsdf, real3 wo)
{
    bsdf->choose_matte = REAL(0.0);
    bsdf->choose_glossy = REAL(0.0);
    if (bsdf->lobes & LOBE_DIELECTRIC)
        return;
    const real cos_o = clamp(vector_dot(bsdf->frame.z, wo), REAL(0.0), REAL(1.0));
    const real matte = (bsdf->lobes & LOBE_MATTE) ? vector_luminance(bsdf->matte) : REAL(0.0);
    const real reflection = (bsdf->lobes & (LOBE_GLOSSY | LOBE_MIRROR))
                                ? vector_luminance(bsdf_reflection_color(bsdf, cos_o))
                                : REAL(0.0);
    const real sum = matte + reflection;
    if (!(sum > REAL(0.0)))
        return;
    bsdf->choose_matte = matte / sum;
    bsdf->choose_glossy = (bsdf->lobes & LOBE_GLOSSY) ? reflection / sum : REAL(0.0);
}

/* Samples a delta reflection or a dielectric. */
static inline void bsdf_sample_specular(const Bsdf* bsdf, real3 wo, real u_lobe, real2 u, real3* wi, BsdfSample* sample)
{
    if (HAS(EFFECT_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC)) {
        *wi = bsdf_dielectric_sample(bsdf, wo, u_lobe, u, &sample->weight, &sample->eta);
        sample->is_delta = !HAS(EFFECT_ROUGH_REFRACTION) || bsdf->alpha_x == REAL(0.0);
        return;
    }
    const real choose = REAL(1.0) - bsdf->choose_matte;
    *wi = vector_make(-wo.x, -wo.y, wo.z);
    sample->weight = bsdf_reflection_color(bsdf, wo.z) / choose;
    sample->is_delta = true;
}

/* Samples a direction. u_lobe chooses the lobe, u the direction. */
static CLRT_NOINLINE BsdfSample bsdf_sample(const Bsdf* bsdf, real3 wo_world, real u_lobe, real2 u)
{
    const real3 wo = frame_to_local(&bsdf->frame, wo_world);
    BsdfSample sample;
    sample.pdf_w = REAL(0.0);
    sample.eta = REAL(1.0);
    sample.is_delta = false;
    sample.is_valid = false;
    sample.weight = (real3)(REAL(0.0));
    if (bsdf->lobes == 0u)
        return sample;
    real3 wi = (real3)(REAL(0.0));
    const bool matte = HAS(EFFECT_MATTE) && u_lobe < bsdf->choose_matte;
    const bool glossy = HAS(EFFECT_GLOSSY) && !matte && bsdf->choose_glossy > REAL(0.0);
    if (matte)
        wi = bsdf_matte_sample(u);
    else if (glossy)
        wi = bsdf_glossy_sample(bsdf, wo, u);
    else if (HAS(EFFECT_MIRROR | EFFECT_REFRACTION))
        bsdf_sample_specular(bsdf, wo, u_lobe, u, &wi, &sample);

    sample.wi = frame_to_world(&bsdf->frame, wi);
    if (!bsdf_sides_agree(bsdf, sample.wi, wi))
        return sample;
    if (!sample.is_delta) {
        sample.pdf_w = bsdf_pdf_w(bsdf, wo_world, sample.wi);
        if (!(sample.pdf_w > REAL(0.0)))
            return sample;
        /* The dielectric's weight is already complete, and better conditioned. */
        if (!(bsdf->lobes & LOBE_DIELECTRIC))
            sample.weight = bsdf_eval(bsdf, wo_world, sample.wi) / sample.pdf_w;
    }
    sample.is_valid = !vector_is_zero(sample.weight);
    return sample;
}

#endif
