// SPDX-License-Identifier: Apache-2.0
// Counts how many samples of a pixel see each object and each material first.
#ifndef CLRT_FILM_MATTE_H
#define CLRT_FILM_MATTE_H

#include "shared/aov_types.h"

/* Counts a sample for an index among the slots of a kind: in its own, else in the first free one. What finds
   none is left out. */
static inline void matte_count(global uint* slots, uint index)
{
    for (uint i = 0u; i < MATTE_SLOTS; ++i) {
        global uint* slot = slots + MATTE_SLOT_WORDS * i;
        if (slot[MATTE_SAMPLES] == 0u)
            slot[MATTE_INDEX] = index;
        if (slot[MATTE_INDEX] == index) {
            ++slot[MATTE_SAMPLES];
            return;
        }
    }
}

/* Counts a sample that sees an object of a material first. */
static inline void matte_add(global uint* words, uint object, uint material)
{
    matte_count(words + MATTE_OBJECTS * MATTE_KIND_WORDS, object);
    matte_count(words + MATTE_MATERIALS * MATTE_KIND_WORDS, material);
}

#endif
