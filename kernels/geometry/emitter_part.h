// SPDX-License-Identifier: Apache-2.0
// Parts of emissive triangles: where a map makes a triangle shine unevenly, its parts are emitters of their
// own, small ones where it pays, each chosen by what it sends.
#ifndef CLRT_GEOMETRY_EMITTER_PART_H
#define CLRT_GEOMETRY_EMITTER_PART_H

#include "scene.h"

/* What an emitter is of its triangle, as EmitterPart. */
typedef struct {
    real2 origin;
    real step;
} EmitterShare;

/* Whether triangles have parts. */
static inline bool emitter_part_is_used(const Scene* scene)
{
#if CLRT_EFFECTS & EFFECT_MAPPED_EMISSION
    return scene->has_emitter_parts;
#else
    return false;
#endif
}

/* The share of an emitter. */
static inline EmitterShare emitter_part_of(const Scene* scene, uint emitter)
{
    EmitterShare share = {(real2)(REAL(0.0)), REAL(1.0)};
    if (!emitter_part_is_used(scene))
        return share;
    global const EmitterPart* part = scene->emitter_parts + emitter;
    share.origin = (real2)((real)part->b1, (real)part->b2);
    share.step = (real)part->step;
    return share;
}

/* Replaces a triangle's corners, and its normal by the edges, by the part's. */
static inline void emitter_part_corners(const EmitterShare* share, real3* p0, real3* p1, real3* p2,
                                        real3* normal)
{
    if (share->step == REAL(1.0))
        return;
    const real3 e1 = *p1 - *p0;
    const real3 e2 = *p2 - *p0;
    *p0 += fma((real3)(share->origin.x), e1, share->origin.y * e2);
    *p1 = *p0 + share->step * e1;
    *p2 = *p0 + share->step * e2;
    *normal *= share->step * share->step;
}

/* Barycentric weights of corners 1 and 2 of the triangle, from those of the part. */
static inline real2 emitter_part_weights(const EmitterShare* share, real2 b)
{
    return share->step == REAL(1.0) ? b : fma(b, (real2)(share->step), share->origin);
}

/* The digits of the smallest part that a point is on, by its barycentric weights. */
static inline uint emitter_part_digits(real b1, real b2)
{
    uint digits = 0u;
    for (uint level = 0u; level < EMITTER_LARGEST_LEVEL; ++level) {
        b1 *= REAL(2.0);
        b2 *= REAL(2.0);
        const uint digit = b1 > REAL(1.0) ? 1u : b2 > REAL(1.0) ? 2u : b1 + b2 > REAL(1.0) ? 3u : 0u;
        digits = 4u * digits + digit;
        if (digit == 3u) {
            b1 = REAL(1.0) - b1;
            b2 = REAL(1.0) - b2;
        } else if (digit == 1u)
            b1 -= REAL(1.0);
        else if (digit == 2u)
            b2 -= REAL(1.0);
    }
    return digits;
}

/* The emitter that a point of a triangle is on, by its barycentric weights: `first` or one of those behind
   it, which are the triangle's parts. */
static CLRT_NOINLINE uint emitter_part_find(const Scene* scene, uint first, real b1, real b2)
{
    const uint digits = emitter_part_digits(b1, b2);
    uint begin = first;
    uint count = EMITTER_CODE_PARTS(scene->emitter_parts[first].code);
    /* The last whose code is not above. */
    while (count > 1u) {
        const uint half_count = count / 2u;
        if (EMITTER_CODE_DIGITS(scene->emitter_parts[begin + half_count].code) <= digits) {
            begin += half_count;
            count -= half_count;
        } else
            count = half_count;
    }
    return begin;
}

/* The same of any triangle; NO_INDEX of a dark one. */
static inline uint emitter_part_hit(const Scene* scene, uint first, real b1, real b2)
{
    if (!emitter_part_is_used(scene) || first == NO_INDEX)
        return first;
    return emitter_part_find(scene, first, b1, b2);
}

#endif
