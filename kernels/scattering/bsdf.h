// SPDX-License-Identifier: Apache-2.0
// The BSDF of a material: the sum of its lobes, which are rows of one table (shared/lobes.h). Lobes are
// chosen by their weight; where lobes overlap, the density is that of the mixture. Nothing passes where the
// shading normal and the surface disagree about the side.
#ifndef CLRT_SCATTERING_BSDF_H
#define CLRT_SCATTERING_BSDF_H

#include "bsdf_coat.h"
#include "bsdf_dielectric.h"
#include "bsdf_glossy.h"
#include "bsdf_matte.h"
#include "bsdf_measured.h"
#include "bsdf_mirror.h"
#include "bsdf_pane.h"
#include "bsdf_sheen.h"
#include "geometry/surface.h"

/* True where a set of lobes has one, in builds that know it. */
#define BSDF_HAS(lobes, NAME, effect) (HAS(effect) && ((lobes) & LOBE_##NAME) != 0u)

/* True where a set of lobes has none behind this one in the table. */
#define BSDF_IS_LAST(lobes, NAME) ((lobes) < 2u * LOBE_##NAME)

/* Letters of the path notation (bits LETTER_BIT) that some of the lobes write where they have a density. */
static inline uint bsdf_smooth_letters(const Bsdf* bsdf)
{
    uint found = 0u;
#define ADD_LETTERS(NAME, name, effect, letters, delta_letters, absent)                                      \
    if (BSDF_HAS(bsdf->lobes, NAME, effect) && !bsdf_##name##_is_delta(bsdf))                                \
        found |= letters;
    LOBE_TABLE(ADD_LETTERS)
#undef ADD_LETTERS
    return found;
}

/* True if some lobe is no delta function, so that connecting to a light can succeed. */
static inline bool bsdf_has_smooth_lobe(const Bsdf* bsdf) { return bsdf_smooth_letters(bsdf) != 0u; }

/* Lobes that may write one of these letters, with a density or as delta functions. */
static inline uint bsdf_lobes_of(const Bsdf* bsdf, uint wanted)
{
    uint found = 0u;
#define ADD_LOBE(NAME, name, effect, letters, delta_letters, absent)                                         \
    if (BSDF_HAS(bsdf->lobes, NAME, effect) &&                                                               \
        (wanted & (bsdf_##name##_is_delta(bsdf) ? delta_letters : letters)))                                 \
        found |= LOBE_##NAME;
    LOBE_TABLE(ADD_LOBE)
#undef ADD_LOBE
    return found;
}

/* Reflectance head-on: the sum of the lobes' albedos. */
static inline real3 bsdf_albedo(const Bsdf* bsdf)
{
    real3 albedo = (real3)(REAL(0.0));
#define ADD_ALBEDO(NAME, name, effect, letters, delta_letters, absent)                                       \
    if (BSDF_HAS(bsdf->lobes, NAME, effect))                                                                 \
        albedo += bsdf_##name##_albedo(bsdf);
    LOBE_TABLE(ADD_ALBEDO)
#undef ADD_ALBEDO
    return albedo;
}

/* True if a world direction is on wo's side of the surface. */
static inline bool bsdf_reflects(const Bsdf* bsdf, real3 wi_world)
{
    return surface_side(bsdf->normal_g, bsdf->normal_s, bsdf->is_curved, wi_world);
}

/* True if a world direction is on the side of the surface that its local form is on in the frame, which a map
   may tilt. */
static inline bool bsdf_sides_agree(const Bsdf* bsdf, real3 wi_world, real3 wi)
{
    return bsdf_reflects(bsdf, wi_world) == (wi.z > REAL(0.0));
}

/* The matte lobe and the rough reflection that it is coupled to, by one albedo of both. */
static inline void bsdf_add_coupled(const Bsdf* bsdf, real3 wi, BsdfValue* sum)
{
    const Albedo albedo = bsdf_energy_albedo(bsdf, wi);
    sum->value += bsdf_matte_uncoupled(bsdf, wi) * bsdf_energy_coupling_by(bsdf, albedo);
    sum->pdf_w += bsdf->choose[LOBE_ROW_MATTE] * bsdf_matte_pdf_w(wi);
    bsdf_glossy_add_by(bsdf, albedo.loss, wi, sum);
}

/* Sum of some of the lobes, as if nothing covered them, and their share of the mixture's density; wi local,
   sides already compared. */
static inline BsdfValue bsdf_eval_uncovered(const Bsdf* bsdf, uint lobes, real3 wi)
{
    BsdfValue sum = bsdf_value_none();
    const uint coupled = LOBE_MATTE | LOBE_GLOSSY;
    if (HAS(EFFECT_GLOSSY) && (lobes & coupled) == coupled && bsdf_energy_is_coupled(bsdf)) {
        bsdf_add_coupled(bsdf, wi, &sum);
        lobes &= ~coupled;
    }
#define ADD_VALUE(NAME, name, effect, letters, delta_letters, absent)                                        \
    if (BSDF_HAS(lobes, NAME, effect))                                                                       \
        bsdf_##name##_add(bsdf, wi, &sum);
    LOBE_TABLE(ADD_VALUE)
#undef ADD_VALUE
    return sum;
}

/* The same below a coat and a sheen: each part by its factor. */
static CLRT_NOINLINE BsdfValue bsdf_eval_covered(const Bsdf* bsdf, uint lobes, real3 wi)
{
    const CoverFactors factors = cover_factors(bsdf, wi);
    BsdfValue sum = bsdf_value_none();
    for (uint row = 0u; row < LOBE_COUNT; ++row) {
        const uint lobe = 1u << row;
        if (!(lobes & lobe))
            continue;
        const BsdfValue part = bsdf_eval_uncovered(bsdf, lobe, wi);
        const real factor = lobe == LOBE_COAT    ? REAL(1.0)
                            : lobe == LOBE_SHEEN ? factors.coat
                            : lobe == LOBE_MATTE ? factors.matte
                                                 : factors.other;
        sum.value += part.value * factor;
        sum.pdf_w += part.pdf_w;
    }
    return sum;
}

/* Sum of some of the lobes and their share of the mixture's density; wi local, sides already compared. */
static inline BsdfValue bsdf_eval_lobes(const Bsdf* bsdf, uint lobes, real3 wi)
{
    BsdfValue sum =
        bsdf_is_covered(bsdf) ? bsdf_eval_covered(bsdf, lobes, wi) : bsdf_eval_uncovered(bsdf, lobes, wi);
    if (HAS(EFFECT_DISPERSION))
        sum.value *= dispersion_is_rough(bsdf) ? dispersion_hue(dispersion_of(bsdf)) : (real3)(REAL(1.0));
    return sum;
}

/* What a shading normal that is not the surface's makes of importance (Veach 1997, sec. 5.3): cosines to the
   light's side are those of n_s in radiance, so they must be in importance, whose beams spread by those of
   n_g. Not bounded. This is its one place; wi is local. */
static inline real bsdf_shading_factor(const Bsdf* bsdf, real3 wi_world, real3 wi)
{
    const real3 wo_world = frame_to_world(&bsdf->frame, bsdf->wo);
    const real below = fabs(vector_dot(wo_world, bsdf->normal_g) * wi.z);
    /* Along the plane nothing arrives, along the horizon nothing leaves. */
    return below == REAL(0.0) ? REAL(0.0) : fabs(bsdf->wo.z * vector_dot(wi_world, bsdf->normal_g)) / below;
}

/* The normal above whose horizon all light comes from that the lobes scatter to wo; 0 where some lobe
   scatters light from below. */
static inline real3 bsdf_light_normal(const Bsdf* bsdf)
{
    if (HAS(EFFECT_REFRACTION) && (bsdf->lobes & LOBE_DIELECTRIC))
        return (real3)(REAL(0.0));
    if (HAS(EFFECT_THIN_WALL) && (bsdf->lobes & LOBE_PANE))
        return (real3)(REAL(0.0));
    return bsdf->frame.z;
}

/* The matte lobe towards a local direction above the surface, as what lies above lets it be seen. */
static inline real3 bsdf_eval_matte(const Bsdf* bsdf, real3 wi)
{
    return bsdf_is_covered(bsdf) ? bsdf_eval_covered(bsdf, LOBE_MATTE, wi).value : bsdf_matte_eval(bsdf, wi);
}

/* Sum of all lobes for a world direction. */
static inline BsdfValue bsdf_eval(const Bsdf* bsdf, real3 wi_world)
{
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    if (!bsdf_sides_agree(bsdf, wi_world, wi))
        return bsdf_value_none();
    BsdfValue sum = bsdf_eval_lobes(bsdf, bsdf->lobes, wi);
    if (bsdf->flags & TRANSPORT_IMPORTANCE)
        sum.value *= bsdf_shading_factor(bsdf, wi_world, wi);
    return sum;
}

/* True if the lobe that holds the light of more than one facet is among these. */
static inline bool bsdf_multiple_among(const Bsdf* bsdf, uint lobes)
{
    if (!bsdf_is_part_glass(bsdf))
        return (lobes & LOBES_ROUGH) != 0u;
    return (lobes & (bsdf_energy_has_multiple(bsdf, LOBE_GLOSSY) ? LOBE_GLOSSY : LOBES_GLASS)) != 0u;
}

/* Sets `choose` to the sizes of what the lobes reflect towards wo, and gives their sum with that of the light
   of more than one facet. */
static inline real bsdf_sizes(Bsdf* bsdf, real multiple)
{
    real sum = multiple;
#define SET_SIZE(NAME, name, effect, letters, delta_letters, absent)                                         \
    if (BSDF_HAS(bsdf->lobes, NAME, effect)) {                                                               \
        bsdf->choose[LOBE_ROW_##NAME] = bsdf_##name##_size(bsdf);                                            \
        sum += bsdf->choose[LOBE_ROW_##NAME];                                                                \
    }
    LOBE_TABLE(SET_SIZE)
#undef SET_SIZE
    if (bsdf_is_part_glass(bsdf) && bsdf_energy_has_multiple(bsdf, LOBE_GLOSSY))
        bsdf->choose[LOBE_ROW_GLOSSY] += multiple;
    if (sum != REAL(0.0))
        return sum;
    /* Where nothing is reflected, the matte lobe stands for nothing as well as the others. */
    bsdf->choose[LOBE_ROW_MATTE] = (bsdf->lobes & LOBE_MATTE) ? REAL(1.0) : REAL(0.0);
    return REAL(1.0);
}

/* Lobes that this build knows. */
#define BSDF_BIT(NAME, name, effect, letters, delta_letters, absent) | (HAS(effect) ? LOBE_##NAME : 0u)
enum { BSDF_LOBES = 0u LOBE_TABLE(BSDF_BIT) };
#undef BSDF_BIT

/* Sets the lobes' probabilities by how much each reflects towards wo. The last one gets what the others
   leave. */
static inline void bsdf_choose_lobes(Bsdf* bsdf)
{
    /* Where a build knows one lobe alone, the compiler sees it. */
    const uint lobes = bsdf->lobes & BSDF_LOBES;
    const real multiple = bsdf_multiple_among(bsdf, lobes) ? bsdf->multiple_size : REAL(0.0);
    const bool is_alone = (lobes & (lobes - 1u)) == 0u && multiple == REAL(0.0);
    for (uint row = 0u; row < LOBE_COUNT; ++row)
        bsdf->choose[row] = REAL(0.0);
    const real sum = is_alone ? REAL(1.0) : bsdf_sizes(bsdf, multiple);
    bsdf->choose_multiple = multiple / sum;
    real left = REAL(1.0);
#define SET_SHARE(NAME, name, effect, letters, delta_letters, absent)                                        \
    if (BSDF_HAS(lobes, NAME, effect)) {                                                                     \
        bsdf->choose[LOBE_ROW_##NAME] =                                                                      \
            BSDF_IS_LAST(lobes, NAME) ? left : bsdf->choose[LOBE_ROW_##NAME] / sum;                          \
        left -= bsdf->choose[LOBE_ROW_##NAME];                                                               \
    }
    LOBE_TABLE(SET_SHARE)
#undef SET_SHARE
}

/* Leaves the sampling of directions to some of the lobes, which share it as before among each other. The
   value stays that of all. */
static inline void bsdf_choose_among(Bsdf* bsdf, uint lobes)
{
    real whole = REAL(1.0);
#define TAKE_SHARE(NAME, name, effect, letters, delta_letters, absent)                                       \
    if (BSDF_HAS(bsdf->lobes & ~lobes, NAME, effect)) {                                                      \
        whole -= bsdf->choose[LOBE_ROW_##NAME];                                                              \
        bsdf->choose[LOBE_ROW_##NAME] = REAL(0.0);                                                           \
    }
    LOBE_TABLE(TAKE_SHARE)
#undef TAKE_SHARE
    bsdf->choose_multiple =
        bsdf_multiple_among(bsdf, lobes) && whole > REAL(0.0) ? bsdf->choose_multiple / whole : REAL(0.0);
    real left = REAL(1.0);
#define GROW_SHARE(NAME, name, effect, letters, delta_letters, absent)                                       \
    if (BSDF_HAS(bsdf->lobes & lobes, NAME, effect)) {                                                       \
        bsdf->choose[LOBE_ROW_##NAME] =                                                                      \
            BSDF_IS_LAST(lobes, NAME) ? left : bsdf->choose[LOBE_ROW_##NAME] / whole;                        \
        left -= bsdf->choose[LOBE_ROW_##NAME];                                                               \
    }
    LOBE_TABLE(GROW_SHARE)
#undef GROW_SHARE
}

/* The lobe (LOBE_*) that a number in (0, 1) chooses, and the probability of those before it. */
static inline uint bsdf_choose(const Bsdf* bsdf, BsdfChoice* choice)
{
    choice->before = REAL(0.0);
#define CHOOSE(NAME, name, effect, letters, delta_letters, absent)                                           \
    if (BSDF_HAS(bsdf->lobes, NAME, effect)) {                                                               \
        if (BSDF_IS_LAST(bsdf->lobes, NAME) || choice->u < choice->before + bsdf->choose[LOBE_ROW_##NAME])   \
            return LOBE_##NAME;                                                                              \
        choice->before += bsdf->choose[LOBE_ROW_##NAME];                                                     \
    }
    LOBE_TABLE(CHOOSE)
#undef CHOOSE
    return 0u;
}

/* Samples a direction. u_lobe chooses the lobe, u the direction. */
CLRT_GIVES_STRUCT BsdfSample bsdf_sample(const Bsdf* bsdf, real u_lobe, real2 u)
{
    BsdfSample sample;
    sample.pdf_w = REAL(0.0);
    sample.eta = REAL(1.0);
    sample.weight = (real3)(REAL(0.0));
    sample.is_weighted = false;
    TRACE_SET(sample.lobe, 0u);
    BsdfChoice choice;
    choice.u = u_lobe;
    const uint lobe = bsdf_choose(bsdf, &choice);
    real3 wi = (real3)(REAL(0.0));
#define SAMPLE(NAME, name, effect, letters, delta_letters, absent)                                           \
    if (BSDF_HAS(lobe, NAME, effect))                                                                        \
        wi = bsdf_##name##_sample(bsdf, choice, u, &sample);
    LOBE_TABLE(SAMPLE)
#undef SAMPLE
    if (!sample.is_weighted) {
        const BsdfValue eval = bsdf_eval_lobes(bsdf, bsdf->lobes, wi);
        sample.pdf_w = eval.pdf_w;
        sample.weight = eval.pdf_w == REAL(0.0) ? (real3)(REAL(0.0)) : eval.value / eval.pdf_w;
    } else if (bsdf_is_covered(bsdf)) /* a delta lobe */
        sample.weight *= cover_factors(bsdf, wi).other;
    sample.wi = frame_to_world(&bsdf->frame, wi);
    if (bsdf->flags & TRANSPORT_IMPORTANCE)
        sample.weight *= bsdf_shading_factor(bsdf, sample.wi, wi);
    sample.reflects = bsdf_reflects(bsdf, sample.wi);
    sample.is_valid = !vector_is_black(sample.weight) && sample.reflects == (wi.z > REAL(0.0));
    return sample;
}

#endif
