// SPDX-License-Identifier: Apache-2.0
// What keeps the lobes of a BSDF from losing and from creating light. All of it is reciprocal and built from
// directional albedos (albedo.h); a white surface under a white sky is white.
//
// Between rough facets light is reflected more than once. What the first facet does not send on, the loss
// L(wo), leaves with the cosine lobe L(wo) L(wi) / (pi mean(L)), times the colour that it takes on the way
// (Kelemen and Szirmay-Kalos 2001; Kulla and Conty 2017). At a dielectric it leaves on both sides.
//
// Below a reflection by Schlick's Fresnel lies the matte lobe. It gets what the reflection does not take and
// gives it back the same way: f_matte = Kd/pi (1 - E(wo)) (1 - E(wi)) / (1 - mean(E)) with the reflection's
// albedo E. Every 1 - E has the factor 1 - F0: 1 - E = (1 - F0) g, g(w) = 1 - B(w) + c L(w), c = (F0 - F_ms)
// / (1 - F0), so F0 = 1 needs no care.
//
// A stretched rough dielectric has no table and loses what it lost.
#ifndef CLRT_SCATTERING_BSDF_ENERGY_H
#define CLRT_SCATTERING_BSDF_ENERGY_H

#include "albedo.h"
#include "bsdf_cover.h"
#include "bsdf_types.h"
#include "fresnel.h"
#include "numerics/warp.h"

/* The colour of a reflection whose half vector meets the directions at this cosine. */
static inline real3 bsdf_reflection_color(const Bsdf* bsdf, real cos_h)
{
    if (HAS(EFFECT_CONDUCTOR) && bsdf->fresnel == FRESNEL_CONDUCTOR)
        return fresnel_conductor_color(cos_h, bsdf->transmission, bsdf->specular);
    const real3 color =
        bsdf->fresnel == FRESNEL_SCHLICK ? fresnel_schlick(bsdf->specular, cos_h) : bsdf->specular;
    return bsdf_is_part_glass(bsdf) ? color * (REAL(1.0) - bsdf->glass) : color;
}

/* The same head-on. */
static inline real3 bsdf_reflection_albedo(const Bsdf* bsdf)
{
    return HAS(EFFECT_CONDUCTOR | EFFECT_PART_GLASS) ? bsdf_reflection_color(bsdf, REAL(1.0))
                                                     : bsdf->specular;
}

/* The facets' reflectance in light from everywhere. */
static inline real3 bsdf_energy_facet_mean(const Bsdf* bsdf)
{
    if (HAS(EFFECT_CONDUCTOR) && bsdf->fresnel == FRESNEL_CONDUCTOR)
        return fresnel_conductor_mean(bsdf->transmission, bsdf->specular);
    return bsdf->fresnel == FRESNEL_SCHLICK ? fresnel_schlick_mean(bsdf->specular) : bsdf->specular;
}

/* The albedo of the reflection lobes' facets towards a local direction; a mirror, alpha 0, loses nothing. */
static inline Albedo bsdf_energy_rough_albedo(const AlbedoRoughness* rough, real3 w)
{
    if (HAS(EFFECT_GLOSSY) && rough->alpha > REAL(0.0))
        return albedo_reflection(rough, w);
    Albedo albedo;
    albedo.loss = REAL(0.0);
    albedo.schlick = fresnel_schlick_grazing(fabs(w.z));
    return albedo;
}

/* The same of a BSDF. */
static inline Albedo bsdf_energy_albedo(const Bsdf* bsdf, real3 w)
{
    return bsdf_energy_rough_albedo(&bsdf->rough, w);
}

/* g(w) of the coupling. */
static inline real3 bsdf_energy_rough_passing(real3 passing_loss, Albedo albedo)
{
    return (real3)(REAL(1.0) - albedo.schlick) + passing_loss * albedo.loss;
}

/* The same of a BSDF. */
static inline real3 bsdf_energy_passing(const Bsdf* bsdf, Albedo albedo)
{
    return bsdf_energy_rough_passing(bsdf->passing_loss, albedo);
}

/* True where the matte lobe lies below a reflection that depends on the angle. */
static inline bool bsdf_energy_is_coupled(const Bsdf* bsdf)
{
    return HAS(EFFECT_GLOSSY | EFFECT_MIRROR) && (bsdf->flags & BSDF_COUPLED);
}

/* What the reflection above, of which this is the albedo towards wi, leaves of the matte lobe. */
static inline real3 bsdf_energy_coupling_by(const Bsdf* bsdf, Albedo albedo)
{
    return bsdf->passing * bsdf_energy_passing(bsdf, albedo);
}

/* The same where it is not known. */
static inline real3 bsdf_energy_coupling(const Bsdf* bsdf, real3 wi)
{
    return bsdf_energy_coupling_by(bsdf, bsdf_energy_albedo(bsdf, wi));
}

/* True if this rough lobe holds the light of more than one facet: where glass is as rough as the reflection
   beside it, the glass holds that of both. */
static inline bool bsdf_energy_has_multiple(const Bsdf* bsdf, uint lobe)
{
    if (!bsdf_is_part_glass(bsdf) || lobe != LOBE_GLOSSY)
        return true;
    if (bsdf->lobes & LOBE_PANE)
        return false;
    return !HAS(EFFECT_ROUGH_REFRACTION) || !(bsdf->lobes & LOBE_DIELECTRIC) || bsdf->eta == REAL(1.0);
}

/* Of its probability, what goes to that light. */
static inline real bsdf_energy_multiple_choice(const Bsdf* bsdf, uint lobe)
{
    return bsdf_energy_has_multiple(bsdf, lobe) ? bsdf->choose_multiple : REAL(0.0);
}

/* Light that leaves by way of opaque lobes after more than one facet: BSDF times cos_i, for wi.z > 0, where
   the loss is L(wi). */
static inline real3 bsdf_energy_multiple_by(const Bsdf* bsdf, real loss, real3 wi)
{
    return bsdf->multiple * (loss * wi.z * REAL_INVERSE_PI);
}

/* The same where it is not known. */
static inline real3 bsdf_energy_multiple_reflection(const Bsdf* bsdf, real3 wi)
{
    return bsdf_energy_multiple_by(bsdf, albedo_reflection_loss(&bsdf->rough, wi), wi);
}

/* By way of the glass, and of the reflection beside it: BSDF times |cos_i|. */
static inline real3 bsdf_energy_multiple_glass(const Bsdf* bsdf, real3 wi)
{
    const real cos_i = fabs(wi.z);
    real loss;
    if (HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE))
        loss = albedo_reflection_loss(&bsdf->rough, wi);
    else {
        const real eta = wi.z > REAL(0.0) ? bsdf->eta : REAL(1.0) / bsdf->eta;
        loss = albedo_dielectric_loss(&bsdf->rough, eta, fmin(cos_i, REAL(1.0)));
    }
    const real3 factor = wi.z > REAL(0.0) ? bsdf->multiple_glass : bsdf->multiple_through;
    const real3 value = factor * (loss * cos_i * REAL_INVERSE_PI);
    return HAS(EFFECT_GLOSSY) && bsdf_is_part_glass(bsdf) && wi.z > REAL(0.0)
               ? value + bsdf_energy_multiple_reflection(bsdf, wi)
               : value;
}

/* Samples it: L(wi) cos_i is flat for rough facets and highest near the horizon for smooth ones, so all
   directions of the side are alike. A cosine lobe would meet weights of 1 / alpha^2 there. */
static inline real3 bsdf_energy_multiple_sample(real2 u) { return warp_hemisphere(u); }

static inline real bsdf_energy_multiple_pdf_w(void) { return warp_hemisphere_pdf_w(); }

/* What is needed of the reflection's albedo: without a matte lobe below it the loss alone. */
static inline Albedo bsdf_energy_needed_albedo(const Bsdf* bsdf, bool is_coupled, real3 w)
{
    if (is_coupled)
        return bsdf_energy_albedo(bsdf, w);
    Albedo albedo;
    albedo.loss = albedo_reflection_loss(&bsdf->rough, w);
    albedo.schlick = REAL(0.0);
    return albedo;
}

/* The size of what the matte lobe reflects towards a direction with this albedo, once the rest is set. */
static inline real bsdf_energy_matte_size(const Bsdf* bsdf, Albedo albedo)
{
    if (!bsdf_energy_is_coupled(bsdf))
        return bsdf->matte_size;
    const real3 left = ((real3)(REAL(1.0)) - bsdf->specular) * bsdf_energy_passing(bsdf, albedo);
    return vector_color_size(bsdf->matte * left);
}

/* Of the reflection lobes: the colour of what is reflected more than once, F_avg^2 (1 - l) / (1 - F_avg l)
   with the mean loss l (Kulla and Conty 2017), and the matte lobe's coupling. */
static inline void bsdf_energy_set_reflection(Bsdf* bsdf)
{
    const bool is_glossy = HAS(EFFECT_GLOSSY) && (bsdf->lobes & LOBE_GLOSSY);
    const bool is_coupled = (bsdf->lobes & LOBE_MATTE) && bsdf->fresnel == FRESNEL_SCHLICK;
    bsdf->matte_size = vector_color_size(bsdf->matte);
    if (!is_glossy && !is_coupled)
        return;
    const real3 one = (real3)(REAL(1.0));
    Albedo mean;
    mean.loss = REAL(0.0);
    mean.schlick = FRESNEL_SCHLICK_MEAN;
    real3 color = (real3)(REAL(0.0));
    const real3 facet = bsdf_energy_facet_mean(bsdf);
    if (is_glossy) {
        bsdf->rough = albedo_roughness(bsdf->alpha_x, bsdf->alpha_y);
        mean = albedo_reflection_mean(&bsdf->rough);
        color = facet * facet * (REAL(1.0) - mean.loss) / (one - facet * mean.loss);
    }
    const Albedo albedo = bsdf_energy_needed_albedo(bsdf, is_coupled, bsdf->wo);
    bsdf->multiple = color * (albedo.loss / mean.loss);
    bsdf->multiple_color = vector_color_size(color);
    bsdf->multiple_size = bsdf->multiple_color * albedo.loss;
    if (bsdf_is_part_glass(bsdf)) {
        bsdf->multiple *= REAL(1.0) - bsdf->glass;
        bsdf->multiple_size *= REAL(1.0) - bsdf->glass;
    }
    if (!is_coupled)
        return;
    bsdf->flags |= BSDF_COUPLED;
    /* c with its factor 1 - F0 cancelled: (1 - F_ms) / (1 - F0) - 1. */
    const real seen = REAL(1.0) - mean.loss;
    bsdf->passing_loss =
        (REAL(1.0) - FRESNEL_SCHLICK_MEAN) * (one + facet * seen) / (one - facet * mean.loss) - one;
    bsdf->passing =
        (one - bsdf->specular) * bsdf_energy_passing(bsdf, albedo) / bsdf_energy_passing(bsdf, mean);
    bsdf->matte_size = bsdf_energy_matte_size(bsdf, albedo);
}

/* Adds the glass's light of more than one facet, `loss`, of which `reflects` stays on wo's side, to that of
   the reflection beside it. */
static inline void bsdf_energy_add_glass(Bsdf* bsdf, real loss, real reflects)
{
    if (!bsdf_is_part_glass(bsdf)) {
        bsdf->multiple_size = loss;
        bsdf->multiple_reflects = reflects;
        return;
    }
    const real size = vector_color_size((real3)(bsdf->glass)) * loss;
    const real sum = bsdf->multiple_size + size;
    bsdf->multiple_reflects =
        sum > REAL(0.0) ? fma(size, reflects, bsdf->multiple_size) / sum : REAL(1.0);
    bsdf->multiple_size = sum;
}

/* Of a rough dielectric. The share of what is lost that crosses is 1 - F_avg where both sides lose alike,
   less on the side that loses more: then f / eta^2 is the same in both directions. */
static inline void bsdf_energy_set_dielectric(Bsdf* bsdf)
{
    bsdf->rough = albedo_roughness(bsdf->alpha_x, bsdf->alpha_y);
    const real loss = albedo_dielectric_loss(&bsdf->rough, bsdf->eta, fmin(bsdf->wo.z, REAL(1.0)));
    const real here = albedo_dielectric_mean_loss(&bsdf->rough, bsdf->eta);
    const real there = albedo_dielectric_mean_loss(&bsdf->rough, REAL(1.0) / bsdf->eta);
    const real crossing = (REAL(1.0) - fresnel_dielectric_mean(bsdf->eta)) / fmax(here, there);
    const real crosses = crossing * there;
    bsdf->multiple_glass = bsdf_glass_color(bsdf) * ((REAL(1.0) - crosses) * loss / here);
    bsdf->multiple_through = bsdf->transmission * bsdf_cross(bsdf, crossing * loss);
    bsdf_energy_add_glass(bsdf, loss, REAL(1.0) - crosses);
}

/* Of a rough pane: what passes is spread as what is reflected, so both lose alike. */
static inline void bsdf_energy_set_pane(Bsdf* bsdf)
{
    bsdf->rough = albedo_roughness(bsdf->alpha_x, bsdf->alpha_y);
    const real loss = albedo_reflection_loss(&bsdf->rough, bsdf->wo);
    const real mean = albedo_reflection_mean(&bsdf->rough).loss;
    const real reflects = fresnel_dielectric_mean(bsdf->eta);
    bsdf->multiple_glass = bsdf_glass_color(bsdf) * (reflects * loss / mean);
    bsdf->multiple_through = bsdf->transmission * ((REAL(1.0) - reflects) * loss / mean);
    bsdf_energy_add_glass(bsdf, loss, reflects);
}

/* Sets all of it for wo; the lobes are those of the material, before a path filter takes some away. */
static inline void bsdf_energy_set(Bsdf* bsdf)
{
    bsdf->flags &= ~(BSDF_COUPLED | BSDF_COVERED);
    bsdf->rough.alpha = REAL(0.0);
    bsdf->multiple = bsdf->multiple_glass = bsdf->multiple_through = (real3)(REAL(0.0));
    bsdf->multiple_reflects = REAL(1.0);
    bsdf->multiple_color = bsdf->multiple_size = REAL(0.0);
    if (HAS(EFFECT_PART_GLASS | EFFECT_COAT | EFFECT_SHEEN))
        bsdf->matte_size = vector_color_size(bsdf->matte);
    if (HAS(EFFECT_GLOSSY | EFFECT_MIRROR) && (bsdf->lobes & (LOBE_GLOSSY | LOBE_MIRROR)))
        bsdf_energy_set_reflection(bsdf);
    if (HAS(EFFECT_ROUGH_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC) && bsdf->alpha_x > REAL(0.0) &&
        bsdf->alpha_x == bsdf->alpha_y && bsdf->eta != REAL(1.0))
        bsdf_energy_set_dielectric(bsdf);
    if (HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE) && bsdf->alpha_x > REAL(0.0))
        bsdf_energy_set_pane(bsdf);
    if (HAS(EFFECT_COAT | EFFECT_SHEEN) && (bsdf->lobes & (LOBE_COAT | LOBE_SHEEN))) {
        bsdf->flags |= BSDF_COVERED;
        cover_set(bsdf);
    }
}

#endif
