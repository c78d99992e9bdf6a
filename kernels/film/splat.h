// SPDX-License-Identifier: Apache-2.0
// Splats: radiance that a path brings to the film position where it meets the camera, whichever pixel that is
// in. For builds with -DFILM_SPLATS=1 (sum.h).
#ifndef CLRT_FILM_SPLAT_H
#define CLRT_FILM_SPLAT_H

#include "film/film.h"
#include "film/tile.h"

/* Adds a splat to its pixel's sums of a replicate. `position` is in pixels right of and below the
   picture's centre (render_types.h); outside the window a splat is ignored. `radiance` counts as what one
   sample of the pixel gathers: the pixel is the mean over its samples of all that it is given. It is rounded
   by a random number at the address (number, SAMPLE_ROUNDING) of the sample that splats. A sample numbers its
   splats from 1 on, each once; number 0 is the radiance that it gathers. Returns which counter a bad splat
   belongs to, COUNT_WORDS for a good one; without a film (0) it does nothing else. */
static inline uint film_splat(const RenderParams* params, global long* film, uint replicate,
                              const Sampler* sampler, uint number, real2 position, real3 radiance)
{
    uint slot;
    if (real_is_nan(position.x) || real_is_nan(position.y))
        return COUNT_NAN;
    if (!tile_slot_at(params, position, &slot))
        return COUNT_WORDS;
    const uint fault = film_fault(params, radiance);
    if (fault != COUNT_WORDS || film == 0)
        return fault;
    global long* sums = film_sums(params, film, slot, replicate);
    const uint word = sampler_word(sampler, number, SAMPLE_ROUNDING);
    return film_add_rounded(params, sums, word, radiance) ? COUNT_WORDS : COUNT_OVERFLOW;
}

#endif
