// SPDX-License-Identifier: Apache-2.0
// Rays against the scene, whatever the layout of the tree.
#ifndef CLRT_GEOMETRY_TRAVERSE_H
#define CLRT_GEOMETRY_TRAVERSE_H

#include "box.h"
#include "leaf_triangle.h"
#include "scene.h"
#include "triangle.h"

/* A file's text stands where it is included first, so what both layouts include comes before the choice. */
#if BVH_LAYOUT == BVH_LAYOUT_BVH8
#include "traverse_bvh8.h"
#else
#include "traverse_bvh2.h"
#endif

/* The first hit after `after` (hit_none(0) for all) within the ray; triangle NO_INDEX where there is none. At
   equal distance the lowest triangle index comes first. Rays that are not finite or have no direction miss. */
static inline Hit scene_closest_hit(const Scene* scene, const RenderParams* params, const Ray* ray, const Hit* after)
{
    Hit hit = hit_none(ray->t_max);
    if (!ray_is_valid(ray))
        return hit;
#if BVH_LAYOUT == BVH_LAYOUT_BVH8
    bvh8_closest_hit(scene, params, ray, after, &hit);
#else
    bvh2_closest_hit(scene, params, ray, after, &hit);
#endif
    return hit;
}

/* True if any triangle is hit within the ray, cut-outs taken as solid. */
static inline bool scene_any_hit(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    if (!ray_is_valid(ray))
        return false;
#if BVH_LAYOUT == BVH_LAYOUT_BVH8
    return bvh8_any_hit(scene, params, ray);
#else
    return bvh2_any_hit(scene, params, ray);
#endif
}

#endif
