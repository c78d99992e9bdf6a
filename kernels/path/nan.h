// SPDX-License-Identifier: Apache-2.0
// NaNs on their way to the film, which counts them (film_fault). Most get there by themselves: a NaN in a
// product or a sum stays one. But every comparison with it is false: a lobe seems to face away, a light to be
// behind the surface, and the sample ends as if nothing were wrong. What is only compared with, directions
// and normals, is therefore summed up along the path, and the sum is looked at where the path ends.
// (Elsewhere comparisons are written so that a NaN goes the way of the values that are used: x <= 0 ends, not
// !(x > 0).)
#ifndef CLRT_PATH_NAN_H
#define CLRT_PATH_NAN_H

#include "geometry/ray.h"
#include "geometry/scene.h"
#include "trace/trace.h"

/* A NaN where a component is one, else 0: infinities do not cancel in what is never -infinity. */
static inline real nan_of_vector(real3 v)
{
    const real sum = v.x + v.y + v.z;
    return real_is_nan(sum) ? sum : REAL(0.0);
}

/* A ray that cannot be traced ends nowhere, at a distance that is a NaN (scene_closest_hit). */
static inline real nan_of_miss(const Hit* hit) { return real_is_nan(hit->t) ? hit->t : REAL(0.0); }

/* Carries what these give to the radiance of a sample; true if it is a NaN. */
static inline bool nan_carry(const Scene* scene, real nan, real3* radiance)
{
    *radiance += nan;
    if (!real_is_nan(nan))
        return false;
    TRACE_VECTOR(scene, TRACE_ADDED, (real3)(nan));
    return true;
}

/* Takes a direction or a normal into the sum. */
static inline void nan_watch(const Scene* scene, real3 v, real3* sum)
{
    *sum += v;
    if (real_is_nan(nan_of_vector(v))) {
        TRACE_VECTOR(scene, TRACE_ADDED, v);
    }
}

#endif
