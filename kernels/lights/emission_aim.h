// SPDX-License-Identifier: Apache-2.0
// Emission aimed at casters, the surfaces that may scatter by delta lobes or reflect almost as sharply: in
// builds with -DEMISSION_IS_AIMED=1 light paths leave only towards the spheres that hold all of them
// (Scene::casters), because only there caustics begin; where there are none, no light path leaves. Towards a
// sphere directions are uniform in the cone under which it is seen; from a surface that is near it, by the
// cosine; parallel rays are uniform over the sphere's disc. A ray that meets several spheres is found by the
// way of each, and its density says so.
#ifndef CLRT_LIGHTS_EMISSION_AIM_H
#define CLRT_LIGHTS_EMISSION_AIM_H

#include "geometry/scene.h"
#include "numerics/frame.h"
#include "numerics/warp.h"

#ifndef EMISSION_IS_AIMED
#define EMISSION_IS_AIMED 0
#endif

/* Where the sine of a cone's half angle exceeds sqrt(1/2), the cosine of a surface varies more within it than
   the sphere takes of the hemisphere. */
#define AIM_LARGEST_SINE_SQUARED REAL(0.5)

/* Whence rays are aimed: a point, on a surface or not. */
typedef struct {
    real3 point;
    real3 normal;  /* 0: all directions count the same; else those above the surface, by the cosine */
    uint enclosed; /* the smallest caster's sphere that the point is in, or NO_INDEX */
} AimOrigin;

/* A caster's sphere as seen from there. */
typedef struct {
    real3 axis;         /* towards its centre, unit; of one all around the normal */
    real one_minus_cos; /* of its cone */
    real height;        /* unnormalised density in the cone; 0: below the surface, or hidden */
    real measure;       /* integral of that density */
    bool is_around;     /* no cone: by the cosine over the hemisphere, or all directions */
} AimTarget;

static inline bool aim_has_normal(const AimOrigin* origin)
{
    return vector_dot(origin->normal, origin->normal) > REAL(0.0);
}

/* The largest cosine with the normal in the cone around a unit axis; not positive where it is all below. */
static inline real aim_largest_cosine(real3 normal, real3 axis, real cos_cone)
{
    const real cosine = vector_dot(normal, axis);
    if (cosine >= cos_cone)
        return REAL(1.0);
    const real sines = (REAL(1.0) - cosine * cosine) * (REAL(1.0) - cos_cone * cos_cone);
    return fma(cosine, cos_cone, real_root(sines));
}

static inline real aim_distance_squared(const Scene* scene, uint caster, real3 point)
{
    const real3 way = vector_from(scene->casters[caster]) - point;
    return vector_dot(way, way);
}

static inline AimOrigin aim_origin(const Scene* scene, const RenderParams* params, real3 point, real3 normal)
{
    AimOrigin origin = {point, normal, NO_INDEX};
    real smallest = REAL_FAR;
    for (uint i = 0; i < params->caster_count; ++i) {
        const real radius = (real)CASTER_RADIUS(scene->casters[i]);
        if (radius < smallest && aim_distance_squared(scene, i, point) <= radius * radius) {
            smallest = radius;
            origin.enclosed = i;
        }
    }
    return origin;
}

/* Whether a sphere is outside of the one that encloses the origin: what leaves the inner one, as glass around
   a lamp, is aimed all around. */
static inline bool aim_is_hidden(const Scene* scene, uint caster, const AimOrigin* origin)
{
    if (origin->enclosed == NO_INDEX)
        return false;
    const real3 centre = vector_from(scene->casters[caster]);
    const real touch =
        (real)CASTER_RADIUS(scene->casters[caster]) + (real)CASTER_RADIUS(scene->casters[origin->enclosed]);
    return aim_distance_squared(scene, origin->enclosed, centre) > touch * touch;
}

static inline AimTarget aim_target(const Scene* scene, uint caster, const AimOrigin* origin)
{
    const real3 way = vector_from(scene->casters[caster]) - origin->point;
    const real radius = (real)CASTER_RADIUS(scene->casters[caster]);
    const real square = vector_dot(way, way);
    const bool is_surface = aim_has_normal(origin);
    AimTarget target = {(real3)(REAL(0.0), REAL(0.0), REAL(1.0)), REAL(0.0), REAL(0.0), REAL(0.0), false};
    if (aim_is_hidden(scene, caster, origin))
        return target;
    target.is_around = !(radius * radius < square * (is_surface ? AIM_LARGEST_SINE_SQUARED : REAL(1.0)));
    if (target.is_around) {
        target.axis = is_surface ? origin->normal : target.axis;
        target.one_minus_cos = REAL(2.0);
        target.height = REAL(1.0);
        target.measure = is_surface ? REAL_PI : REAL(4.0) * REAL_PI;
        return target;
    }
    const real sine_squared = radius * radius / square;
    const real cos_cone = real_root(REAL(1.0) - sine_squared);
    target.axis = way / real_sqrt(square);
    target.one_minus_cos = sine_squared / (REAL(1.0) + cos_cone);
    target.height =
        is_surface ? fmax(aim_largest_cosine(origin->normal, target.axis, cos_cone), REAL(0.0)) : REAL(1.0);
    target.measure = target.height / warp_cone_pdf_w(target.one_minus_cos);
    return target;
}

/* Whether the line through a point along a unit vector meets a caster's sphere. */
static inline bool aim_meets(const Scene* scene, uint caster, real3 point, real3 w)
{
    const real3 across = vector_cross(vector_from(scene->casters[caster]) - point, w);
    const real radius = (real)CASTER_RADIUS(scene->casters[caster]);
    return vector_dot(across, across) <= radius * radius;
}

/* Density per steradian of aiming from a point along w. */
static CLRT_NOINLINE real aim_pdf_w(const Scene* scene, const RenderParams* params, const AimOrigin* origin,
                                    real3 w)
{
    real height = REAL(0.0), measure = REAL(0.0);
    for (uint i = 0; i < params->caster_count; ++i) {
        const AimTarget target = aim_target(scene, i, origin);
        measure += target.measure;
        if (target.is_around)
            height += aim_has_normal(origin) ? fmax(vector_dot(origin->normal, w), REAL(0.0)) : REAL(1.0);
        else if (vector_dot(target.axis, w) > REAL(0.0) && aim_meets(scene, i, origin->point, w))
            height += target.height;
    }
    return measure > REAL(0.0) ? height / measure : REAL(0.0);
}

/* A direction from a point: u.x chooses the caster, what is left of it with u.y the direction. */
static CLRT_NOINLINE real3 aim_direction(const Scene* scene, const RenderParams* params,
                                         const AimOrigin* origin, real2 u)
{
    real all = REAL(0.0);
    for (uint i = 0; i < params->caster_count; ++i)
        all += aim_target(scene, i, origin).measure;
    real left = u.x * all;
    AimTarget target = aim_target(scene, 0u, origin);
    for (uint i = 1u; i < params->caster_count && left >= target.measure; ++i) {
        left -= target.measure;
        target = aim_target(scene, i, origin);
    }
    const real share = target.measure > REAL(0.0) ? fmin(left / target.measure, REAL(1.0)) : u.x;
    const real2 rest = (real2)(share, u.y);
    const Frame frame = frame_make(target.axis);
    return frame_to_world(&frame, target.is_around && aim_has_normal(origin)
                                      ? warp_cosine_hemisphere(rest)
                                      : warp_cone(rest, target.one_minus_cos));
}

/* A point on the disc across a caster's sphere and wi, of parallel rays: u.x chooses the caster, the larger
   the more often. */
static CLRT_NOINLINE real3 aim_disc(const Scene* scene, const RenderParams* params, real3 wi, real2 u)
{
    real left = u.x * (real)params->caster_squares;
    uint caster = 0u;
    real radius = (real)CASTER_RADIUS(scene->casters[0]);
    while (left >= radius * radius && caster + 1u < params->caster_count) {
        left -= radius * radius;
        radius = (real)CASTER_RADIUS(scene->casters[++caster]);
    }
    const real2 on_disc = radius * warp_disc((real2)(fmin(left / (radius * radius), REAL(1.0)), u.y));
    const Frame frame = frame_make(wi);
    return vector_from(scene->casters[caster]) + on_disc.x * frame.x + on_disc.y * frame.y;
}

/* Density of the parallel ray through a point, per area across it. */
static CLRT_NOINLINE real aim_disc_pdf_a(const Scene* scene, const RenderParams* params, real3 point, real3 w)
{
    uint met = 0u;
    for (uint i = 0; i < params->caster_count; ++i)
        met += aim_meets(scene, i, point, w) ? 1u : 0u;
    return met == 0u ? REAL(0.0) : (real)met * REAL_INVERSE_PI / (real)params->caster_squares;
}

#endif
