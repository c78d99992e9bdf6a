// SPDX-License-Identifier: Apache-2.0
// What lies above a surface: a coat, then fibres that give it a sheen. Of the light that comes from a
// direction the cover sends back its albedo and leaves the rest, p(w), to what is below (albedo scaling:
// Kulla and Conty 2017). Both ends count, so that it stays reciprocal:
// - of the matte lobe as p(wo) p(wi) / mean(p), which keeps all light, as below Fresnel's reflection
//   (bsdf_energy.h);
// - of all other lobes below a coat as s(wo) s(wi), where s is such that the light of the lobe, if white,
//   sums to p(wo). For a mirror that is the root of p, for what scatters everywhere p / sqrt(mean(p)), and
//   between them s(w) = p(w) / sqrt(p(w) - d) by a table (tools/fit_cover.py);
// - below a sheen, and of the sheen below a coat, as the smaller of p(wo) and p(wi), which never creates
//   light and loses none where both angles are the same.
// Glass has its cover outside: from inside, only what crosses meets it.
#ifndef CLRT_SCATTERING_BSDF_COVER_H
#define CLRT_SCATTERING_BSDF_COVER_H

#include "albedo_sheen_table.h"
#include "bsdf_types.h"
#include "cover_table.h"
#include "fresnel.h"

/* F0 of the coat, of index 1.5. */
#define COVER_COAT_F0 REAL(0.04)

/* What is left below a cover is at least this in a quotient. */
#define COVER_SMALLEST_LEFT REAL(1e-3)

/* Albedo of a coat of this weight where that of its film is known, of a direction or the mean. */
static inline real cover_coat_albedo(real coat, Albedo albedo)
{
    return coat *
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
    return HAS(EFFECT_COAT) && bsdf_cover(bsdf)->coat > REAL(0.0);
}

static inline bool cover_has_sheen(const Bsdf* bsdf)
{
    return HAS(EFFECT_SHEEN) && vector_max_component(bsdf_cover(bsdf)->sheen) > REAL(0.0);
}

/* What a coat leaves of light along a local direction. */
static inline real cover_film_left(real coat, real coat_alpha, real3 w)
{
    const AlbedoRoughness film = albedo_roughness(coat_alpha, coat_alpha);
    return REAL(1.0) - cover_coat_albedo(coat, albedo_reflection(&film, w));
}

static inline real cover_coat_left(const Bsdf* bsdf, real3 w)
{
    const BsdfCover* cover = bsdf_cover(bsdf);
    return cover_has_coat(bsdf) ? cover_film_left(cover->coat, cover->coat_alpha, w) : REAL(1.0);
}

/* What both leave, of what the coat leaves. */
static inline real cover_left(const Bsdf* bsdf, real3 w, real coat_left)
{
    if (!cover_has_sheen(bsdf))
        return coat_left;
    const BsdfCover* cover = bsdf_cover(bsdf);
    const real albedo = cover_sheen_albedo(cover->sheen_alpha, fmin(fabs(w.z), REAL(1.0)));
    return coat_left * (REAL(1.0) - vector_max_component(cover->sheen) * albedo);
}

/* The variance of (1 - cos)^5 over a hemisphere of equal radiance, 1 / 66 - 1 / 21^2. */
#define COVER_SCHLICK_VARIANCE REAL(0.012883941)

/* What both leave of light from everywhere, in a product with what the reflection below leaves to the matte
   lobe, over the latter's mean. All fall together towards the horizon, so the mean of the product is more
   than that of the means, by their covariances: those of smooth films, which vary most, so that no light is
   made. */
static inline real cover_mean_left(const Bsdf* bsdf)
{
    const real below =
        (bsdf->flags & BSDF_COUPLED) ? REAL(1.0) / (REAL(1.0) - FRESNEL_SCHLICK_MEAN) : REAL(0.0);
    real coat_left = REAL(1.0), coat_schlick = REAL(0.0);
    real sheen_left = REAL(1.0), sheen_varies = REAL(0.0);
    if (cover_has_coat(bsdf)) {
        const BsdfCover* cover = bsdf_cover(bsdf);
        const AlbedoRoughness film = albedo_roughness(cover->coat_alpha, cover->coat_alpha);
        coat_left -= cover_coat_albedo(cover->coat, albedo_reflection_mean(&film));
        coat_schlick = cover->coat * (REAL(1.0) - COVER_COAT_F0);
    }
    if (cover_has_sheen(bsdf)) {
        const AlbedoPlace y = cover_sheen_place(bsdf_cover(bsdf)->sheen_alpha);
        const real color = vector_max_component(bsdf_cover(bsdf)->sheen);
        sheen_left -= color * albedo_mean_line(SHEEN_ALBEDO_MEAN, y.node, y);
        sheen_varies = color * albedo_mean_line(SHEEN_SCHLICK_COVARIANCE, y.node, y);
    }
    return coat_left * sheen_left + (coat_schlick + coat_left * below) * sheen_varies +
           coat_schlick * below * COVER_SCHLICK_VARIANCE * sheen_left;
}

/* d of s(w), for a coat of weight 1. */
static inline real cover_spread(real coat_alpha, real alpha, real cos_w)
{
    const AlbedoPlace z = albedo_place(real_sqrt(coat_alpha), COVER_COATS);
    const AlbedoPlace y = albedo_place(real_sqrt(alpha), COVER_NODES);
    const AlbedoPlace x = albedo_place(real_sqrt(cos_w), COVER_NODES);
    real sum = REAL(0.0);
    for (uint corner = 0u; corner < 8u; ++corner) {
        const uint dx = corner & 1u, dy = (corner >> 1) & 1u, dz = corner >> 2;
        const real part = (dx ? x.part : REAL(1.0) - x.part) * (dy ? y.part : REAL(1.0) - y.part) *
                          (dz ? z.part : REAL(1.0) - z.part);
        const uint at = ((z.node + dz) * COVER_NODES + y.node + dy) * COVER_NODES + x.node + dx;
        sum = fma(part, (real)COVER_SPREAD[at], sum);
    }
    return sum;
}

/* s(w) below the coat, which leaves p(w) = `coat_left`. */
static inline real cover_coat_shared(const Bsdf* bsdf, real3 w, real coat_left)
{
    const BsdfCover* cover = bsdf_cover(bsdf);
    const real alpha = real_sqrt(bsdf->alpha_x * bsdf->alpha_y);
    if (!cover_has_coat(bsdf) || alpha == REAL(0.0))
        return real_sqrt(coat_left);
    const real spread = cover->coat * cover_spread(cover->coat_alpha, alpha, fmin(fabs(w.z), REAL(1.0)));
    return coat_left / real_sqrt(fmax(coat_left - spread, COVER_SMALLEST_LEFT));
}

/* Sets what depends on wo. */
static inline void cover_set(Bsdf* bsdf)
{
    bsdf_cover(bsdf)->coat_left = cover_coat_left(bsdf, bsdf->wo);
    bsdf_cover(bsdf)->left = cover_left(bsdf, bsdf->wo, bsdf_cover(bsdf)->coat_left);
    bsdf_cover(bsdf)->coat_shared = cover_coat_shared(bsdf, bsdf->wo, bsdf_cover(bsdf)->coat_left);
    bsdf_cover(bsdf)->mean_left = cover_mean_left(bsdf);
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
    factors.coat = fmin(bsdf_cover(bsdf)->coat_left, coat_left);
    factors.matte = bsdf_cover(bsdf)->left * left / bsdf_cover(bsdf)->mean_left;
    /* What the sheen leaves is left / coat_left. */
    const BsdfCover* cover = bsdf_cover(bsdf);
    factors.other = cover->coat_shared * cover_coat_shared(bsdf, wi, coat_left) *
                    fmin(cover->left / fmax(cover->coat_left, COVER_SMALLEST_LEFT),
                         left / fmax(coat_left, COVER_SMALLEST_LEFT));
    /* What crosses into a solid or out of it meets the cover once, outside. */
    if (wi.z < REAL(0.0) && (bsdf->lobes & LOBE_DIELECTRIC))
        factors.other = is_inside ? left : bsdf_cover(bsdf)->left;
    return factors;
}

/* The size by which a lobe of the cover is chosen beside those below, whose sizes are as if it were not
   there. */
static inline real cover_size(const Bsdf* bsdf, real albedo)
{
    if (bsdf->flags & BSDF_INSIDE)
        return REAL(0.0);
    return vector_color_size((real3)(albedo)) / fmax(bsdf_cover(bsdf)->left, COVER_SMALLEST_LEFT);
}

#endif
