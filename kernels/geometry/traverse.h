// SPDX-License-Identifier: Apache-2.0
// Rays against the scene, whatever the layout of the tree.
#ifndef CLRT_GEOMETRY_TRAVERSE_H
#define CLRT_GEOMETRY_TRAVERSE_H

#include "box.h"
#include "leaf_triangle.h"
#include "scene.h"
#include "triangle.h"

/* A file's text stands where it is included first, so what layouts share comes before the choice. */
#if BVH_LAYOUT == BVH_LAYOUT_BVH8
#include "traverse_bvh8.h"
#define TRAVERSE_CLOSEST_HIT bvh8_closest_hit
#define TRAVERSE_ANY_HIT bvh8_any_hit
#elif BVH_LAYOUT == BVH_LAYOUT_CWBVH
#include "traverse_cwbvh.h"
#define TRAVERSE_CLOSEST_HIT cwbvh_closest_hit
#define TRAVERSE_ANY_HIT cwbvh_any_hit
#else
#include "traverse_bvh2.h"
#define TRAVERSE_CLOSEST_HIT bvh2_closest_hit
#define TRAVERSE_ANY_HIT bvh2_any_hit
#endif

/* The first hit after `after` (hit_none(0) for all) within the ray; triangle NO_INDEX where there is none. At
   equal distance the lowest instance and triangle index comes first. Rays that are not finite or have no
   direction miss, at a distance that is a NaN. */
static inline Hit scene_closest_hit(const Scene* scene, const RenderParams* params, const Ray* ray,
                                    const Hit* after)
{
    if (!ray_is_valid(ray))
        return hit_none(REAL_NAN);
    Hit hit = hit_none(ray->t_max);
    TRAVERSE_CLOSEST_HIT(scene, params, ray, after, &hit);
    return hit;
}

/* True if any triangle is hit within the ray, cut-outs taken as solid. */
static inline bool scene_any_hit(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    if (!ray_is_valid(ray))
        return false;
    return TRAVERSE_ANY_HIT(scene, params, ray);
}

#endif
