// SPDX-License-Identifier: Apache-2.0
// Hits and shadow rays that see through cut-outs.
#ifndef CLRT_PATH_VISIBILITY_H
#define CLRT_PATH_VISIBILITY_H

#include "geometry/traverse.h"
#include "numerics/sampler.h"
#include "scattering/material.h"

/* Coverage of the surface at a hit. */
static inline real visibility_coverage(const Scene* scene, const Hit* hit)
{
    global const Triangle* triangle = scene->triangles + hit->triangle;
    global const Material* material = scene->materials + triangle->material;
    if (!(material->flags & MATERIAL_CUT_OUT))
        return REAL(1.0);
    float2 uv = (float2)(0.0f);
    if (triangle->t0 != NO_INDEX) {
        const float2 t0 = scene->uvs[triangle->t0];
        uv = t0 + (float)hit->b1 * (scene->uvs[triangle->t1] - t0) +
             (float)hit->b2 * (scene->uvs[triangle->t2] - t0);
    }
    return material_coverage(scene, material, uv);
}

/* The first hit that is not passed: a surface of coverage c is passed with probability 1 - c. The search goes
   on behind the passed hit in the order of hits, so no layer is missed or met twice. Where a coverage is a
   NaN, so is the distance of the miss that it gives. */
static inline Hit visible_hit(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                              uint bounce, const Ray* ray)
{
    Hit after = hit_none(REAL(0.0));
    Hit hit = scene_closest_hit(scene, params, ray, &after);
    if (!HAS(EFFECT_CUT_OUT))
        return hit;
    for (uint layer = 0; hit.triangle != NO_INDEX; ++layer) {
        const real coverage = visibility_coverage(scene, &hit);
        if (coverage >= REAL(1.0))
            break;
        if (real_is_nan(coverage))
            return hit_none(REAL_NAN);
        const uint word = sampler_word(sampler, bounce, SAMPLE_COVERAGE);
        if (sampler_unit(sampler_hash(word + layer)) < coverage)
            break;
        after = hit;
        hit = scene_closest_hit(scene, params, ray, &after);
    }
    return hit;
}

/* Looks again at a hit near an edge, whose point, off its wall by the error bound, is `point`. There the ray
   meets two walls at one distance but for roundings, which may call the far one first: the one that is seen
   from behind, at the outline of a solid. Its point, drawn in from the edge, lies behind the near wall, so
   the same ray shifted to that point meets the near wall before it. True if so; `hit` is then there. */
static CLRT_NOINLINE bool visible_is_hidden(const Scene* scene, const RenderParams* params, real3 point,
                                            const Ray* ray, Hit* hit)
{
    /* Half of the ray: a wall that it grazes is far before the point, and it may start on a wall, too. */
    const real reach = REAL(0.5) * hit->t;
    Ray shifted = ray_make(point - ray->direction * reach, ray->direction, ray_time(ray));
    shifted.t_max = reach;
    const Hit after = hit_none(REAL(0.0));
    const Hit nearer = scene_closest_hit(scene, params, &shifted, &after);
    if (nearer.triangle == NO_INDEX || hit_is_same_triangle(&nearer, hit))
        return false;
    if (HAS(EFFECT_CUT_OUT) && visibility_coverage(scene, &nearer) < REAL(1.0))
        return false;
    hit_set_triangle(hit_instance(&nearer), nearer.triangle, hit);
    hit->b1 = nearer.b1;
    hit->b2 = nearer.b2;
    return true;
}

/* Walls that may meet in one corner, one behind the other. */
#define VISIBLE_CORNER_WALLS 4

/* The surface at a hit of a ray. */
static inline Surface visible_surface(const Scene* scene, const RenderParams* params, const Ray* ray,
                                      Hit* hit)
{
    Surface surface = surface_at(scene, hit, ray);
    for (int i = 1; i < VISIBLE_CORNER_WALLS && surface.is_near_edge; ++i) {
        if (!visible_is_hidden(scene, params, surface.position + surface.normal_g * surface.offset, ray, hit))
            break;
        surface = surface_at(scene, hit, ray);
    }
    TRACE_CHOICE(scene, TRACE_FRONT, surface.front ? 1u : 0u);
    TRACE_VECTOR(scene, TRACE_POSITION, surface.position);
    TRACE_VECTOR(scene, TRACE_NORMAL_G, surface.normal_g);
    TRACE_NUMBER(scene, TRACE_OFFSET, surface.offset);
    return surface;
}

/* What cut-outs let pass of the light to the ray's end. */
static inline real visible_share_of_cut_outs(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    real share = REAL(1.0);
    Hit after = hit_none(REAL(0.0));
    while (share > REAL(0.0)) {
        const Hit hit = scene_closest_hit(scene, params, ray, &after);
        if (hit.triangle == NO_INDEX)
            break;
        share *= REAL(1.0) - visibility_coverage(scene, &hit);
        after = hit;
    }
    return share;
}

/* The share of light that reaches the ray's end: 0 or 1, or the product of what cut-outs let pass; a NaN for
   a ray that is not finite. */
static CLRT_NOINLINE real visible_share(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    real share = REAL_NAN;
    if (vector_is_finite(ray->origin) && vector_is_finite(ray->direction)) {
        if (HAS(EFFECT_CUT_OUT))
            share = visible_share_of_cut_outs(scene, params, ray);
        else
            share = scene_any_hit(scene, params, ray) ? REAL(0.0) : REAL(1.0);
    }
    TRACE_CHOICE(scene, TRACE_VISIBLE, share > REAL(0.0) ? 1u : 0u);
    TRACE_NUMBER(scene, TRACE_SHARE, share);
    return share;
}

#endif
