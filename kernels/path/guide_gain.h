// SPDX-License-Identifier: Apache-2.0
// What a guide gains, told by the guided samples alone. The same path has a density with the guide and one
// without, and the mean of a sample's value is the same either way. So the second moment that unguided
// samples would have is that of the guided ones, each weighted by the ratio of both densities, and the
// difference of the two moments is that of the variances (after Grittmann et al. 2022). It is much surer than
// the difference of two measured variances: what is rarely seen is in both moments at once, and it is seen
// more often by the density that finds it.
//
// A sample's value is a sum of contributions c_v, of which each has the ratio P_v of the densities of the
// path up to it: its squared sum weighs sum P_v c_v (c_v + 2 sum_(w > v) c_w).
#ifndef CLRT_PATH_GUIDE_GAIN_H
#define CLRT_PATH_GUIDE_GAIN_H

#include "roulette.h"

/* What a path carries for it. Contributions are sums of channels. */
typedef struct {
    real ratio;      /* density of the path with the guide over that without */
    real next_ratio; /* the same at its next vertex */
    real excess;     /* sum of contributions, each times its ratio less 1 */
    real found;      /* sum of contributions, */
    real unit;       /* and what they count by from now on */
    real gain;       /* second moment of that sum without the guide less the one with it, as this path says */
} GuideGain;

static inline void gain_begin(GuideGain* gain)
{
    gain->ratio = gain->next_ratio = REAL(1.0);
    gain->excess = gain->found = gain->gain = REAL(0.0);
    gain->unit = REAL(1.0);
}

/* From now on the path counts what it finds from zero, in other units. */
static inline void gain_count_anew(real unit, GuideGain* gain)
{
    gain->found = REAL(0.0);
    gain->unit = unit;
}

/* Takes what the path has found since the last time; `found`: all that it has. */
static inline void gain_add(real found, GuideGain* gain)
{
    const real contribution = gain->unit * (found - gain->found);
    const real excess = (gain->ratio - REAL(1.0)) * contribution;
    gain->gain += contribution * fma(REAL(2.0), gain->excess, excess);
    gain->excess += excess;
    gain->found = found;
}

/* The path comes to its next vertex. */
static inline void gain_advance(GuideGain* gain)
{
    gain->ratio = gain->next_ratio;
}

/* The path leaves a vertex in a direction that has this ratio of densities. */
static inline void gain_leave(real ratio, GuideGain* gain)
{
    gain->next_ratio = gain->ratio * ratio;
}

/* The path has survived Russian roulette with a probability that is not what it would have been without the
   guide, where its weight is larger by the ratio; `size`: what plain roulette goes by. */
static inline void gain_survive(real survival, real size, GuideGain* gain)
{
    gain->next_ratio *= survival / roulette_survival(size * gain->next_ratio);
}

#endif
