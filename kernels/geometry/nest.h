// SPDX-License-Identifier: Apache-2.0
// Solids within each other (Schmidt and Budge 2002, "Simple nested dielectrics in ray traced images"): where
// several overlap, as a liquid and its glass do so that no gap is left, the one of the greatest priority is
// there; of equals, that which the ray has entered last. A ray carries the solids that it is in. A surface
// between two places where the same solid is there is no surface: the ray goes on behind it
// (path/visibility.h). At all others light is bent by the indices of what is there on both sides.
#ifndef CLRT_GEOMETRY_NEST_H
#define CLRT_GEOMETRY_NEST_H

#include "ray.h"
#include "scene.h"

/* Materials of solids, those that were entered first to begin with; behind the last, NO_INDEX. At most four:
   one that is entered while there are as many is not noticed. */
typedef uint4 Nest;

static inline Nest nest_empty(void) { return (uint4)(NO_INDEX); }

/* Behind the surface of a solid that has been entered, */
static inline Nest nest_entered(Nest nest, uint material)
{
    if (nest.x == NO_INDEX)
        nest.x = material;
    else if (nest.y == NO_INDEX)
        nest.y = material;
    else if (nest.z == NO_INDEX)
        nest.z = material;
    else if (nest.w == NO_INDEX)
        nest.w = material;
    return nest;
}

/* or left: it is taken out where it was put in last. Nothing happens where it is not there. */
static inline Nest nest_left(Nest nest, uint material)
{
    if (nest.w == material)
        nest.w = NO_INDEX;
    else if (nest.z == material)
        nest.zw = (uint2)(nest.w, NO_INDEX);
    else if (nest.y == material)
        nest.yzw = (uint3)(nest.zw, NO_INDEX);
    else if (nest.x == material)
        nest = (uint4)(nest.yzw, NO_INDEX);
    return nest;
}

static inline bool nest_has(Nest nest, uint material)
{
    return nest.x == material || nest.y == material || nest.z == material || nest.w == material;
}

/* Of two solids, the first entered before, the one that is there. */
static inline uint nest_stronger(const Scene* scene, uint first, uint second)
{
    if (second == NO_INDEX)
        return first;
    return scene->extensions[second].priority >= scene->extensions[first].priority ? second : first;
}

/* The solid that is there; NO_INDEX: air. */
static CLRT_NOINLINE uint nest_top(const Scene* scene, Nest nest)
{
    if (nest.y == NO_INDEX)
        return nest.x;
    const uint top = nest_stronger(scene, nest_stronger(scene, nest.x, nest.y), nest.z);
    return nest_stronger(scene, top, nest.w);
}

/* True if a material's surface is that of a solid that may lie in others. */
static inline bool nest_takes(const Scene* scene, uint material)
{
    return HAS(EFFECT_NESTED) && (scene->materials[material].flags & MATERIAL_NESTED);
}

/* Behind a surface of a material. */
static inline Nest nest_beyond(const Scene* scene, Nest nest, uint material, bool front)
{
    if (!nest_takes(scene, material))
        return nest;
    return front ? nest_entered(nest, material) : nest_left(nest, material);
}

/* What is there behind the surface of a solid that is left. */
static inline uint nest_behind_exit(const Scene* scene, Nest nest, uint material)
{
    return nest_top(scene, nest_left(nest, material));
}

/* True if the same solid is there on both sides of a surface. */
static CLRT_NOINLINE bool nest_is_alike(const Scene* scene, Nest nest, uint material, bool front)
{
    if (front) {
        const uint here = nest_top(scene, nest);
        return here == material || (here != NO_INDEX && nest_stronger(scene, here, material) == here);
    }
    const Nest full = nest_has(nest, material) ? nest : nest_entered(nest, material);
    return nest_top(scene, full) == nest_behind_exit(scene, full, material);
}

#endif
