// SPDX-License-Identifier: Apache-2.0
// Traversal of the binary tree with both children's boxes in one 64-byte node (Aila and Laine 2009): scalar
// code for GPUs, right on every device.
//
// A GPU keeps a private array in memory that thousands of rays share, so the stack is short: it holds the
// latest BVH2_STACK_SIZE of the children left behind and forgets older ones. What is left to visit is known
// all the same, from one bit a level (the restart trail of Laine 2010, "Restart trail for stackless BVH
// traversal"): 0 where the nearer of two children was taken and the other waits, 1 where nothing waits. When
// the stack has run dry, traversal goes down from the root once more, and the bits lead it to the child that
// waits.
//
// The way down is the same at every restart although hits shorten the ray: a box above a pending child holds
// all triangles that were hit since it was entered, so it is met up to their distance. Only the pending child
// itself may have fallen behind the hit; its bit, the lowest that is set, tells it from a child that never
// had a sibling.
#ifndef CLRT_GEOMETRY_TRAVERSE_BVH2_H
#define CLRT_GEOMETRY_TRAVERSE_BVH2_H

#include "box.h"
#include "instance.h"
#include "leaf_triangle.h"
#include "scene.h"

/* Children that the stack remembers: a power of two. At 8, eight bytes each. */
#ifndef BVH2_STACK_SIZE
#define BVH2_STACK_SIZE 8
#endif

/* A level of inner nodes is a bit, the root's the highest but one: carrying into the highest ends the
   traversal. Leaves lie on level BVH_MAX_DEPTH at the latest, so BVH_MAX_DEPTH - 1 levels of inner nodes have
   a bit each. */
#define BVH2_END ((ulong)1 << (BVH_MAX_DEPTH - 1))
#define BVH2_ROOT (BVH2_END >> 1)

/* Children left behind, a ring: entry `top` modulo its size is the next to be written. Apart from Bvh2Walk,
   whose members shall stay in registers. */
typedef struct {
    uint nodes[BVH2_STACK_SIZE];
    real entries[BVH2_STACK_SIZE];
} Bvh2Stack;

/* Where a traversal stands. */
typedef struct {
    uint top;
    uint count; /* children on the stack */
    ulong trail;
    ulong level;  /* of the present node */
    ulong resume; /* levels from this one up have been visited before */
} Bvh2Walk;

static inline Bvh2Walk bvh2_walk_make(void)
{
    const Bvh2Walk walk = {0u, 0u, 0, BVH2_ROOT, BVH2_END};
    return walk;
}

/* Gives the inner child to go on with, or 0 where none is left below this node. An entry distance is negative
   where the child is missed or a leaf. */
static inline uint bvh2_walk_down(Bvh2Walk* walk, Bvh2Stack* stack, real entry_0, real entry_1, uint child_0,
                                  uint child_1)
{
    const bool swapped = entry_0 < REAL(0.0) || (entry_1 >= REAL(0.0) && entry_1 < entry_0);
    const uint nearer = swapped ? child_1 : child_0;
    const ulong level = walk->level;
    if (min(entry_0, entry_1) < REAL(0.0)) {
        /* At most one child; where two were met before, it is the one that has been visited. */
        if (max(entry_0, entry_1) < REAL(0.0) || level == walk->resume)
            return 0u;
        walk->trail |= level;
        walk->level = level >> 1;
        return nearer;
    }
    const uint farther = swapped ? child_0 : child_1;
    walk->level = level >> 1;
    if (walk->trail & level)
        return farther;
    stack->nodes[walk->top & (BVH2_STACK_SIZE - 1u)] = farther;
    stack->entries[walk->top++ & (BVH2_STACK_SIZE - 1u)] = max(entry_0, entry_1);
    walk->count = min(walk->count + 1u, (uint)BVH2_STACK_SIZE);
    return nearer;
}

/* Goes to the child that waits on the deepest level, or to the root where it has been forgotten; false where
   none waits before t_max. */
static inline bool bvh2_walk_up(Bvh2Walk* walk, const Bvh2Stack* stack, real t_max, uint root, uint* node)
{
    for (;;) {
        /* Adding a 1 to the parent's bit carries it to the deepest level where a child waits. */
        const ulong parent = walk->level << 1;
        walk->trail = (walk->trail & (0 - parent)) + parent;
        if (walk->trail & BVH2_END)
            return false;
        walk->resume = walk->trail & (0 - walk->trail);
        if (walk->count == 0u) {
            walk->level = BVH2_ROOT;
            *node = root;
            return true;
        }
        walk->level = walk->resume >> 1;
        --walk->count;
        const uint slot = --walk->top & (BVH2_STACK_SIZE - 1u);
        *node = stack->nodes[slot];
        if (stack->entries[slot] <= t_max * BOX_EXIT_FACTOR)
            return true;
    }
}

/* Entry distance of a box, or a negative number where it is missed within (0, t_max]; limit is t_max times
   the exit factor. xy holds lower x, upper x, lower y, upper y. */
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

/* Finds the first hit after `after` and not beyond hit->t, or leaves hit unchanged; with `any`, true at the
   first triangle that is met, whichever it is. `any` is a constant. */
CLRT_INLINE bool bvh2_traverse(const Scene* scene, const RenderParams* params, const Ray* ray,
                               const Hit* after, Hit* hit, bool any)
{
    const BoxRay scene_box = box_ray_make(ray, params->scene_extent);
    const RayShear shear = ray_shear_make(ray);
    BoxRay box = scene_box;
    Bvh2Walk walk = bvh2_walk_make();
    Bvh2Walk scene_walk = walk; /* while the traversal is in an instance */
    Bvh2Stack stacks[HAS(EFFECT_INSTANCES) ? 2 : 1];
    Bvh2Stack* stack = stacks;
    uint instance = 0u, root = 0u, node = 0u;
    for (;;) {
        if (HAS(EFFECT_INSTANCES) && (node & BVH_INSTANCE_BIT)) {
            instance = node & ~BVH_INSTANCE_BIT;
            global const Instance* placed = scene->instances + instance;
            box = instance_box_ray(placed, ray);
            scene_walk = walk;
            walk = bvh2_walk_make();
            stack = stacks + (HAS(EFFECT_INSTANCES) ? 1 : 0);
            node = root = scene->bvh_roots[placed->prototype];
        }
        global const uint* words = scene->bvh_nodes + (size_t)BVH2_NODE_WORDS * node;
        global const float* planes = (global const float*)words;
        const real limit = hit->t * BOX_EXIT_FACTOR;
        SCENE_COUNT_NODE(scene);
        real entry[2] = {bvh2_enter(vload4(0, planes), vload2(4, planes), &box, limit),
                         bvh2_enter(vload4(1, planes), vload2(5, planes), &box, limit)};
        /* Test the triangles of children that are leaves, unless this is the way down of a restart. */
        for (uint side = 0; side < 2u; ++side) {
            const uint child = words[BVH2_CHILD_WORD + side];
            if (entry[side] < REAL(0.0) || !(child & BVH_LEAF_BIT))
                continue;
            entry[side] = REAL(-1.0);
            if (walk.level >= walk.resume)
                continue;
            global const uint* leaf =
                scene->bvh_leaves + (size_t)LEAF_TRIANGLE_WORDS * (child & ~BVH_LEAF_BIT);
            const uint count = words[BVH2_COUNT_WORD + side];
            SCENE_COUNT_LEAF(scene, count);
            for (uint i = 0; i < count; ++i, leaf += LEAF_TRIANGLE_WORDS) {
                Hit found;
                if (!any)
                    leaf_triangle_closest(scene, leaf, instance, ray, &shear, after, hit);
                else if (leaf_triangle_hit(scene, leaf, instance, ray, &shear, hit->t, &found))
                    return true;
            }
        }
        node = bvh2_walk_down(&walk, stack, entry[0], entry[1], words[BVH2_CHILD_WORD],
                              words[BVH2_CHILD_WORD + 1]);
        if (node != 0u || bvh2_walk_up(&walk, stack, hit->t, root, &node))
            continue;
        if (!HAS(EFFECT_INSTANCES) || instance == 0u)
            return false;
        /* Go on in the scene's tree. */
        instance = root = 0u;
        box = scene_box;
        walk = scene_walk;
        stack = stacks;
        if (!bvh2_walk_up(&walk, stack, hit->t, root, &node))
            return false;
    }
}

/* Finds the first hit after `after` and not beyond hit->t; leaves hit unchanged where there is none. */
static CLRT_NOINLINE void bvh2_closest_hit(const Scene* scene, const RenderParams* params, const Ray* ray,
                                           const Hit* after, Hit* hit)
{
    bvh2_traverse(scene, params, ray, after, hit, false);
}

/* True if anything is hit before t_max. */
static CLRT_NOINLINE bool bvh2_any_hit(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    const Hit after = hit_none(REAL(0.0));
    Hit hit = hit_none(ray->t_max);
    return bvh2_traverse(scene, params, ray, &after, &hit, true);
}

#endif
