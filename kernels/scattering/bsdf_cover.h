// SPDX-License-Identifier: Apache-2.0
// What lies above a surface: a coat, then fibres that give it a sheen. Of the light that comes from a
// direction the cover sends back its albedo and leaves the rest, p(w), to what is below (albedo scaling:
// Kulla and Conty 2017). Both ends count, so that it stays reciprocal: of the matte lobe as p(wo) p(wi) /
// mean(p), which keeps all light, as below Fresnel's reflection (bsdf_energy.h); of lobes that keep the angle,
// wholly or nearly, as the smaller of p(wo) and p(wi), which never creates light and loses none where both
// angles are the same. Glass has its cover outside: from inside, only what crosses meets it.
#ifndef CLRT_SCATTERING_BSDF_COVER_H
#define CLRT_SCATTERING_BSDF_COVER_H

#include "albedo_sheen_table.h"
#include "bsdf_types.h"
#include "fresnel.h"

/* F0 of the coat, of index 1.5. */
#define COVER_COAT_F0 REAL(0.04)

/* What is left below a cover is at least this in a quotient. */
#define COVER_SMALLEST_LEFT REAL(1e-3)

/* Albedo of the coat's film towards a local direction, and its mean. */
static inline real cover_coat_albedo(const Bsdf* bsdf, Albedo albedo)
{
    return bsdf->cover.coat *
           fma(COVER_COAT_F0, REAL(1.0) - albedo.loss, (REAL(1.0) - COVER_COAT_F0) * albedo.schlick);
}

/* The place of an alpha in the sheen's tables. */
static inline AlbedoPlace cover_sheen_place(real alpha)
{
    const real smallest = real_sqrt(SHEEN_SMALLEST_ALPHA);
    return albedo_place((real_sqrt(alpha) - smallest) / (REAL(1.0) - smallest), SHEEN_ALPHAS);
}

/* Albedo of white fibres. */
static inline real cover_sheen_albedo(real alpha, real cos_w)
{
    const AlbedoPlace y = cover_sheen_place(alpha);
    const AlbedoPlace x = albedo_place(real_sqrt(cos_w), SHEEN_COSINES);
    const uint first = y.node * SHEEN_COSINES + x.node;
    const real low =
        albedo_mix((real)SHEEN_ALBEDO[first], (real)SHEEN_ALBEDO[first + 1u], x.part);
    const real high = albedo_mix((real)SHEEN_ALBEDO[first + SHEEN_COSINES],
                                 (real)SHEEN_ALBEDO[first + SHEEN_COSINES + 1u], x.part);
    return albedo_mix(low, high, y.part);
}

static inline bool cover_has_coat(const Bsdf* bsdf)
{
    return HAS(EFFECT_COAT) && bsdf->cover.coat > REAL(0.0);
}

static inline bool cover_has_sheen(const Bsdf* bsdf)
{
    return HAS(EFFECT_SHEEN) && vector_max_component(bsdf->cover.sheen) > REAL(0.0);
}

/* What the coat leaves of light from a local direction. */
static inline real cover_coat_left(const Bsdf* bsdf, real3 w)
{
    return cover_has_coat(bsdf)
               ? REAL(1.0) - cover_coat_albedo(bsdf, albedo_reflection(&bsdf->cover.film, w))
               : REAL(1.0);
}

/* What both leave, of what the coat leaves. */
static inline real cover_left(const Bsdf* bsdf, real3 w, real coat_left)
{
    if (!cover_has_sheen(bsdf))
        return coat_left;
    return coat_left * (REAL(1.0) - vector_max_component(bsdf->cover.sheen) *
                                        cover_sheen_albedo(bsdf->cover.sheen_alpha, fmin(fabs(w.z), REAL(1.0))));
}

/* Of light from everywhere. The product of the means stands for the mean of the product: both fall towards
   the horizon, so it is rather too large, and the matte lobe rather too dark. */
static inline real cover_mean_left(const Bsdf* bsdf)
{
    real left = REAL(1.0);
    if (cover_has_coat(bsdf))
        left -= cover_coat_albedo(bsdf, albedo_reflection_mean(&bsdf->cover.film));
    if (cover_has_sheen(bsdf)) {
        const AlbedoPlace y = cover_sheen_place(bsdf->cover.sheen_alpha);
        left *= REAL(1.0) - vector_max_component(bsdf->cover.sheen) *
                                albedo_mean_line(SHEEN_ALBEDO_MEAN, y.node, y);
    }
    return left;
}

/* Sets what depends on wo. */
static inline void cover_set(Bsdf* bsdf)
{
    bsdf->cover.coat_left = cover_coat_left(bsdf, bsdf->wo);
    bsdf->cover.left = cover_left(bsdf, bsdf->wo, bsdf->cover.coat_left);
    bsdf->cover.mean_left = cover_mean_left(bsdf);
}

/* Factors of what is below the cover, for light from wi. */
typedef struct {
    real coat;  /* of the sheen, below the coat alone */
    real matte; /* of the matte lobe */
    real other; /* of all other lobes */
} CoverFactors;

static inline CoverFactors cover_factors(const Bsdf* bsdf, real3 wi)
{
    CoverFactors factors;
    factors.coat = factors.matte = factors.other = REAL(1.0);
    const bool is_inside = (bsdf->flags & BSDF_INSIDE) != 0u;
    if (is_inside && wi.z > REAL(0.0))
        return factors;
    const real coat_left = cover_coat_left(bsdf, wi);
    const real left = cover_left(bsdf, wi, coat_left);
    factors.coat = fmin(bsdf->cover.coat_left, coat_left);
    factors.matte = bsdf->cover.left * left / bsdf->cover.mean_left;
    factors.other = fmin(bsdf->cover.left, left);
    /* What crosses into a solid or out of it meets the cover once, outside. */
    if (wi.z < REAL(0.0) && (bsdf->lobes & LOBE_DIELECTRIC))
        factors.other = is_inside ? left : bsdf->cover.left;
    return factors;
}

/* The size by which a lobe of the cover is chosen beside those below, whose sizes are as if it were not
   there. */
static inline real cover_size(const Bsdf* bsdf, real albedo)
{
    if (bsdf->flags & BSDF_INSIDE)
        return REAL(0.0);
    return vector_color_size((real3)(albedo)) / fmax(bsdf->cover.left, COVER_SMALLEST_LEFT);
}

#endif
