// SPDX-License-Identifier: Apache-2.0
// Leaf triangles one by one: the leaves of the layouts for GPUs.
#ifndef CLRT_GEOMETRY_LEAF_TRIANGLE_H
#define CLRT_GEOMETRY_LEAF_TRIANGLE_H

#include "scene.h"
#include "triangle.h"

/* Tests one leaf triangle; true where it is hit within (0, t_max]. */
static inline bool leaf_triangle_hit(global const uint* words, const RayShear* shear, real t_max, Hit* found)
{
    global const float* corners = (global const float*)words;
    const real x[3] = {corners[shear->kx], corners[4 + shear->kx], corners[8 + shear->kx]};
    const real y[3] = {corners[shear->ky], corners[4 + shear->ky], corners[8 + shear->ky]};
    const real z[3] = {corners[shear->kz], corners[4 + shear->kz], corners[8 + shear->kz]};
    real u, v, w, det, t_det;
    triangle_edges(shear, x, y, z, &u, &v, &w, &det, &t_det);
    const bool inside = min(u, min(v, w)) >= REAL(0.0) || max(u, max(v, w)) <= REAL(0.0);
    if (!inside || det == REAL(0.0))
        return false;
    found->t = t_det / det;
    found->b1 = v / det;
    found->b2 = w / det;
    found->triangle = words[3];
    return found->t > REAL(0.0) && found->t <= t_max;
}

/* Keeps the hit of one leaf triangle if it comes after `after` and before the hit so far. */
static inline void leaf_triangle_closest(global const uint* words, const RayShear* shear, const Hit* after,
                                         Hit* hit)
{
    Hit found;
    if (!leaf_triangle_hit(words, shear, hit->t, &found) ||
        !hit_is_before(found.t, found.triangle, hit->t, hit->triangle))
        return;
    if (HAS(EFFECT_CUT_OUT) && !hit_is_before(after->t, after->triangle, found.t, found.triangle))
        return;
    *hit = found;
}

#endif
