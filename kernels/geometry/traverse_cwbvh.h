// SPDX-License-Identifier: Apache-2.0
// Traversal of the compressed eight-wide tree (Ylitie, Karras and Laine 2017, "Efficient incoherent ray
// traversal on GPUs through compressed wide BVHs"): 80 bytes a node, for GPUs, right on every device.
//
// Children are visited by octant: slots hold them so that ascending slot XOR octant is roughly front to back,
// and the met ones are bits of a word, the nearest uppermost. Such a word with the index of the first child
// is a group; one node leaves at most one group behind, so the stack holds a group a level and no distances.
// A tree has at most CWBVH_MAX_LEVELS levels of nodes, and the deepest has no children left to put off: 20
// entries of eight bytes. An instance's tree stands on the scene's.
//
// Boxes are safe in three steps: the lattice's box encloses the child's exactly (layout_cwbvh.cpp); step
// times reciprocal is exact, since steps are powers of two and too large to underflow; and the pad below
// covers the one more rounding that a distance takes here.
#ifndef CLRT_GEOMETRY_TRAVERSE_CWBVH_H
#define CLRT_GEOMETRY_TRAVERSE_CWBVH_H

#include "box.h"
#include "instance.h"
#include "leaf_triangle.h"
#include "scene.h"

#define CWBVH_STACK_SIZE (HAS(EFFECT_INSTANCES) ? 2 * CWBVH_MAX_LEVELS : CWBVH_MAX_LEVELS - 1)

/* A plane at origin + q step is met at fma(q, step r, fma(origin, r, entry_offset)), where box.h has
   fma(plane, r, entry_offset). The inner fma rounds a sum of at most 2 reach |r| and a pad: 2 units and a
   little more, with the exit factor as without. */
#define CWBVH_PAD_ROUNDINGS (BOX_PAD_ROUNDINGS + REAL(3.0))

/* Bits of a group that stand for children; those of inner nodes lie above those of leaf triangles. */
#define CWBVH_INNER_BITS 0xff000000u
#define CWBVH_FIRST_INNER_BIT 24u

/* What a ray meets in a node. x: index of the first child or leaf triangle. y: bits of those that are met;
   for nodes, with the mask of inner slots in the lowest byte. */
typedef struct {
    uint2 nodes;
    uint2 triangles;
} CwbvhGroups;

/* One byte a slot. */
static inline real8 cwbvh_planes(uint2 bytes) { return convert_real8(as_uchar8(bytes)); }

/* The bits that each slot's child has in a group: one or, for a leaf, up to three. `flip` is the complement
   of the ray's octant. */
static inline uint8 cwbvh_child_bits(uint2 meta, uint flip)
{
    /* All eight bytes at a time; only the place of an inner node, 24 + slot, has both upper bits of five. */
    const uint2 inner = meta & (meta << 1) & 0x10101010u;
    const uint2 place = (meta ^ ((inner >> 4) * flip)) & 0x1f1f1f1fu;
    const uint2 unary = (meta >> CWBVH_COUNT_SHIFT) & 0x07070707u;
    return convert_uint8(as_uchar8(unary)) << convert_uint8(as_uchar8(place));
}

/* Tests the node's eight boxes against (0, t_max]. */
static inline CwbvhGroups cwbvh_enter(global const uint4* node, const BoxRay* box, uint flip, real t_max)
{
    const uint4 head = node[0], links = node[1], lower_xy = node[2], lower_z_upper_x = node[3],
                upper_yz = node[4];
    const uint4 exponents = convert_uint4(as_uchar4(head.w));
    const real3 r = box->reciprocal;
    const real3 origin = convert_real3(as_float3(head.xyz));
    const real3 size = convert_real3(as_float3(exponents.xyz << 23));
    const real3 step = size * r;
    const real3 exit_step = size * box->exit_reciprocal;
    const real3 entry = fma(origin, r, box->entry_offset);
    const real3 exit = fma(origin, box->exit_reciprocal, box->exit_offset);
    const bool left = (flip & 1u) == 0u, down = (flip & 2u) == 0u, back = (flip & 4u) == 0u;
    const uint2 near_x = left ? lower_z_upper_x.zw : lower_xy.xy,
                far_x = left ? lower_xy.xy : lower_z_upper_x.zw;
    const uint2 near_y = down ? upper_yz.xy : lower_xy.zw, far_y = down ? lower_xy.zw : upper_yz.xy;
    const uint2 near_z = back ? upper_yz.zw : lower_z_upper_x.xy,
                far_z = back ? lower_z_upper_x.xy : upper_yz.zw;
    const real8 enter_x = fma(cwbvh_planes(near_x), (real8)(step.x), (real8)(entry.x));
    const real8 enter_y = fma(cwbvh_planes(near_y), (real8)(step.y), (real8)(entry.y));
    const real8 enter_z = fma(cwbvh_planes(near_z), (real8)(step.z), (real8)(entry.z));
    const real8 leave_x = fma(cwbvh_planes(far_x), (real8)(exit_step.x), (real8)(exit.x));
    const real8 leave_y = fma(cwbvh_planes(far_y), (real8)(exit_step.y), (real8)(exit.y));
    const real8 leave_z = fma(cwbvh_planes(far_z), (real8)(exit_step.z), (real8)(exit.z));
    /* All operands are finite, so min and max are defined. */
    const real8 enter = max(max(enter_x, enter_y), max(enter_z, (real8)(REAL(0.0))));
    const real8 leave = min(min(leave_x, leave_y), min(leave_z, (real8)(t_max * BOX_EXIT_FACTOR)));
    const int8 met = convert_int8(enter <= leave);
    const uint8 slots = cwbvh_child_bits(links.zw, flip) & as_uint8(met);
    const uint4 halves = slots.lo | slots.hi;
    const uint2 quarters = halves.lo | halves.hi;
    const uint bits = quarters.x | quarters.y;
    CwbvhGroups groups;
    groups.nodes = (uint2)(links.x, (bits & CWBVH_INNER_BITS) | exponents.w);
    groups.triangles = (uint2)(links.y, bits & ~CWBVH_INNER_BITS);
    return groups;
}

/* Takes the nearest child out of a group and gives its index. */
static inline uint cwbvh_take_nearest(uint2* group, uint flip)
{
    const uint bit = 31u - clz(group->y);
    const uint slot = (bit - CWBVH_FIRST_INNER_BIT) ^ flip;
    group->y &= ~(1u << bit);
    /* Inner nodes are stored by slot. */
    return group->x + popcount(group->y & ((1u << slot) - 1u));
}

/* The complement of a ray's octant. */
static inline uint cwbvh_flip(const BoxRay* box)
{
    return (box->reciprocal.x < REAL(0.0) ? 0u : 1u) | (box->reciprocal.y < REAL(0.0) ? 0u : 2u) |
           (box->reciprocal.z < REAL(0.0) ? 0u : 4u);
}

/* Finds the first hit after `after` and not beyond hit->t, or leaves hit unchanged; with `any`, true at the
   first triangle that is met, whichever it is. `any` is a constant. */
CLRT_INLINE bool cwbvh_traverse(const Scene* scene, const RenderParams* params, const Ray* ray,
                                const Hit* after, Hit* hit, bool any)
{
    const BoxRay scene_box = box_ray_make_padded(ray, params->scene_extent, CWBVH_PAD_ROUNDINGS);
    const RayShear shear = ray_shear_make(ray);
    BoxRay box = scene_box;
    uint flip = cwbvh_flip(&box);
    uint2 stack[CWBVH_STACK_SIZE];
    uint top = 0u, floor = 0u, instance = 0u;
    uint2 scene_rest = (uint2)(0u); /* while the traversal is in an instance */
    /* The root is the only child of a group without a mask. */
    uint2 group = (uint2)(0u, 0x80000000u);
    for (;;) {
        const uint index = cwbvh_take_nearest(&group, flip);
        if (group.y & CWBVH_INNER_BITS)
            stack[top++] = group;
        global const uint4* node = (global const uint4*)(scene->bvh_nodes + (size_t)CWBVH_NODE_WORDS * index);
        SCENE_COUNT_NODE(scene);
        const CwbvhGroups groups = cwbvh_enter(node, &box, flip, hit->t);
        group = groups.nodes;
        for (uint2 rest = groups.triangles;;) {
            for (; rest.y != 0u; rest.y &= rest.y - 1u) {
                const uint place = 31u - clz(rest.y & -rest.y);
                global const uint* leaf = scene->bvh_leaves + (size_t)LEAF_TRIANGLE_WORDS * (rest.x + place);
                if (HAS(EFFECT_INSTANCES) && leaf[BVH_INSTANCE_WORD] != 0u) {
                    instance = leaf[BVH_INSTANCE_WORD];
                    break;
                }
                SCENE_COUNT_LEAF(scene, 1u);
                Hit found;
                if (!any)
                    leaf_triangle_closest(scene, leaf, instance, ray, &shear, after, hit);
                else if (leaf_triangle_hit(scene, leaf, instance, ray, &shear, hit->t, &found))
                    return true;
            }
            if (HAS(EFFECT_INSTANCES) && rest.y != 0u) {
                /* Go into the instance's tree; what is left of the node waits. */
                global const Instance* placed = scene->instances + instance;
                box = instance_box_ray(placed, ray);
                flip = cwbvh_flip(&box);
                if (group.y & CWBVH_INNER_BITS)
                    stack[top++] = group;
                floor = top;
                scene_rest = (uint2)(rest.x, rest.y & (rest.y - 1u));
                group = (uint2)(scene->bvh_roots[placed->prototype], 0x80000000u);
                break;
            }
            if (group.y & CWBVH_INNER_BITS)
                break;
            if (top > floor) {
                group = stack[--top];
                break;
            }
            if (!HAS(EFFECT_INSTANCES) || instance == 0u)
                return false;
            /* Go on in the scene's tree. */
            box = scene_box;
            flip = cwbvh_flip(&box);
            instance = floor = 0u;
            rest = scene_rest;
        }
    }
}

/* Finds the first hit after `after` and not beyond hit->t; leaves hit unchanged where there is none. */
static CLRT_NOINLINE void cwbvh_closest_hit(const Scene* scene, const RenderParams* params, const Ray* ray,
                                            const Hit* after, Hit* hit)
{
    cwbvh_traverse(scene, params, ray, after, hit, false);
}

/* True if anything is hit before t_max. */
static CLRT_NOINLINE bool cwbvh_any_hit(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    const Hit after = hit_none(REAL(0.0));
    Hit hit = hit_none(ray->t_max);
    return cwbvh_traverse(scene, params, ray, &after, &hit, true);
}

#endif
