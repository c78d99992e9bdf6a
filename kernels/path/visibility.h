// SPDX-License-Identifier: Apache-2.0
// Hits and shadow rays that see through cut-outs and smooth panes. Light that crosses a pane goes straight
// on, so a crossing is no event: it ends no segment, has no letter in the path notation and does not count
// towards max_depth; shadow rays cross, too, and densities know nothing of it. Paths cross with a
// probability, shadow rays by the share that passes; trees of rays split there (integrators/tree.h).
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
    return material_coverage(scene, material, uv_at(scene, triangle, hit->b1, hit->b2));
}

/* True if light crosses the surface at a hit straight on, beside what its lobes scatter. */
static inline bool visibility_is_pane(const Scene* scene, const Hit* hit)
{
    global const Material* material = scene->materials + scene->triangles[hit->triangle].material;
    return HAS(EFFECT_THIN_WALL) && (material->lobes & LOBE_PANE) && material->alpha_x == 0.0f;
}

/* True if a hit is on no surface, because the same solid is there on both sides. */
static CLRT_NOINLINE bool visibility_is_within(const Scene* scene, const Hit* hit, const Ray* ray, Nest* nest)
{
#if CLRT_EFFECTS & EFFECT_NESTED
    const uint material = scene->triangles[hit->triangle].material;
    if (!nest_takes(scene, material))
        return false;
    const Surface surface = surface_at(scene, hit, ray);
    *nest = surface.beyond;
    return nest_is_alike(scene, surface.inside, material, surface.front);
#else
    return false;
#endif
}

/* Lets a ray pass a hit that is on no surface; false where it is on one. */
static inline bool visibility_goes_on(const Scene* scene, const Hit* hit, Ray* ray)
{
    Nest nest;
    if (!HAS(EFFECT_NESTED) || !visibility_is_within(scene, hit, ray, &nest))
        return false;
#if CLRT_EFFECTS & EFFECT_NESTED
    ray->nest = nest;
#endif
    return true;
}

/* How a ray goes on at a hit. */
typedef struct {
    real3 share;   /* of the light along it that passes */
    real coverage; /* of the surface, which the rest meets */
    real stop;     /* probability that a path stops: coverage but for panes */
    bool is_pane;
} Crossing;

/* A pane that shines is seen by the paths that stop there: at least by half of them. */
#define VISIBILITY_SHINING_STOP REAL(0.5)

/* What a pane lets pass, and with which probability paths do. */
static CLRT_NOINLINE void visibility_cross_pane(const Scene* scene, const Hit* hit, const Ray* ray,
                                                Crossing* crossing)
{
    const Ray unit = ray_make(ray->origin, vector_normalize(ray->direction), ray_time(ray));
    const Surface surface = surface_at(scene, hit, &unit);
    Bsdf bsdf;
    material_set_bsdf_apart(scene, &surface, -unit.direction, TRANSPORT_RADIANCE, &bsdf);
    const real coverage = crossing->coverage;
    const real3 passes = bsdf_pane_passes(&bsdf);
    real stop = REAL(1.0) - bsdf_pane_passing(&bsdf);
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX)
        stop = fmax(stop, VISIBILITY_SHINING_STOP);
    crossing->share += coverage * passes;
    if (!vector_is_black(passes))
        crossing->stop = coverage * stop;
    if (real_is_nan(passes.x + passes.y + passes.z))
        crossing->stop = REAL_NAN;
}

static inline Crossing visibility_crossing(const Scene* scene, const Hit* hit, const Ray* ray, bool by_panes)
{
    Crossing crossing;
    crossing.coverage = HAS(EFFECT_CUT_OUT) ? visibility_coverage(scene, hit) : REAL(1.0);
    crossing.share = (real3)(REAL(1.0) - crossing.coverage);
    crossing.stop = crossing.coverage;
    crossing.is_pane = by_panes && visibility_is_pane(scene, hit);
    if (crossing.is_pane)
        visibility_cross_pane(scene, hit, ray, &crossing);
    return crossing;
}

/* The first hit that is not passed: a surface of coverage c is passed with probability 1 - c, a pane with
   that of its glass (bsdf_pane_passing), and `carried` weighs that; 0: panes stop the ray. The search goes on
   behind the passed hit in the order of hits, so no layer is missed or met twice. Where a coverage is a NaN,
   so is the distance of the miss that it gives. Surfaces within a solid are passed by all, and the ray knows
   of them (Ray.nest). */
static inline Hit visible_hit(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                              uint bounce, Ray* ray, real3* carried)
{
    Hit after = hit_none(REAL(0.0));
    Hit hit = scene_closest_hit(scene, params, ray, &after);
    if (!HAS(EFFECTS_PASSED))
        return hit;
    for (uint layer = 0; hit.triangle != NO_INDEX; ++layer) {
        if (visibility_goes_on(scene, &hit, ray)) {
            after = hit;
            hit = scene_closest_hit(scene, params, ray, &after);
            continue;
        }
        const Crossing crossing = visibility_crossing(scene, &hit, ray, carried != 0);
        if (crossing.stop >= REAL(1.0))
            break;
        if (real_is_nan(crossing.stop))
            return hit_none(REAL_NAN);
        const uint word = sampler_word(sampler, bounce, SAMPLE_COVERAGE);
        const bool stops = sampler_unit(sampler_hash(word + layer)) < crossing.stop;
        if (crossing.is_pane)
            *carried *= stops ? (real3)(crossing.coverage / crossing.stop)
                              : crossing.share / (REAL(1.0) - crossing.stop);
        if (stops)
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
    Nest unused;
    if (HAS(EFFECT_NESTED) && visibility_is_within(scene, &nearer, ray, &unused))
        return false;
    if (visibility_is_pane(scene, &nearer))
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
    Surface surface;
    for (int wall = 1;; ++wall) {
        surface = surface_at(scene, hit, ray);
        if (wall == VISIBLE_CORNER_WALLS || !surface.is_near_edge ||
            !visible_is_hidden(scene, params, surface.position + surface.normal_g * surface.offset, ray, hit))
            break;
    }
    TRACE_CHOICE(scene, TRACE_FRONT, surface.front ? 1u : 0u);
    TRACE_VECTOR(scene, TRACE_POSITION, surface.position);
    TRACE_VECTOR(scene, TRACE_NORMAL_G, surface.normal_g);
    TRACE_NUMBER(scene, TRACE_OFFSET, surface.offset);
    return surface;
}

/* How a ray gets from its origin to its end. */
typedef struct {
    real3 share;  /* of light that does */
    real passing; /* probability that a path does (visible_hit) */
} Passage;

/* What cut-outs and panes let pass. */
static inline Passage visible_passage_of_layers(const Scene* scene, const RenderParams* params,
                                                const Ray* ray)
{
    Passage passage = {(real3)(REAL(1.0)), REAL(1.0)};
    Hit after = hit_none(REAL(0.0));
    Ray going = *ray;
    while (vector_max_component(passage.share) > REAL(0.0)) {
        const Hit hit = scene_closest_hit(scene, params, ray, &after);
        if (hit.triangle == NO_INDEX)
            break;
        if (!visibility_goes_on(scene, &hit, &going)) {
            const Crossing crossing = visibility_crossing(scene, &hit, ray, true);
            passage.share *= crossing.share;
            passage.passing *= REAL(1.0) - crossing.stop;
        }
        after = hit;
    }
    return passage;
}

/* A direction along no axis and no diagonal, of unit length. */
#define VISIBLE_ASKEW vector_make(REAL(0.36), REAL(0.80), REAL(0.48))

/* Finds the solids that a ray begins in: those whose surfaces are left on the way out, by any way, without
   having been entered on it. */
static CLRT_NOINLINE void visible_find_nest(const Scene* scene, const RenderParams* params, Ray* ray)
{
#if CLRT_EFFECTS & EFFECT_NESTED
    const Ray probe = ray_make(ray->origin, VISIBLE_ASKEW, ray_time(ray));
    Nest ahead = nest_empty();
    Hit hit = hit_none(REAL(0.0));
    for (;;) {
        const Hit after = hit;
        hit = scene_closest_hit(scene, params, &probe, &after);
        if (hit.triangle == NO_INDEX)
            return;
        const Surface surface = surface_at(scene, &hit, &probe);
        if (!nest_takes(scene, surface.material))
            continue;
        if (surface.front)
            ahead = nest_entered(ahead, surface.material);
        else if (nest_has(ahead, surface.material))
            ahead = nest_left(ahead, surface.material);
        else
            ray->nest = nest_entered(ray->nest, surface.material);
    }
#endif
}

/* Whether a ray reaches its end: 0 or 1, or what cut-outs and panes let pass; NaNs for a ray that is not
   finite. */
static inline Passage visible_passage(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    Passage passage = {(real3)(REAL_NAN), REAL_NAN};
    if (vector_is_finite(ray->origin) && vector_is_finite(ray->direction)) {
        if (HAS(EFFECTS_PASSED))
            passage = visible_passage_of_layers(scene, params, ray);
        else {
            passage.passing = scene_any_hit(scene, params, ray) ? REAL(0.0) : REAL(1.0);
            passage.share = (real3)(passage.passing);
        }
    }
    TRACE_CHOICE(scene, TRACE_VISIBLE, vector_max_component(passage.share) > REAL(0.0) ? 1u : 0u);
    TRACE_NUMBER(scene, TRACE_SHARE, vector_max_component(passage.share));
    return passage;
}

/* The share of light that reaches the ray's end. */
static CLRT_NOINLINE real3 visible_share(const Scene* scene, const RenderParams* params, const Ray* ray)
{
    return visible_passage(scene, params, ray).share;
}

#endif
