// SPDX-License-Identifier: Apache-2.0
// Russian roulette (Arvo and Kirk 1990), which ends paths of small weight without bias: what survives weighs
// more by one over the probability of that.
#ifndef CLRT_PATH_ROULETTE_H
#define CLRT_PATH_ROULETTE_H

#include "numerics/real.h"

/* Paths of this weight and more are never ended. With 1, so that survivors weigh as much as when they set
   out, the noise of who survives costs rooms a quarter more time at equal error than the rays that it saves;
   with an eighth the rays cost more again. */
#define ROULETTE_THRESHOLD REAL(0.25)

/* Nothing survives with less than this: a weight grows at most twentyfold. */
#define ROULETTE_SMALLEST_SURVIVAL REAL(0.05)

/* The least probability of surviving many times that roulette_rarity tells apart. */
#define ROULETTE_SMALLEST_IN_ALL REAL(1e-3)

/* The probability with which a path of this weight survives. `weight`: of what it may still find, over that
   of what it could find when it set out. */
static inline real roulette_survival(real weight)
{
    return clamp(weight / ROULETTE_THRESHOLD, ROULETTE_SMALLEST_SURVIVAL, REAL(1.0));
}

/* How much rarer a light path's roulette makes a path of `segments` than that of path would, which ends none
   of at most `depth` segments. Survivors keep the threshold's weight, so that all that path has survived goes
   by what it would weigh without. `eye`: its weight where the light path is connected to it; `ahead`: what the
   light path has kept without roulette; `survived`: the probability of that. */
static inline real roulette_rarity(uint segments, uint depth, real eye, real ahead, real survived)
{
    const real in_all = clamp(eye * ahead / ROULETTE_THRESHOLD, ROULETTE_SMALLEST_IN_ALL, REAL(1.0));
    const real alone = segments > depth ? in_all : REAL(1.0);
    return survived / alone;
}

#endif
