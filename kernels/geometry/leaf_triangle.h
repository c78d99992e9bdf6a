// SPDX-License-Identifier: Apache-2.0
// Leaf triangles one by one: the leaves of the layouts for GPUs.
#ifndef CLRT_GEOMETRY_LEAF_TRIANGLE_H
#define CLRT_GEOMETRY_LEAF_TRIANGLE_H

#include "instance.h"
#include "scene.h"
#include "triangle.h"

/* Tests one leaf triangle, of an instance or, 0, the scene's own, at the ray's time; true where it is hit
   within (0, t_max]. */
static inline bool leaf_triangle_hit(const Scene* scene, global const uint* words, uint instance,
                                     const Ray* ray, const RayShear* shear, real t_max, Hit* found)
{
    global const float* corners = (global const float*)words;
    real x[3], y[3], z[3];
    if (HAS(EFFECT_INSTANCES) && instance != 0u) {
        global const vec4* rows = scene->instances[instance].to_world;
        for (uint corner = 0; corner < 3u; ++corner) {
            const real3 p = convert_real3(vload3(0, corners + 4u * corner));
            x[corner] = instance_coordinate(rows[shear->kx], p);
            y[corner] = instance_coordinate(rows[shear->ky], p);
            z[corner] = instance_coordinate(rows[shear->kz], p);
        }
    } else {
        /* No loop: what it writes would stay in memory. */
        x[0] = corners[shear->kx], x[1] = corners[4u + shear->kx], x[2] = corners[8u + shear->kx];
        y[0] = corners[shear->ky], y[1] = corners[4u + shear->ky], y[2] = corners[8u + shear->ky];
        z[0] = corners[shear->kz], z[1] = corners[4u + shear->kz], z[2] = corners[8u + shear->kz];
    }
    if (scene_moves(scene) && instance == 0u) {
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
    hit_set_triangle(instance, words[3], found);
    return found->t > REAL(0.0) && found->t <= t_max;
}

/* Keeps the hit of one leaf triangle if it comes after `after` and before the hit so far. */
static inline void leaf_triangle_closest(const Scene* scene, global const uint* words, uint instance,
                                         const Ray* ray, const RayShear* shear, const Hit* after, Hit* hit)
{
    Hit found;
    if (!leaf_triangle_hit(scene, words, instance, ray, shear, hit->t, &found) ||
        !hit_comes_before(found.t, instance, found.triangle, hit))
        return;
    if (HAS(EFFECTS_PASSED) && !hit_comes_after(found.t, instance, found.triangle, after))
        return;
    *hit = found;
}

#endif
