// SPDX-License-Identifier: Apache-2.0
// Light sampling of the sky through windows, doors and skylights. From within a room hardly any direction to
// the sky is free; those that are lie in a few rectangles (src/scene/sky_portals.h finds them), of which one
// is chosen by what it may send to the vertex, and a point on it evenly. What arrives is the sky's light,
// weighted by the density of the mixture with the map's table, and shadow rays tell what is in between. So a
// rectangle where there is no window costs samples, never light, and a window without one is found by the
// table and by the BSDF.
#ifndef CLRT_LIGHTS_SKY_PORTAL_H
#define CLRT_LIGHTS_SKY_PORTAL_H

#include "environment_sample.h"
#include "light_tree.h"

/* A portal whose middle the surface sees below its horizon may yet reach above it. */
#define PORTAL_SMALLEST_COS REAL(0.1)

/* Of those that random numbers are: 1 - 2^-24. */
#define PORTAL_LARGEST_NUMBER REAL(0.999999940395355224609375)

/* What a portal may send to a vertex, more or less: its irradiance there by its middle, from near by that of
   its whole size. 0 behind it. */
static inline real portal_weight(global const SkyPortal* portal, const LightView* view)
{
    const real3 from_corner = view->position - vector_from(portal->corner);
    const real3 normal = vector_from(portal->normal);
    const real height = vector_dot(normal, from_corner);
    if (!(height > REAL(0.0)))
        return REAL(0.0);
    const real area = (real)portal->normal.w;
    const real3 way =
        (vector_from(portal->edge_u) + vector_from(portal->edge_v)) * REAL(0.5) - from_corner;
    const real square = vector_dot(way, way);
    const real near_square = fma(area, REAL(0.25), square);
    const bool has_horizon = !vector_is_black(fabs(view->normal));
    const real cosine =
        has_horizon ? fmax(vector_dot(view->normal, way) / real_sqrt(square), PORTAL_SMALLEST_COS)
                    : REAL(1.0);
    return (real)portal->corner.w * area * height * cosine / (near_square * real_sqrt(near_square));
}

/* Of all portals together. */
static inline real portals_weight(const Scene* scene, const RenderParams* params, const LightView* view)
{
    real sum = REAL(0.0);
    for (uint i = 0u; i < params->portal_count; ++i)
        sum += portal_weight(scene->sky_portals + i, view);
    return sum;
}

/* Distance to a portal along wi; 0 where wi misses it. */
static inline real portal_distance(global const SkyPortal* portal, real3 position, real3 wi)
{
    const real3 from_corner = position - vector_from(portal->corner);
    const real3 normal = vector_from(portal->normal);
    const real height = vector_dot(normal, from_corner), cosine = -vector_dot(normal, wi);
    if (!(height > REAL(0.0)) || !(cosine > REAL(0.0)))
        return REAL(0.0);
    const real t = height / cosine;
    const real3 at = fma((real3)(t), wi, from_corner);
    const real u = vector_dot(at, vector_from(portal->edge_u)) * (real)portal->edge_u.w;
    const real v = vector_dot(at, vector_from(portal->edge_v)) * (real)portal->edge_v.w;
    return u >= REAL(0.0) && u <= REAL(1.0) && v >= REAL(0.0) && v <= REAL(1.0) ? t : REAL(0.0);
}

/* Density per steradian of a direction through a portal at distance t, over its weight. */
static inline real portal_density(global const SkyPortal* portal, real3 wi, real t)
{
    return t * t / ((real)portal->normal.w * -vector_dot(vector_from(portal->normal), wi));
}

/* Density per steradian of sampling a direction through portals, whose weights have the sum `all`, not 0. */
static inline real portals_pdf_w(const Scene* scene, const RenderParams* params, const LightView* view,
                                 real3 wi, real all)
{
    real sum = REAL(0.0);
    for (uint i = 0u; i < params->portal_count; ++i) {
        global const SkyPortal* portal = scene->sky_portals + i;
        const real t = portal_distance(portal, view->position, wi);
        if (t > REAL(0.0))
            sum = fma(portal_weight(portal, view), portal_density(portal, wi, t), sum);
    }
    return sum / all;
}

/* Samples a direction through portals, whose weights have the sum `all`, not 0; u in (0, 1)^2. */
static inline real3 portals_sample(const Scene* scene, const RenderParams* params, const LightView* view,
                                   real all, real2 u)
{
    real rest = u.x * all, weight = REAL(0.0);
    global const SkyPortal* chosen = scene->sky_portals;
    for (uint i = 0u; i < params->portal_count; ++i) {
        global const SkyPortal* portal = scene->sky_portals + i;
        const real next = portal_weight(portal, view);
        if (!(next > REAL(0.0)))
            continue;
        /* Roundings may leave a little behind the last one. */
        rest = weight > REAL(0.0) ? rest - weight : rest;
        chosen = portal;
        weight = next;
        if (rest < weight)
            break;
    }
    const real across = fmin(rest / weight, REAL(1.0));
    const real3 way = fma((real3)(across), vector_from(chosen->edge_u),
                          u.y * vector_from(chosen->edge_v) + vector_from(chosen->corner) - view->position);
    return way / vector_length(way);
}

/* Whether a number in (0, 1) chooses the portals, and what is left of it. */
static inline bool portals_are_chosen(const RenderParams* params, real v)
{
    return v < (real)params->portal_share;
}

static inline real portals_rest(const RenderParams* params, real v)
{
    const real share = (real)params->portal_share;
    return fmin(v < share ? v / share : (v - share) / (REAL(1.0) - share), PORTAL_LARGEST_NUMBER);
}

/* Density per steradian of sampling the environment in the direction wi to a place of the map from the vertex
   of `view`: by portals, whose weights there have the sum `all`, and by the map's table. */
static inline real sky_mixed_pdf_w(const Scene* scene, const RenderParams* params, const LightView* view,
                                   real3 wi, real2 place, real all)
{
    const real by_table =
        environment_is_searched(params) ? environment_map_pdf_w_at(scene, params, place) : REAL(0.0);
    if (all == REAL(0.0))
        return by_table;
    return environment_mix(by_table, portals_pdf_w(scene, params, view, wi, all), (real)params->portal_share);
}

/* The same where the weights are not known yet. */
static CLRT_NOINLINE real sky_pdf_w(const Scene* scene, const RenderParams* params, const LightView* view,
                                    real3 wi, real2 place)
{
    return sky_mixed_pdf_w(scene, params, view, wi, place, portals_weight(scene, params, view));
}

/* Samples a direction to the environment from the vertex of `view`: by portals, if any faces it and v says
   so, else by the table, if there is one, with what is left of v. */
static CLRT_NOINLINE LightSample sky_sample_portals(const Scene* scene, const RenderParams* params,
                                                    const LightView* view, uint word, uint alias_word, real v)
{
    LightSample sample = light_sample_none();
    const real all = portals_weight(scene, params, view);
    const real rest = portals_rest(params, v);
    if (all > REAL(0.0) && portals_are_chosen(params, v)) {
        sample.wi = portals_sample(scene, params, view, all, (real2)(sampler_unit(word), rest));
        sample.is_delta = false;
    } else if (environment_is_searched(params))
        sample = environment_map_sample(scene, params, word, alias_word, rest);
    else
        return sample;
    const real2 place = environment_place(params, sample.wi);
    sample.radiance = environment_eval_at(scene, params, place);
    sample.pdf_w = sky_mixed_pdf_w(scene, params, view, sample.wi, place, all);
    return sample;
}

#endif
