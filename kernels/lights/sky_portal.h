// SPDX-License-Identifier: Apache-2.0
// Light sampling of the sky through windows, doors and skylights. From within a room hardly any direction to
// the sky is free; those that are lie in a few rectangles (src/scene/sky_portals.h finds them). One is chosen
// by what it shows the vertex of the sky: of a map, a direction through it by the same
// (lights/rectified_sky.h), of an even sky a point on it. The density is that of the mixture with the map's
// table, and shadow rays tell what is in between. So a rectangle where there is no window costs samples,
// never light, and a window without one is found by the table and by the BSDF.
#ifndef CLRT_LIGHTS_SKY_PORTAL_H
#define CLRT_LIGHTS_SKY_PORTAL_H

#include "environment_sample.h"
#include "light_tree.h"
#include "rectified_sky.h"

/* A portal whose middle the surface sees below its horizon may yet reach above it. */
#define PORTAL_SMALLEST_COS REAL(0.1)

/* Of those that random numbers are: 1 - 2^-24. */
#define PORTAL_LARGEST_NUMBER REAL(0.999999940395355224609375)

/* A portal as a vertex sees it. */
typedef struct {
    real height;     /* of the vertex before its plane; not positive behind it */
    real2 low, high; /* slopes of its edges */
} PortalView;

static inline PortalView portal_view(global const SkyPortal* portal, real3 position)
{
    const real3 to_corner = vector_from(portal->corner) - position;
    PortalView seen;
    seen.height = -vector_dot(vector_from(portal->normal), to_corner);
    seen.low = (real2)(vector_dot(vector_from(portal->axis_u), to_corner),
                       vector_dot(vector_from(portal->axis_v), to_corner)) /
               seen.height;
    seen.high = seen.low + (real2)((real)portal->axis_u.w, (real)portal->axis_v.w) / seen.height;
    return seen;
}

/* The way to the point of a plane at this height with these slopes. */
static inline real3 portal_way(global const SkyPortal* portal, real height, real2 slopes)
{
    const real2 along = slopes * height;
    return along.x * vector_from(portal->axis_u) + along.y * vector_from(portal->axis_v) -
           height * vector_from(portal->normal);
}

/* The window in its map. */
static inline RectifiedWindow portal_window(const Scene* scene, global const SkyPortal* portal,
                                            const PortalView* seen)
{
    return rectified_sky_window(scene->sky_sums + portal->first_sum, seen->low, seen->high);
}

/* Squared distance of the point of the plane with these slopes. */
static inline real portal_square(const PortalView* seen, real2 slopes)
{
    const real2 along = slopes * seen->height;
    return fma(seen->height, seen->height, fma(along.x, along.x, along.y * along.y));
}

/* Squared distance of the middle, from near by the portal's size. */
static inline real portal_near_square(const PortalView* seen)
{
    const real2 sides = (seen->high - seen->low) * seen->height;
    return fma(sides.x * sides.y, REAL(0.25), portal_square(seen, REAL(0.5) * (seen->low + seen->high)));
}

/* The portal's solid angle, more or less. */
static inline real portal_even_total(const PortalView* seen)
{
    const real2 sides = (seen->high - seen->low) * seen->height;
    const real square = portal_near_square(seen);
    return sides.x * sides.y * seen->height / (square * real_sqrt(square));
}

/* The same times the density per steradian of even points on it. */
static inline real portal_even_density(const PortalView* seen, real2 slopes)
{
    const real ratio = portal_square(seen, slopes) / portal_near_square(seen);
    return ratio * real_sqrt(ratio);
}

/* What is seen of the sky through a portal, in units of its map. */
static inline real portal_total(const Scene* scene, const RenderParams* params,
                                global const SkyPortal* portal, const PortalView* seen)
{
    if (!environment_is_map(params))
        return portal_even_total(seen);
    const RectifiedWindow window = portal_window(scene, portal, seen);
    return rectified_sky_total(&window);
}

/* Factor by which what is seen through a portal counts at a vertex: the light of a unit of the sums, and the
   cosine of its middle. */
static inline real portal_factor(global const SkyPortal* portal, const LightView* view,
                                 const PortalView* seen)
{
    const real3 way = portal_way(portal, seen->height, REAL(0.5) * (seen->low + seen->high));
    const bool has_horizon = !vector_is_black(fabs(view->normal));
    const real cosine =
        has_horizon ? fmax(vector_dot(view->normal, way) / vector_length(way), PORTAL_SMALLEST_COS)
                    : REAL(1.0);
    return (real)portal->corner.w * cosine;
}

/* The light through portals at a vertex, more or less, of which one is chosen in proportion. */
typedef struct {
    real all;    /* of all of them; 0: it is behind them */
    uint chosen; /* a portal */
    real factor; /* its portal_factor */
    real u;      /* what is left of the number that has chosen it */
} PortalChoice;

/* Chooses by a number u in (0, 1). Each portal takes its share of what the number has been so far. */
static CLRT_NOINLINE PortalChoice portals_choose(const Scene* scene, const RenderParams* params,
                                                 const LightView* view, real u)
{
    PortalChoice choice = {REAL(0.0), 0u, REAL(0.0), u};
    for (uint i = 0u; i < params->portal_count; ++i) {
        global const SkyPortal* portal = scene->sky_portals + i;
        const PortalView seen = portal_view(portal, view->position);
        if (!(seen.height > REAL(0.0)))
            continue;
        const real factor = portal_factor(portal, view, &seen);
        const real weight = factor * portal_total(scene, params, portal, &seen);
        if (!(weight > REAL(0.0)))
            continue;
        choice.all += weight;
        const real share = weight / choice.all;
        const bool is_chosen = choice.u < share;
        choice.u = fmin(is_chosen ? choice.u / share : (choice.u - share) / (REAL(1.0) - share),
                        PORTAL_LARGEST_NUMBER);
        choice.chosen = is_chosen ? i : choice.chosen;
        choice.factor = is_chosen ? factor : choice.factor;
    }
    return choice;
}

/* Of all portals together. */
static inline real portals_weight(const Scene* scene, const RenderParams* params, const LightView* view)
{
    return portals_choose(scene, params, view, REAL(0.5)).all;
}

/* Density per steradian, times the light through all portals, of sampling a direction through one other than
   `but`. */
static inline real portals_density(const Scene* scene, const RenderParams* params, const LightView* view,
                                   real3 wi, uint but)
{
    real sum = REAL(0.0);
    for (uint i = 0u; i < params->portal_count; ++i) {
        global const SkyPortal* portal = scene->sky_portals + i;
        const real cosine = -vector_dot(vector_from(portal->normal), wi);
        const PortalView seen = portal_view(portal, view->position);
        if (i == but || !(seen.height > REAL(0.0)) || !(cosine > REAL(0.0)))
            continue;
        const real2 slopes = (real2)(vector_dot(vector_from(portal->axis_u), wi),
                                     vector_dot(vector_from(portal->axis_v), wi)) /
                             cosine;
        if (!all(slopes >= seen.low) || !all(slopes <= seen.high))
            continue;
        real density;
        if (environment_is_map(params)) {
            const RectifiedWindow window = portal_window(scene, portal, &seen);
            density = rectified_sky_density_at(&window, slopes);
        } else
            density = portal_even_density(&seen, slopes);
        sum = fma(portal_factor(portal, view, &seen), density, sum);
    }
    return sum;
}

/* Samples a direction through the chosen portal; `density` as above, of this portal alone. */
static inline real3 portals_sample(const Scene* scene, const RenderParams* params, const LightView* view,
                                   const PortalChoice* choice, real u, real* density)
{
    global const SkyPortal* portal = scene->sky_portals + choice->chosen;
    const PortalView seen = portal_view(portal, view->position);
    const real2 numbers = (real2)(choice->u, u);
    real3 way;
    if (environment_is_map(params)) {
        const RectifiedWindow window = portal_window(scene, portal, &seen);
        way = portal_way(portal, REAL(1.0), rectified_sky_sample(&window, numbers, density));
    } else {
        const real2 slopes = fma(numbers, seen.high - seen.low, seen.low);
        way = portal_way(portal, seen.height, slopes);
        *density = portal_even_density(&seen, slopes);
    }
    *density *= choice->factor;
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

/* Density per steradian of sampling the environment in the direction to a place of the map: by the map's
   table, and by portals, whose density times their light is `density`, and whose light is `all`. */
static inline real sky_mixed_pdf_w(const Scene* scene, const RenderParams* params, real2 place, real density,
                                   real all)
{
    const real by_table =
        environment_is_searched(params) ? environment_map_pdf_w_at(scene, params, place) : REAL(0.0);
    return all == REAL(0.0) ? by_table
                            : environment_mix(by_table, density / all, (real)params->portal_share);
}

/* The same for the direction wi from the vertex of `view`. */
static CLRT_NOINLINE real sky_pdf_w(const Scene* scene, const RenderParams* params, const LightView* view,
                                    real3 wi, real2 place)
{
    if (params->portal_count == 0u)
        return sky_mixed_pdf_w(scene, params, place, REAL(0.0), REAL(0.0));
    return sky_mixed_pdf_w(scene, params, place, portals_density(scene, params, view, wi, NO_INDEX),
                           portals_weight(scene, params, view));
}

/* Samples a direction to the environment from the vertex of `view`: by portals, if any faces it and v says
   so, else by the table, if there is one, with what is left of v. */
static CLRT_NOINLINE LightSample sky_sample_portals(const Scene* scene, const RenderParams* params,
                                                    const LightView* view, uint word, uint alias_word, real v)
{
    LightSample sample = light_sample_none();
    const PortalChoice choice = portals_choose(scene, params, view, sampler_unit(word));
    const real rest = portals_rest(params, v);
    real density = REAL(0.0);
    uint but = NO_INDEX;
    if (choice.all > REAL(0.0) && portals_are_chosen(params, v)) {
        but = choice.chosen;
        sample.wi = portals_sample(scene, params, view, &choice, rest, &density);
        sample.is_delta = false;
    } else if (environment_is_searched(params))
        sample = environment_map_sample(scene, params, word, alias_word, rest);
    else
        return sample;
    density += portals_density(scene, params, view, sample.wi, but);
    const real2 place = environment_place(params, sample.wi);
    sample.radiance = environment_eval_at(scene, params, place);
    sample.pdf_w = sky_mixed_pdf_w(scene, params, place, density, choice.all);
    return sample;
}

#endif
