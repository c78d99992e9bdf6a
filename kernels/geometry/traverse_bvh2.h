// SPDX-License-Identifier: Apache-2.0
// Traversal of the binary tree with both children's boxes in one 64-byte node (Aila and Laine 2009): scalar code for
// GPUs, right on every device.
#ifndef CLRT_GEOMETRY_TRAVERSE_BVH2_H
#define CLRT_GEOMETRY_TRAVERSE_BVH2_H

#include "box.h"
#include "scene.h"
#include "triangle.h"

/* A level leaves at most one sibling behind. */
#define BVH2_STACK_SIZE (BVH_MAX_DEPTH + 1)

/* Entry distance of a box, or a negative number where it is missed within (0, t_max]; limit is t_max times the exit factor.
   xy holds lower x, upper x, lower y, upper y. */
static inline real bvh2_enter(float4 xy, float2 z, const BoxRay* box, real limit)
{
    const bool left = box->reciprocal.x < REAL(0.0);
    const bool down = box->reciprocal.y < REAL(0.0);
    const bool back = box->reciprocal.z < REAL(0.0);
    const real near_x = fma((real)(left ? xy.y : xy.x), box->reciprocal.x, box->entry_offset.x);
    const real near_y = fma((real)(down ? xy.w : xy.z), box->reciprocal.y, box->entry_offset.y);
    const real near_z = fma((real)(back ? z.y : z.x), box->reciprocal.z, box->entry_offset.z);
    const real far_x = fma((real)(left ? xy.x : xy.y), box->exit_reciprocal.x, box->exit_offset.x);
    const real far_y = fma((real)(down ? xy.z : xy.w), box->exit_reciprocal.y, box->exit_offset.y);
    const real far_z = fma((real)(back ? z.x : z.y), box->exit_reciprocal.z, box->exit_offset.z);
    /* All operands are finite, so min and max are defined. */
    const real entry = max(max(near_x, near_y), max(near_z, REAL(0.0)));
    const real leave = min(min(far_x, far_y), min(far_z, limit));
    return entry <= leave ? entry : REAL(-1.0);
}

/* Tests one leaf triangle; true where it is hit within (0, t_max]. */
static inline bool bvh2_triangle(global const uint* words, const RayShear* shear, real t_max, Hit* found)
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

/* Finds the first hit after `after` and not beyond hit->t; leaves hit unchanged where there is none. */
static CLRT_NOINLINE void bvh2_closest_hit(const Scene* scene, const RenderParams* params, const Ray* ray,
                                           const Hit* after, Hit* hit)
{
    const BoxRay box = box_ray_make(ray, params->scene_extent);
    const RayShear shear = ray_shear_make(ray);
    uint stack[BVH2_STACK_SIZE];
    real stack_t[BVH2_STACK_SIZE];
    int top = 0;
    uint node = 0;
    for (;;) {
        global const uint* words = scene->bvh_nodes + BVH2_NODE_WORDS * node;
        global const float* planes = (global const float*)words;
        SCENE_COUNT_NODE(scene);
        const real limit = hit->t * BOX_EXIT_FACTOR;
        real entry[2] = {bvh2_enter(vload4(0, planes), vload2(4, planes), &box, limit),
                         bvh2_enter(vload4(1, planes), vload2(5, planes), &box, limit)};
        /* Test the triangles of children that are leaves. */
        for (uint side = 0; side < 2u; ++side) {
            const uint child = words[BVH2_CHILD_WORD + side];
            if (entry[side] < REAL(0.0) || !(child & BVH_LEAF_BIT))
                continue;
            global const uint* leaf = scene->bvh_leaves + BVH2_TRIANGLE_WORDS * (child & ~BVH_LEAF_BIT);
            SCENE_COUNT_LEAF(scene, words[BVH2_COUNT_WORD + side]);
            for (uint i = 0; i < words[BVH2_COUNT_WORD + side]; ++i) {
                Hit found;
                if (!bvh2_triangle(leaf + BVH2_TRIANGLE_WORDS * i, &shear, hit->t, &found) ||
                    !hit_is_before(found.t, found.triangle, hit->t, hit->triangle))
                    continue;
                if (HAS(EFFECT_CUT_OUT) && !hit_is_before(after->t, after->triangle, found.t, found.triangle))
                    continue;
                *hit = found;
            }
            entry[side] = REAL(-1.0);
        }
        /* Go on with the nearer inner child, keep the other. */
        const uint nearer = entry[1] >= REAL(0.0) && (entry[0] < REAL(0.0) || entry[1] < entry[0]) ? 1u : 0u;
        if (entry[nearer] >= REAL(0.0)) {
            if (entry[1u - nearer] >= REAL(0.0)) {
                stack[top] = words[BVH2_CHILD_WORD + 1u - nearer];
                stack_t[top++] = entry[1u - nearer];
            }
            node = words[BVH2_CHILD_WORD + nearer];
            continue;
        }
        do {
            if (top == 0)
                return;
            node = stack[--top];
        } while (stack_t[top] > hit->t * BOX_EXIT_FACTOR);
    }
}

/* True if anything is hit before t_max. */
static CLRT_NOINLINE bool bvh2_any_hit(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    const BoxRay box = box_ray_make(ray, params->scene_extent);
    const RayShear shear = ray_shear_make(ray);
    const real limit = ray->t_max * BOX_EXIT_FACTOR;
    uint stack[BVH2_STACK_SIZE];
    int top = 0;
    uint node = 0;
    for (;;) {
        global const uint* words = scene->bvh_nodes + BVH2_NODE_WORDS * node;
        global const float* planes = (global const float*)words;
        SCENE_COUNT_NODE(scene);
        for (uint side = 0; side < 2u; ++side) {
            if (bvh2_enter(vload4(side, planes), vload2(4 + side, planes), &box, limit) < REAL(0.0))
                continue;
            const uint child = words[BVH2_CHILD_WORD + side];
            if (!(child & BVH_LEAF_BIT)) {
                stack[top++] = child;
                continue;
            }
            global const uint* leaf = scene->bvh_leaves + BVH2_TRIANGLE_WORDS * (child & ~BVH_LEAF_BIT);
            SCENE_COUNT_LEAF(scene, words[BVH2_COUNT_WORD + side]);
            Hit found;
            for (uint i = 0; i < words[BVH2_COUNT_WORD + side]; ++i)
                if (bvh2_triangle(leaf + BVH2_TRIANGLE_WORDS * i, &shear, ray->t_max, &found))
                    return true;
        }
        if (top == 0)
            return false;
        node = stack[--top];
    }
}

#endif
