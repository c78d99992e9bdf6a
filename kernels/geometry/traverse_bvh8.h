// SPDX-License-Identifier: Apache-2.0
// Traversal of the eight-wide tree: one ray against eight boxes or eight triangles at a time with real8. For
// CPU devices; PoCL turns the vectors into AVX or AVX-512.
//
// A step of the traversal is a chain of waits: child's index, node's planes, box test, mask, child's index.
// Two things shorten it. Where a child is chosen by a branch for its lane, instead of an address computed
// from the mask, a processor that predicts branches starts on the next node while the test of this one is on
// its way. And what goes to the stack is prefetched.
#ifndef CLRT_GEOMETRY_TRAVERSE_BVH8_H
#define CLRT_GEOMETRY_TRAVERSE_BVH8_H

#include "box.h"
#include "instance.h"
#include "scene.h"
#include "triangle.h"

/* A level of a tree leaves at most seven siblings behind. An instance's tree stands on the scene's. */
#define BVH8_STACK_SIZE ((HAS(EFFECT_INSTANCES) ? 2 : 1) * 7 * BVH_MAX_DEPTH + 1)

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

/* The node of an inner child and the block of a leaf. */
static inline global const uint* bvh8_node(const Scene* scene, uint child)
{
    return scene->bvh_nodes + (size_t)BVH8_NODE_WORDS * child;
}

static inline global const uint* bvh8_leaf(const Scene* scene, uint child)
{
    return scene->bvh_leaves + (size_t)BVH8_BLOCK_WORDS * (child & ~BVH_LEAF_BIT);
}

/* The instance that a child of the scene's tree is, 0 for any other. */
static inline uint bvh8_instance(uint child)
{
    const bool is_instance = HAS(EFFECT_INSTANCES) && (child & BVH_LEAF_BIT) && (child & BVH_INSTANCE_BIT);
    return is_instance ? child & ~(BVH_LEAF_BIT | BVH_INSTANCE_BIT) : 0u;
}

/* Starts to load what a child consists of: four cache lines of a node, of a block all but its triangle
   indices, an instance. */
static inline void bvh8_prefetch(const Scene* scene, uint child)
{
    if (HAS(EFFECT_INSTANCES) && bvh8_instance(child) != 0u) {
        global const float* members = (global const float*)(scene->instances + bvh8_instance(child));
        CLRT_PREFETCH(members);
        CLRT_PREFETCH(members + 16);
        return;
    }
    global const uint* words = child & BVH_LEAF_BIT ? bvh8_leaf(scene, child) : bvh8_node(scene, child);
    CLRT_PREFETCH(words);
    CLRT_PREFETCH(words + 16);
    CLRT_PREFETCH(words + 32);
    CLRT_PREFETCH(words + 48);
}

/* Tests the node's eight boxes against (0, t_max], where limit is t_max times the exit factor; gives the
   lanes that are met and all entry distances. */
static inline uint bvh8_enter(global const uint* node, const BoxRay* box, uint8 planes, real limit,
                              real8* entry)
{
    const real8 near_x =
        fma(bvh8_load(node + planes.s0), (real8)(box->reciprocal.x), (real8)(box->entry_offset.x));
    const real8 near_y =
        fma(bvh8_load(node + planes.s1), (real8)(box->reciprocal.y), (real8)(box->entry_offset.y));
    const real8 near_z =
        fma(bvh8_load(node + planes.s2), (real8)(box->reciprocal.z), (real8)(box->entry_offset.z));
    const real8 far_x =
        fma(bvh8_load(node + planes.s3), (real8)(box->exit_reciprocal.x), (real8)(box->exit_offset.x));
    const real8 far_y =
        fma(bvh8_load(node + planes.s4), (real8)(box->exit_reciprocal.y), (real8)(box->exit_offset.y));
    const real8 far_z =
        fma(bvh8_load(node + planes.s5), (real8)(box->exit_reciprocal.z), (real8)(box->exit_offset.z));
    /* All operands are finite, so min and max are defined. */
    *entry = max(max(near_x, near_y), max(near_z, (real8)(REAL(0.0))));
    const real8 leave = min(min(far_x, far_y), min(far_z, (real8)(limit)));
    return bvh8_lanes(*entry <= leave);
}

/* Word offsets of the near planes x, y, z and the far planes x, y, z for a direction. */
static inline uint8 bvh8_planes(real3 reciprocal)
{
    const uint x = reciprocal.x < REAL(0.0) ? 8u : 0u;
    const uint y = reciprocal.y < REAL(0.0) ? 24u : 16u;
    const uint z = reciprocal.z < REAL(0.0) ? 40u : 32u;
    return (uint8)(x, y, z, 8u - x, 40u - y, 72u - z, 0u, 0u);
}

/* How many triangles a block holds. */
static inline uint bvh8_block_size(global const uint* block)
{
    uint size = 0u;
    for (uint lane = 0; lane < BVH8_WIDTH; ++lane)
        size += block[BVH8_BLOCK_ID_WORD + lane] != NO_INDEX ? 1u : 0u;
    return size;
}

/* What a block's eight triangles give; v and w are still to be divided by det. */
typedef struct {
    real8 v, w, det;
    real8 t;
    uint lanes; /* hit within (0, t_max] */
} BlockHits;

/* Moves corners' coordinates along a permuted axis to a time; `words` are those of the first corner. No loop
   here and below: what a loop writes stays in memory, which makes rays a third slower. */
static inline void bvh8_move(const Scene* scene, global const uint* words, real time, real8* corners)
{
    global const uint* moves = scene->bvh_leaf_moves + (words - scene->bvh_leaves);
    corners[0] = fma((real8)(time), bvh8_load(moves), corners[0]);
    corners[1] = fma((real8)(time), bvh8_load(moves + 8), corners[1]);
    corners[2] = fma((real8)(time), bvh8_load(moves + 16), corners[2]);
}

/* The coordinates along a permuted axis of the corners of a block of the scene's own tree. */
static inline void bvh8_corners(const Scene* scene, global const uint* block, uint axis, real time,
                                real8* corners)
{
    global const uint* words = block + 24u * axis;
    corners[0] = bvh8_load(words);
    corners[1] = bvh8_load(words + 8);
    corners[2] = bvh8_load(words + 16);
    if (scene_moves(scene))
        bvh8_move(scene, words, time, corners);
}

/* The same of a block of an instance (instance_point). */
static inline void bvh8_instance_corners(global const uint* block, vec4 row, real8* corners)
{
    for (uint corner = 0; corner < 3u; ++corner) {
        const real8 x = bvh8_load(block + 8u * corner);
        const real8 y = bvh8_load(block + 24u + 8u * corner);
        const real8 z = bvh8_load(block + 48u + 8u * corner);
        const real8 sum = fma((real8)((real)row.z), z, (real8)((real)row.w));
        corners[corner] = fma((real8)((real)row.x), x, fma((real8)((real)row.y), y, sum));
    }
}

/* `instance`: 0 for a block of the scene's own tree. */
static inline BlockHits bvh8_block(const Scene* scene, global const uint* block, uint instance,
                                   const RayShear* shear, real time, real t_max)
{
    real8 x[3], y[3], z[3];
    if (HAS(EFFECT_INSTANCES) && instance != 0u) {
        global const vec4* rows = scene->instances[instance].to_world;
        bvh8_instance_corners(block, rows[shear->kx], x);
        bvh8_instance_corners(block, rows[shear->ky], y);
        bvh8_instance_corners(block, rows[shear->kz], z);
    } else {
        bvh8_corners(scene, block, shear->kx, time, x);
        bvh8_corners(scene, block, shear->ky, time, y);
        bvh8_corners(scene, block, shear->kz, time, z);
    }
    BlockHits hits;
    real8 u, t_det;
    triangle_edges_8(shear, x, y, z, &u, &hits.v, &hits.w, &hits.det, &t_det);
    const mask8 inside =
        (min(u, min(hits.v, hits.w)) >= REAL(0.0)) | (max(u, max(hits.v, hits.w)) <= REAL(0.0));
    /* Dividing always is cheaper than a branch that half of the blocks take. */
    hits.t = t_det / hits.det;
    hits.lanes = bvh8_lanes(inside & (hits.det != REAL(0.0)) & (hits.t > REAL(0.0)) & (hits.t <= t_max));
    return hits;
}

/* Keeps the first of the block's hits that comes after `after`. */
static inline void bvh8_block_closest(const Scene* scene, global const uint* block, uint instance,
                                      const RayShear* shear, real time, const Hit* after, Hit* hit)
{
    const BlockHits hits = bvh8_block(scene, block, instance, shear, time, hit->t);
    if (hits.lanes == 0u)
        return;
    real t[8], v[8], w[8], det[8];
    vstore8(hits.t, 0, t);
    vstore8(hits.v, 0, v);
    vstore8(hits.w, 0, w);
    vstore8(hits.det, 0, det);
    for (uint lanes = hits.lanes; lanes != 0u; lanes &= lanes - 1u) {
        const uint lane = CLRT_LOWEST_BIT(lanes);
        const uint triangle = block[BVH8_BLOCK_ID_WORD + lane];
        if (!hit_comes_before(t[lane], instance, triangle, hit))
            continue;
        if (HAS(EFFECTS_PASSED) && !hit_comes_after(t[lane], instance, triangle, after))
            continue;
        hit->t = t[lane];
        hit->b1 = v[lane] / det[lane];
        hit->b2 = w[lane] / det[lane];
        hit_set_triangle(instance, triangle, hit);
    }
}

/* The child in the only lane of a mask. */
static inline uint bvh8_only_child(global const uint* children, uint lanes)
{
    for (uint lane = 0; lane < BVH8_WIDTH - 1u; ++lane)
        if (lanes & (1u << lane))
            return children[lane];
    return children[BVH8_WIDTH - 1u];
}

/* The lowest lane at or after `lane` of a mask that has one there, found by branches too. */
static inline uint bvh8_next_lane(uint lanes, uint lane)
{
    while (!(lanes >> lane & 1u))
        ++lane;
    return lane;
}

static inline int bvh8_push(const Scene* scene, uint child, real t, uint* stack, real* stack_t, int top)
{
    stack[top] = child;
    stack_t[top] = t;
    bvh8_prefetch(scene, child);
    return top + 1;
}

/* Pushes the entered children so that the nearest is on top; gives the new stack size. */
static inline int bvh8_push_sorted(const Scene* scene, global const uint* children, uint lanes,
                                   const real* entries, uint* stack, real* stack_t, int top)
{
    const int bottom = top;
    for (; lanes != 0u; lanes &= lanes - 1u) {
        const uint lane = CLRT_LOWEST_BIT(lanes);
        const real t = entries[lane];
        int slot = top++;
        for (; slot > bottom && stack_t[slot - 1] < t; --slot) {
            stack[slot] = stack[slot - 1];
            stack_t[slot] = stack_t[slot - 1];
        }
        stack[slot] = children[lane];
        stack_t[slot] = t;
        bvh8_prefetch(scene, children[lane]);
    }
    return top;
}

/* Where a traversal is: in the scene's tree, instance 0, or in an instance's. */
typedef struct {
    BoxRay box;
    uint8 planes;
    uint instance;
    int floor; /* of the stack: what waits below it is of the scene's tree */
} Bvh8Tree;

static inline Bvh8Tree bvh8_scene_tree(const RenderParams* params, const Ray* ray)
{
    Bvh8Tree tree;
    tree.box = box_ray_make(ray, params->scene_extent);
    tree.planes = bvh8_planes(tree.box.reciprocal);
    tree.instance = 0u;
    tree.floor = 0;
    return tree;
}

/* Goes into the tree of an instance, which begins with node *child. */
static inline Bvh8Tree bvh8_instance_tree(const Scene* scene, const Ray* ray, uint instance, int top,
                                          uint* child)
{
    global const Instance* placed = scene->instances + instance;
    Bvh8Tree tree;
    tree.box = instance_box_ray(placed, ray);
    tree.planes = bvh8_planes(tree.box.reciprocal);
    tree.instance = instance;
    tree.floor = top;
    *child = scene->bvh_roots[placed->prototype];
    return tree;
}

/* Finds the first hit after `after` and not beyond hit->t; leaves hit unchanged where there is none. */
static CLRT_NOINLINE void bvh8_closest_hit(const Scene* scene, const RenderParams* params, const Ray* ray,
                                           const Hit* after, Hit* hit)
{
    const Bvh8Tree scene_tree = bvh8_scene_tree(params, ray);
    const RayShear shear = ray_shear_make(ray);
    Bvh8Tree tree = scene_tree;
    uint stack[BVH8_STACK_SIZE];
    real stack_t[BVH8_STACK_SIZE];
    real entries[BVH8_WIDTH];
    real limit = hit->t * BOX_EXIT_FACTOR;
    int top = 0;
    uint child = 0;
    for (;;) {
        /* Go down to a leaf, leaving the farther children on the stack. */
        while (!(child & BVH_LEAF_BIT)) {
            global const uint* node = bvh8_node(scene, child);
            SCENE_COUNT_NODE(scene);
            global const uint* children = node + BVH8_CHILD_WORD;
            real8 entry;
            const uint lanes = bvh8_enter(node, &tree.box, tree.planes, limit, &entry);
            if (lanes == 0u)
                break;
            /* One or two children are the usual case, and need no sorting. */
            const uint rest = lanes & (lanes - 1u);
            if (rest == 0u) {
                child = bvh8_only_child(children, lanes);
                continue;
            }
            vstore8(entry, 0, entries);
            if ((rest & (rest - 1u)) == 0u) {
                const uint first = bvh8_next_lane(lanes, 0u);
                const uint second = bvh8_next_lane(lanes, first + 1u);
                if (entries[second] < entries[first]) {
                    top = bvh8_push(scene, children[first], entries[first], stack, stack_t, top);
                    child = children[second];
                } else {
                    top = bvh8_push(scene, children[second], entries[second], stack, stack_t, top);
                    child = children[first];
                }
                continue;
            }
            top = bvh8_push_sorted(scene, children, lanes, entries, stack, stack_t, top) - 1;
            child = stack[top];
        }
        if (bvh8_instance(child) != 0u) {
            tree = bvh8_instance_tree(scene, ray, bvh8_instance(child), top, &child);
            continue;
        }
        if (child & BVH_LEAF_BIT) {
            global const uint* block = bvh8_leaf(scene, child);
            SCENE_COUNT_LEAF(scene, bvh8_block_size(block));
            bvh8_block_closest(scene, block, tree.instance, &shear, ray_time(ray), after, hit);
            limit = hit->t * BOX_EXIT_FACTOR;
        }
        /* Take the nearest child that can still hold a nearer hit. */
        do {
            if (HAS(EFFECT_INSTANCES) && top == tree.floor && tree.instance != 0u)
                tree = scene_tree;
            if (top == 0)
                return;
            child = stack[--top];
        } while (stack_t[top] > limit);
    }
}

/* True if anything is hit before t_max. Children are visited by ascending lane, the order that the builder
   chose for this question. */
static CLRT_NOINLINE bool bvh8_any_hit(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    const Bvh8Tree scene_tree = bvh8_scene_tree(params, ray);
    const RayShear shear = ray_shear_make(ray);
    Bvh8Tree tree = scene_tree;
    const real limit = ray->t_max * BOX_EXIT_FACTOR;
    uint stack[BVH8_STACK_SIZE];
    int top = 0;
    uint child = 0;
    for (;;) {
        while (!(child & BVH_LEAF_BIT)) {
            global const uint* node = bvh8_node(scene, child);
            SCENE_COUNT_NODE(scene);
            real8 entry;
            global const uint* children = node + BVH8_CHILD_WORD;
            const uint lanes = bvh8_enter(node, &tree.box, tree.planes, limit, &entry);
            if (lanes == 0u)
                break;
            /* One child is the usual case, and need not go through the stack. */
            if ((lanes & (lanes - 1u)) == 0u) {
                child = bvh8_only_child(children, lanes);
                continue;
            }
#pragma unroll
            for (int lane = BVH8_WIDTH - 1; lane >= 0; --lane)
                if (lanes & (1u << lane))
                    stack[top++] = children[lane];
            child = stack[--top];
        }
        if (bvh8_instance(child) != 0u) {
            tree = bvh8_instance_tree(scene, ray, bvh8_instance(child), top, &child);
            continue;
        }
        if (child & BVH_LEAF_BIT) {
            global const uint* block = bvh8_leaf(scene, child);
            SCENE_COUNT_LEAF(scene, bvh8_block_size(block));
            if (bvh8_block(scene, block, tree.instance, &shear, ray_time(ray), ray->t_max).lanes != 0u)
                return true;
        }
        if (HAS(EFFECT_INSTANCES) && top == tree.floor && tree.instance != 0u)
            tree = scene_tree;
        if (top == 0)
            return false;
        child = stack[--top];
    }
}

#endif
