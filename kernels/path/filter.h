// SPDX-License-Identifier: Apache-2.0
// What the automaton makes of a BSDF. A lobe whose letter leads nowhere is taken away, and with it its share of the density;
// what is left is sampled and weighted like any other BSDF.
//
// One direction can be scattered by the matte and by the glossy lobe. Where the automaton treats them alike, the event has no
// class and nothing changes. Where it does not, write f = f_D + f_G for the BSDF times cosine and p for the density of the
// mixture. Light sampling adds f_c L w_light / p_light for each class c that accepts the light: both parts, no choice. The
// sampled direction goes on as one class, chosen with probability P_c = |f_c| / (|f_D| + |f_G|) and divided by it: its
// throughput is f_c / (p P_c), whose mean over the choice is f_c / p for either class. The density of the direction is p
// whatever the class, so the weights of light sampling and BSDF sampling, which only know p and p_light, sum to 1 for each
// class, and the sum over the classes is the whole integral.
#ifndef CLRT_PATH_FILTER_H
#define CLRT_PATH_FILTER_H

#include "automaton.h"
#include "scattering/bsdf.h"

/* True for a dielectric whose both ways are delta functions. */
static inline bool filter_is_smooth_glass(const Bsdf* bsdf)
{
    return (bsdf->lobes & LOBE_DIELECTRIC) && bsdf_dielectric_is_smooth(bsdf);
}

/* Takes away the lobes that lead to a dead state. */
static inline void filter_lobes(const AutomatonStep* step, Bsdf* bsdf)
{
    uint dead = 0u;
    if (step->matte == STATE_DEAD)
        dead |= LOBE_MATTE;
    if (step->mirror == STATE_DEAD)
        dead |= LOBE_MIRROR;
    if (step->glossy == STATE_DEAD)
        dead |= filter_is_smooth_glass(bsdf) ? LOBE_GLOSSY : LOBE_GLOSSY | LOBE_DIELECTRIC;
    if (filter_is_smooth_glass(bsdf)) {
        bsdf->flags |= step->mirror == STATE_DEAD ? BSDF_NO_REFLECTION : 0u;
        bsdf->flags |= step->refraction == STATE_DEAD ? BSDF_NO_REFRACTION : 0u;
        if (step->mirror == STATE_DEAD && step->refraction == STATE_DEAD)
            dead |= LOBE_DIELECTRIC;
    }
    if ((bsdf->lobes & dead) == 0u)
        return;
    bsdf->lobes &= ~dead;
    bsdf_choose_lobes(bsdf);
}

/* Samples no lobe behind which a ray finds nothing; false if there is no other. Only lights that light sampling alone can
   find end a path there, so the density of BSDF sampling weighs against nothing. */
static inline bool filter_continues(const AutomatonStep* step, Bsdf* bsdf)
{
    const bool has_matte = (bsdf->lobes & LOBE_MATTE) != 0u;
    const bool matte = has_matte && automaton_continues(step->matte);
    if ((bsdf->lobes & ~LOBE_MATTE) == 0u)
        return matte;
    bool rest = automaton_continues(step->glossy);
    if (bsdf->lobes & LOBE_MIRROR)
        rest = automaton_continues(step->mirror);
    else if (filter_is_smooth_glass(bsdf)) /* what is left of it after filter_lobes */
        rest = automaton_continues(step->mirror) || automaton_continues(step->refraction);
    if (has_matte && matte != rest) {
        const real left = matte ? REAL(0.0) : REAL(1.0) - bsdf->choose_matte;
        bsdf->choose_matte = matte ? REAL(1.0) : REAL(0.0);
        bsdf->choose_multiple = left > REAL(0.0) ? bsdf->choose_multiple / left : REAL(0.0);
        bsdf->choose_glossy =
            rest && (bsdf->lobes & LOBE_GLOSSY) ? REAL(1.0) - bsdf->choose_multiple : REAL(0.0);
    }
    return matte || rest;
}

/* Lobes that write a letter of their own for the same direction. */
static inline bool filter_is_ambiguous(const AutomatonStep* step, const Bsdf* bsdf)
{
    const uint both = LOBE_MATTE | LOBE_GLOSSY;
    return (bsdf->lobes & both) == both && step->matte != step->glossy;
}

/* The matte part of the BSDF times cosine. */
static inline real3 filter_matte_part(const Bsdf* bsdf, real3 wi_world)
{
    return bsdf_matte_eval(bsdf, frame_to_local(&bsdf->frame, wi_world));
}

/* The glossy part. */
static inline real3 filter_glossy_part(const Bsdf* bsdf, real3 wi_world)
{
    return bsdf_glossy_eval(bsdf, frame_to_local(&bsdf->frame, wi_world)).value;
}

/* What is left of the BSDF's whole value towards a light when only some classes accept it. Where the whole is nothing, because
   the light is on the other side, so are its parts. */
static inline real3 filter_value(const AutomatonStep* step, const Bsdf* bsdf, real3 wi_world, uint kind, real3 whole)
{
    const bool matte = (bsdf->lobes & LOBE_MATTE) && automaton_accepts(step->matte, kind);
    const bool glossy = (bsdf->lobes & (LOBE_GLOSSY | LOBE_DIELECTRIC)) && automaton_accepts(step->glossy, kind);
    if (filter_is_ambiguous(step, bsdf) && matte != glossy && !vector_is_black(whole))
        return matte ? filter_matte_part(bsdf, wi_world) : filter_glossy_part(bsdf, wi_world);
    return matte || glossy ? whole : (real3)(REAL(0.0));
}

/* True if some light may end a path behind this vertex: else light sampling is useless here. */
static inline bool filter_wants_light(const AutomatonStep* step, const Bsdf* bsdf)
{
    if ((bsdf->lobes & LOBE_MATTE) && automaton_accepts(step->matte, KINDS_ALL))
        return true;
    return (bsdf->lobes & (LOBE_GLOSSY | LOBE_DIELECTRIC)) && automaton_accepts(step->glossy, KINDS_ALL);
}

/* A component of f_c / (f P_c). */
static inline real filter_share_component(real part, real rest, real chance)
{
    return part == REAL(0.0) ? REAL(0.0) : part / ((part + rest) * chance);
}

/* Chooses the class of a sampled direction that both lobes scatter: true for matte. Gives its share of the value over the
   probability of the choice. A class whose ray finds nothing is not chosen. */
static CLRT_NOINLINE bool filter_choose_matte(const AutomatonStep* step, const Bsdf* bsdf, real3 wi_world, real u,
                                              real3* share)
{
    const real3 matte = filter_matte_part(bsdf, wi_world);
    const real3 glossy = filter_glossy_part(bsdf, wi_world);
    const real size = vector_color_size(matte) + vector_color_size(glossy);
    real chance = size > REAL(0.0) ? vector_color_size(matte) / size : REAL(0.5);
    if (!automaton_continues(step->glossy))
        chance = REAL(1.0);
    if (!automaton_continues(step->matte))
        chance = REAL(0.0);
    const bool is_matte = u < chance;
    const real3 part = is_matte ? matte : glossy;
    const real3 rest = is_matte ? glossy : matte;
    const real taken = is_matte ? chance : REAL(1.0) - chance;
    *share = vector_make(filter_share_component(part.x, rest.x, taken), filter_share_component(part.y, rest.y, taken),
                         filter_share_component(part.z, rest.z, taken));
    return is_matte;
}

/* The state behind a sampled direction that is not ambiguous. */
static inline uint filter_state(const AutomatonStep* step, const Bsdf* bsdf, const BsdfSample* sample)
{
    if (sample->pdf_w == REAL(0.0)) {
        /* Refraction changes the index; without a difference of indices there is no reflection. */
        const bool glass = (bsdf->lobes & LOBE_DIELECTRIC) != 0u;
        return glass && (sample->eta != REAL(1.0) || bsdf->eta == REAL(1.0)) ? step->refraction : step->mirror;
    }
    return (bsdf->lobes & LOBE_MATTE) ? step->matte : step->glossy;
}

#endif
