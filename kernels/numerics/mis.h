// SPDX-License-Identifier: Apache-2.0
// Weights of multiple importance sampling (Veach 1997, ch. 9).
#ifndef CLRT_NUMERICS_MIS_H
#define CLRT_NUMERICS_MIS_H

#include "numerics/real.h"

/* Power heuristic, exponent 2, of a sample drawn with density pdf_a where the other technique has pdf_b. Only
   the ratio is squared, so densities from 1e-38 to 1e38 are fine. pdf_a is 0 for a delta lobe, which no other
   technique can sample: the weight is 1. */
static inline real mis_weight(real pdf_a, real pdf_b)
{
    if (pdf_a == REAL(0.0))
        return REAL(1.0);
    const real ratio = pdf_b / pdf_a;
    return REAL(1.0) / fma(ratio, ratio, REAL(1.0));
}

#endif
