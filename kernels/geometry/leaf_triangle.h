// SPDX-License-Identifier: Apache-2.0
// Leaf triangles one by one: the leaves of the layouts for GPUs.
#ifndef CLRT_GEOMETRY_LEAF_TRIANGLE_H
#define CLRT_GEOMETRY_LEAF_TRIANGLE_H

#include "scene.h"
#include "triangle.h"

/* Tests one leaf triangle at the ray's time; true where it is hit within (0, t_max]. */
static inline bool leaf_triangle_hit(const Scene* scene, global const uint* words, const Ray* ray,
                                     const RayShear* shear, real t_max, Hit* found)
{
    global const float* corners = (global const float*)words;
    real x[3] = {corners[shear->kx], corners[4 + shear->kx], corners[8 + shear->kx]};
    real y[3] = {corners[shear->ky], corners[4 + shear->ky], corners[8 + shear->ky]};
    real z[3] = {corners[shear->kz], corners[4 + shear->kz], corners[8 + shear->kz]};
    if (scene_moves(scene)) {
        global const float* moves =
            (global const float*)(scene->bvh_leaf_moves + (words - scene->bvh_leaves));
        const real time = ray_time(ray);
        for (uint corner = 0; corner < 3u; ++corner) {
            x[corner] = fma(time, (real)moves[4u * corner + shear->kx], x[corner]);
            y[corner] = fma(time, (real)moves[4u * corner + shear->ky], y[corner]);
            z[corner] = fma(time, (real)moves[4u * corner + shear->kz], z[corner]);
        }
    }
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
static inline void leaf_triangle_closest(const Scene* scene, global const uint* words, const Ray* ray,
                                         const RayShear* shear, const Hit* after, Hit* hit)
{
    Hit found;
    if (!leaf_triangle_hit(scene, words, ray, shear, hit->t, &found) ||
        !hit_is_before(found.t, found.triangle, hit->t, hit->triangle))
        return;
    if (HAS(EFFECTS_PASSED) && !hit_is_before(after->t, after->triangle, found.t, found.triangle))
        return;
    *hit = found;
}

#endif
