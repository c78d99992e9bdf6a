// SPDX-License-Identifier: Apache-2.0
// Glass that bends colours apart. A path has one colour, red, green or blue with equal probability, and all
// glass on its way bends it by that colour's index. Up to the first event that depends on the index the path
// carries all three; from there on its own alone, three times as much. So what sees no dispersion has no
// noise of colours. The colour is drawn with the path, not where it is needed: the paths from both ends of a
// connection have the same, and for each colour the weights of all ways to find a path sum to 1.
//
// Smooth glass reflects all colours into one direction: there the path keeps them, each by its own Fresnel
// reflectance over that of the one that has chosen.
#ifndef CLRT_SCATTERING_DISPERSION_H
#define CLRT_SCATTERING_DISPERSION_H

#include "bsdf_types.h"
#include "fresnel.h"
#include "geometry/ray.h"

/* Where the colours lie between Fraunhofer's lines, of which C is 656.27 nm, d 587.56 nm, F 486.13 nm: with
   Cauchy's n = A + B / l^2, (l^-2 - d^-2) / (F^-2 - C^-2), for the dominant wavelengths of the primaries of
   sRGB, 611.4 nm, 549.1 nm and 464.2 nm. The Abbe number is (n_d - 1) / (n_F - n_C). */
#define DISPERSION_RED REAL(-0.115978)
#define DISPERSION_GREEN REAL(0.219908)
#define DISPERSION_BLUE REAL(0.913302)

/* Indices of the colours; `spread`: n_F - n_C. */
static inline real3 dispersion_indices(real index, real spread)
{
    return (real3)(index) + spread * vector_make(DISPERSION_RED, DISPERSION_GREEN, DISPERSION_BLUE);
}

/* The component of a wave's colour. */
static inline real dispersion_component(uint wave, real3 v)
{
    const uint color = wave & WAVE_COLOR;
    return color == 1u ? v.x : color == 2u ? v.y : v.z;
}

/* The wave that a BSDF bends apart from others; WAVE_NONE: it treats all alike. */
static inline uint dispersion_of(const Bsdf* bsdf)
{
    return HAS(EFFECT_DISPERSION) ? bsdf->flags >> BSDF_WAVE_SHIFT : WAVE_NONE;
}

/* Three times the wave's colour where it is one of three, its colour alone where the path has no other. */
static inline real3 dispersion_hue(uint wave)
{
    const uint color = wave & WAVE_COLOR;
    const real size = (wave & WAVE_ALONE) ? REAL(1.0) : REAL(3.0);
    return vector_make(color == 1u ? size : REAL(0.0), color == 2u ? size : REAL(0.0),
                       color == 3u ? size : REAL(0.0));
}

/* True where all that the surface scatters depends on the index, in all directions. */
static inline bool dispersion_is_rough(const Bsdf* bsdf)
{
    return HAS(EFFECT_ROUGH_REFRACTION) && dispersion_of(bsdf) != WAVE_NONE && bsdf->alpha_x != REAL(0.0);
}

/* True if what the surface scatters to one side leaves a path its own colour alone. */
static inline bool dispersion_splits(const Bsdf* bsdf, bool reflects)
{
    return dispersion_is_rough(bsdf) || (!reflects && dispersion_of(bsdf) != WAVE_NONE);
}

/* What the colours reflect of that which the wave's reflects, F, at a facet of this cosine. */
static CLRT_NOINLINE real3 dispersion_reflects(const Bsdf* bsdf, real cos_o)
{
#if CLRT_EFFECTS & EFFECT_DISPERSION
    real cos_t;
    const real3 f = vector_make(fresnel_dielectric(cos_o, bsdf->rare.etas.x, &cos_t),
                                fresnel_dielectric(cos_o, bsdf->rare.etas.y, &cos_t),
                                fresnel_dielectric(cos_o, bsdf->rare.etas.z, &cos_t));
    return f / dispersion_component(dispersion_of(bsdf), f);
#else
    return (real3)(REAL(1.0));
#endif
}

/* Factor of what smooth glass sends to one side, beside what the wave's own colour does. */
static inline real3 dispersion_smooth_factor(const Bsdf* bsdf, bool reflects, real cos_o)
{
    const uint wave = dispersion_of(bsdf);
    if (wave == WAVE_NONE)
        return (real3)(REAL(1.0));
    if (!reflects)
        return dispersion_hue(wave);
    return (wave & WAVE_ALONE) ? (real3)(REAL(1.0)) : dispersion_reflects(bsdf, cos_o);
}

/* The same of a facet of any glass. */
static inline real3 dispersion_factor(const Bsdf* bsdf, bool reflects, real cos_o)
{
    return dispersion_is_rough(bsdf) ? dispersion_hue(dispersion_of(bsdf))
                                     : dispersion_smooth_factor(bsdf, reflects, cos_o);
}

/* Tells a ray whether it has its own colour alone from here on. */
static inline void dispersion_leave(bool splits, Ray* ray)
{
    if (HAS(EFFECT_DISPERSION) && splits)
        ray_set_wave(ray_wave(ray) | WAVE_ALONE, ray);
}

#endif
