// SPDX-License-Identifier: Apache-2.0
// What the automaton makes of a BSDF. A lobe whose letter leads nowhere is taken away, and with it its share
// of the density; what is left is sampled and weighted like any other BSDF.
//
// One direction can be scattered by the matte and by the glossy lobe. Where the automaton treats them alike,
// the event has no class and nothing changes. Where it does not, write f = f_D + f_G for the BSDF times
// cosine and p for the density of the mixture. Light sampling adds f_c L w_light / p_light for each class c
// that accepts the light: both parts, no choice. The sampled direction goes on as one class, chosen with
// probability P_c = |f_c| / (|f_D| + |f_G|) and divided by it: its throughput is f_c / (p P_c), whose mean
// over the choice is f_c / p for either class. The density of the direction is p whatever the class, so the
// weights of light sampling and BSDF sampling, which only know p and p_light, sum to 1 for each class, and
// the sum over the classes is the whole integral.
#ifndef CLRT_PATH_FILTER_H
#define CLRT_PATH_FILTER_H

#include "automaton.h"
#include "scattering/bsdf.h"

/* The lobes that write D or G where they have a density; of all others the letter is that of a delta
   function. */
#define FILTER_LETTERS (LETTER_BIT(LETTER_MATTE) | LETTER_BIT(LETTER_GLOSSY))

/* Takes away the lobes that lead to a dead state, and the ways of a smooth dielectric that do. */
static inline void filter_lobes(const AutomatonStep* step, Bsdf* bsdf)
{
    const uint open = automaton_open(step);
    const uint left = bsdf_lobes_of(bsdf, open);
    if ((bsdf->lobes & LOBE_DIELECTRIC) && bsdf_dielectric_is_delta(bsdf)) {
        bsdf->flags |= (open & LETTER_BIT(LETTER_MIRROR)) ? 0u : BSDF_NO_REFLECTION;
        bsdf->flags |= (open & LETTER_BIT(LETTER_REFRACTION)) ? 0u : BSDF_NO_REFRACTION;
    }
    if (left == bsdf->lobes)
        return;
    bsdf->lobes = left;
    bsdf_choose_lobes(bsdf);
}

/* Samples no lobe behind which a ray finds nothing; false if there is no other. Only lights that light
   sampling alone can find end a path there, so the density of BSDF sampling weighs against nothing. */
static inline bool filter_continues(const AutomatonStep* step, Bsdf* bsdf)
{
    const uint lobes = bsdf_lobes_of(bsdf, automaton_continuing(step));
    if (lobes != 0u && lobes != bsdf->lobes)
        bsdf_choose_among(bsdf, lobes);
    return lobes != 0u;
}

/* Lobes that write a letter of their own for the same direction. */
static inline bool filter_is_ambiguous(const AutomatonStep* step, const Bsdf* bsdf)
{
    return bsdf_smooth_letters(bsdf) == FILTER_LETTERS &&
           step->next[LETTER_MATTE] != step->next[LETTER_GLOSSY];
}

/* The part of the BSDF times cosine whose lobes write a letter where they have a density. */
static inline real3 filter_part(const Bsdf* bsdf, uint letter, real3 wi_world)
{
    const uint lobes = bsdf_lobes_of(bsdf, LETTER_BIT(letter));
    return bsdf_eval_lobes(bsdf, lobes, frame_to_local(&bsdf->frame, wi_world)).value;
}

/* What is left of the BSDF's whole value towards a light when only some classes accept it. Where the whole is
   nothing, because the light is on the other side, so are its parts. */
static inline real3 filter_value(const AutomatonStep* step, const Bsdf* bsdf, real3 wi_world, uint kind,
                                 real3 whole)
{
    const uint accepting = bsdf_smooth_letters(bsdf) & automaton_accepting(step, kind);
    if (accepting == 0u)
        return (real3)(REAL(0.0));
    if (!filter_is_ambiguous(step, bsdf) || accepting == FILTER_LETTERS || vector_is_black(whole))
        return whole;
    return filter_part(bsdf, (accepting & LETTER_BIT(LETTER_MATTE)) ? LETTER_MATTE : LETTER_GLOSSY, wi_world);
}

/* True if some light may end a path behind this vertex: else light sampling is useless here. */
static inline bool filter_wants_light(const AutomatonStep* step, const Bsdf* bsdf)
{
    return (bsdf_smooth_letters(bsdf) & automaton_accepting(step, KINDS_ALL)) != 0u;
}

/* A component of f_c / (f P_c). */
static inline real filter_share_component(real part, real rest, real chance)
{
    return part == REAL(0.0) ? REAL(0.0) : part / ((part + rest) * chance);
}

/* Chooses the class of a sampled direction that both lobes scatter: its letter. Gives its share of the value
   over the probability of the choice. A class whose ray finds nothing is not chosen. */
static CLRT_NOINLINE uint filter_choose_letter(const AutomatonStep* step, const Bsdf* bsdf, real3 wi_world,
                                               real u, real3* share)
{
    const real3 matte = filter_part(bsdf, LETTER_MATTE, wi_world);
    const real3 glossy = filter_part(bsdf, LETTER_GLOSSY, wi_world);
    const real size = vector_color_size(matte) + vector_color_size(glossy);
    real chance = size > REAL(0.0) ? vector_color_size(matte) / size : REAL(0.5);
    if (!automaton_continues(step->next[LETTER_GLOSSY]))
        chance = REAL(1.0);
    if (!automaton_continues(step->next[LETTER_MATTE]))
        chance = REAL(0.0);
    const bool is_matte = u < chance;
    const real3 part = is_matte ? matte : glossy;
    const real3 rest = is_matte ? glossy : matte;
    const real taken = is_matte ? chance : REAL(1.0) - chance;
    *share = vector_make(filter_share_component(part.x, rest.x, taken),
                         filter_share_component(part.y, rest.y, taken),
                         filter_share_component(part.z, rest.z, taken));
    return is_matte ? LETTER_MATTE : LETTER_GLOSSY;
}

/* The letter of a sampled direction that is not ambiguous. */
static inline uint filter_letter(const Bsdf* bsdf, const BsdfSample* sample)
{
    if (sample->pdf_w == REAL(0.0))
        return sample->reflects ? LETTER_MIRROR : LETTER_REFRACTION;
    return (bsdf_smooth_letters(bsdf) & LETTER_BIT(LETTER_MATTE)) ? LETTER_MATTE : LETTER_GLOSSY;
}

#endif
