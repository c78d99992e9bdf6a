// SPDX-License-Identifier: Apache-2.0
// Traversal of the eight-wide tree: one ray against eight boxes or eight triangles at a time with real8. For CPU devices;
// PoCL turns the vectors into AVX or AVX-512.
#ifndef CLRT_GEOMETRY_TRAVERSE_BVH8_H
#define CLRT_GEOMETRY_TRAVERSE_BVH8_H

#include "box.h"
#include "scene.h"
#include "triangle.h"

/* A level of the tree leaves at most seven siblings behind. */
#define BVH8_STACK_SIZE (7 * BVH_MAX_DEPTH + 1)

static inline real8 bvh8_load(global const uint* words)
{
    return convert_real8(vload8(0, (global const float*)words));
}

/* Lanes as the low eight bits of a word. */
static inline uint bvh8_lanes(mask8 mask)
{
#ifdef CLRT_HAS_MOVMSKPS
    return (uint)__builtin_ia32_movmskps256(as_float8(mask));
#else
    /* Bit 0 of byte i moves to bit 56 + i. */
    const ulong bytes = as_ulong(convert_char8(mask)) & 0x0101010101010101ul;
    return (uint)((bytes * 0x0102040810204080ul) >> 56);
#endif
}

/* The lowest lane of a mask that is not 0. */
static inline uint bvh8_first_lane(uint lanes) { return 31u - clz(lanes & -lanes); }

/* Tests the node's eight boxes against (0, t_max]; gives the lanes that are met and all entry distances. */
static inline uint bvh8_enter(global const uint* node, const BoxRay* box, uint8 planes, real t_max, real8* entry)
{
    const real8 near_x = fma(bvh8_load(node + planes.s0), (real8)(box->reciprocal.x), (real8)(box->entry.x));
    const real8 near_y = fma(bvh8_load(node + planes.s1), (real8)(box->reciprocal.y), (real8)(box->entry.y));
    const real8 near_z = fma(bvh8_load(node + planes.s2), (real8)(box->reciprocal.z), (real8)(box->entry.z));
    const real8 far_x = fma(bvh8_load(node + planes.s3), (real8)(box->reciprocal.x), (real8)(box->exit.x));
    const real8 far_y = fma(bvh8_load(node + planes.s4), (real8)(box->reciprocal.y), (real8)(box->exit.y));
    const real8 far_z = fma(bvh8_load(node + planes.s5), (real8)(box->reciprocal.z), (real8)(box->exit.z));
    /* All operands are finite, so min and max are defined. */
    *entry = max(max(near_x, near_y), max(near_z, (real8)(REAL(0.0))));
    const real8 leave = min(min(far_x, far_y), min(far_z, (real8)(t_max)));
    return bvh8_lanes(*entry <= leave * BOX_EXIT_FACTOR);
}

/* Word offsets of the near planes x, y, z and the far planes x, y, z for a direction. */
static inline uint8 bvh8_planes(real3 reciprocal)
{
    const uint x = reciprocal.x < REAL(0.0) ? 8u : 0u;
    const uint y = reciprocal.y < REAL(0.0) ? 24u : 16u;
    const uint z = reciprocal.z < REAL(0.0) ? 40u : 32u;
    return (uint8)(x, y, z, 8u - x, 40u - y, 72u - z, 0u, 0u);
}

/* What a block's eight triangles give; v and w are still to be divided by det. */
typedef struct {
    real8 v, w, det;
    real8 t;
    uint lanes; /* hit within (0, t_max] */
} BlockHits;

static inline BlockHits bvh8_block(global const uint* block, const RayShear* shear, real t_max)
{
    global const uint* words[3] = {block + 24u * shear->kx, block + 24u * shear->ky, block + 24u * shear->kz};
    const real8 x[3] = {bvh8_load(words[0]), bvh8_load(words[0] + 8), bvh8_load(words[0] + 16)};
    const real8 y[3] = {bvh8_load(words[1]), bvh8_load(words[1] + 8), bvh8_load(words[1] + 16)};
    const real8 z[3] = {bvh8_load(words[2]), bvh8_load(words[2] + 8), bvh8_load(words[2] + 16)};
    BlockHits hits;
    real8 u, t_det;
    triangle_edges_8(shear, x, y, z, &u, &hits.v, &hits.w, &hits.det, &t_det);
    const mask8 inside = (min(u, min(hits.v, hits.w)) >= REAL(0.0)) | (max(u, max(hits.v, hits.w)) <= REAL(0.0));
    /* Dividing always is cheaper than a branch that half of the blocks take. */
    hits.t = t_det / hits.det;
    hits.lanes = bvh8_lanes(inside & (hits.det != REAL(0.0)) & (hits.t > REAL(0.0)) & (hits.t <= t_max));
    return hits;
}

/* Keeps the first of the block's hits that comes after `after`. */
static inline void bvh8_block_closest(global const uint* block, const RayShear* shear, const Hit* after, Hit* hit)
{
    const BlockHits hits = bvh8_block(block, shear, hit->t);
    if (hits.lanes == 0u)
        return;
    real t[8], v[8], w[8], det[8];
    vstore8(hits.t, 0, t);
    vstore8(hits.v, 0, v);
    vstore8(hits.w, 0, w);
    vstore8(hits.det, 0, det);
    for (uint lanes = hits.lanes; lanes != 0u; lanes &= lanes - 1u) {
        const uint lane = bvh8_first_lane(lanes);
        const uint triangle = block[BVH8_BLOCK_ID_WORD + lane];
        if (!hit_is_before(t[lane], triangle, hit->t, hit->triangle))
            continue;
        if (HAS(EFFECT_CUT_OUT) && !hit_is_before(after->t, after->triangle, t[lane], triangle))
            continue;
        hit->t = t[lane];
        hit->b1 = v[lane] / det[lane];
        hit->b2 = w[lane] / det[lane];
        hit->triangle = triangle;
    }
}

/* Pushes the entered children so that the nearest is on top; gives the new stack size. */
static inline int bvh8_push_sorted(global const uint* children, uint lanes, const real* entries, uint* stack,
                                   real* stack_t, int top)
{
    const int bottom = top;
    for (; lanes != 0u; lanes &= lanes - 1u) {
        const uint lane = bvh8_first_lane(lanes);
        const real t = entries[lane];
        int slot = top++;
        for (; slot > bottom && stack_t[slot - 1] < t; --slot) {
            stack[slot] = stack[slot - 1];
            stack_t[slot] = stack_t[slot - 1];
        }
        stack[slot] = children[lane];
        stack_t[slot] = t;
    }
    return top;
}

/* Finds the first hit after `after` and not beyond hit->t; leaves hit unchanged where there is none. */
static CLRT_NOINLINE void bvh8_closest_hit(const Scene* scene, const RenderParams* params, const Ray* ray,
                                           const Hit* after, Hit* hit)
{
    const BoxRay box = box_ray_make(ray, params->scene_extent);
    const RayShear shear = ray_shear_make(ray);
    const uint8 planes = bvh8_planes(box.reciprocal);
    uint stack[BVH8_STACK_SIZE];
    real stack_t[BVH8_STACK_SIZE];
    real entries[8];
    int top = 0;
    uint child = 0;
    for (;;) {
        /* Go down to a leaf, leaving the farther children on the stack. */
        while (!(child & BVH_LEAF_BIT)) {
            global const uint* node = scene->bvh_nodes + BVH8_NODE_WORDS * child;
            real8 entry;
            const uint lanes = bvh8_enter(node, &box, planes, hit->t, &entry);
            if (lanes == 0u)
                break;
            /* One or two children are the usual case, and need no sorting. */
            const uint first = bvh8_first_lane(lanes);
            uint rest = lanes & (lanes - 1u);
            if (rest == 0u) {
                child = node[BVH8_CHILD_WORD + first];
                continue;
            }
            vstore8(entry, 0, entries);
            if ((rest & (rest - 1u)) == 0u) {
                const uint second = bvh8_first_lane(rest);
                const bool swapped = entries[second] < entries[first];
                stack[top] = node[BVH8_CHILD_WORD + (swapped ? first : second)];
                stack_t[top++] = entries[swapped ? first : second];
                child = node[BVH8_CHILD_WORD + (swapped ? second : first)];
                continue;
            }
            top = bvh8_push_sorted(node + BVH8_CHILD_WORD, lanes, entries, stack, stack_t, top) - 1;
            child = stack[top];
        }
        if (child & BVH_LEAF_BIT)
            bvh8_block_closest(scene->bvh_leaves + BVH8_BLOCK_WORDS * (child & ~BVH_LEAF_BIT), &shear, after, hit);
        /* Take the nearest child that can still hold a nearer hit. */
        do {
            if (top == 0)
                return;
            child = stack[--top];
        } while (stack_t[top] > hit->t * BOX_EXIT_FACTOR);
    }
}

/* True if anything is hit before t_max. */
static CLRT_NOINLINE bool bvh8_any_hit(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    const BoxRay box = box_ray_make(ray, params->scene_extent);
    const RayShear shear = ray_shear_make(ray);
    const uint8 planes = bvh8_planes(box.reciprocal);
    uint stack[BVH8_STACK_SIZE];
    int top = 0;
    uint child = 0;
    for (;;) {
        if (child & BVH_LEAF_BIT) {
            if (bvh8_block(scene->bvh_leaves + BVH8_BLOCK_WORDS * (child & ~BVH_LEAF_BIT), &shear, ray->t_max).lanes)
                return true;
        } else {
            global const uint* node = scene->bvh_nodes + BVH8_NODE_WORDS * child;
            real8 entry;
            for (uint lanes = bvh8_enter(node, &box, planes, ray->t_max, &entry); lanes != 0u; lanes &= lanes - 1u)
                stack[top++] = node[BVH8_CHILD_WORD + bvh8_first_lane(lanes)];
        }
        if (top == 0)
            return false;
        child = stack[--top];
    }
}

#endif
