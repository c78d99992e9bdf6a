// SPDX-License-Identifier: Apache-2.0
// What sampling a light gives, and the alias table that all lights are chosen by.
#ifndef CLRT_LIGHTS_LIGHT_SAMPLE_H
#define CLRT_LIGHTS_LIGHT_SAMPLE_H

#include "geometry/surface.h"
#include "numerics/warp.h"
#include "shared/path_types.h"

typedef struct {
    real3 wi;       /* world, unit, from the surface */
    real3 radiance; /* arriving if nothing is in between; irradiance at normal incidence for a delta light */
    real3 target;   /* where the shadow ray ends; unused when distant */
    real pdf_w;     /* per steradian from the surface; 1 for a delta light, 0 where no light was found */
    uint kind;      /* KIND_*, set where lights of several kinds are chosen from */
    uint triangle;  /* of an emissive triangle, else NO_INDEX */
    uint light;     /* its number (light_choice.h), set where lights are chosen from; NO_INDEX: none */
    bool is_distant;
    bool is_delta;
    bool reflects; /* the light is on wo's side of the surface; true until light_choose_side looks */
} LightSample;

/* No light: nothing arrives. */
static inline LightSample light_sample_none(void)
{
    LightSample sample;
    sample.wi = (real3)(REAL(0.0), REAL(0.0), REAL(1.0));
    sample.radiance = (real3)(REAL(0.0));
    sample.target = (real3)(REAL(0.0));
    sample.triangle = NO_INDEX;
    sample.light = NO_INDEX;
    sample.pdf_w = REAL(0.0);
    sample.kind = KINDS_ALL;
    sample.is_distant = true;
    sample.is_delta = true;
    sample.reflects = true;
    return sample;
}

/* Writes a sampled light into a replay's record. */
static inline void light_record(const Scene* scene, const LightSample* sample)
{
    TRACE_CHOICE(scene, TRACE_LIGHT_KIND, sample->pdf_w == REAL(0.0) ? 0u : sample->kind);
    if (sample->pdf_w == REAL(0.0))
        return;
    TRACE_VECTOR(scene, TRACE_LIGHT_DIRECTION, sample->wi);
    TRACE_VECTOR(scene, TRACE_LIGHT_RADIANCE, sample->radiance);
    TRACE_NUMBER(scene, TRACE_LIGHT_PDF, sample->pdf_w);
}

/* How often denser per steradian a density on a light of this normal (any length) is where it is `way` away
   than where it is `other_way` away: by d^2 / cos_l. Not positive, or not finite, where the two do not see
   the same face. */
static inline real light_density_ratio(real3 way, real3 other_way, real3 normal)
{
    const real squares = vector_dot(way, way) / vector_dot(other_way, other_way);
    return squares * real_sqrt(squares) * (vector_dot(other_way, normal) / vector_dot(way, normal));
}

/* Light that was sampled from the facet but lies below its plane reaches the surface on wo's side at the
   curved surface, where such rays start: there it has another direction, distance and density. None if it is
   on the other side of that point or shows it another face. */
static CLRT_NOINLINE void light_from_curved(const Scene* scene, const Surface* surface, LightSample* sample)
{
    const real3 flat_way = sample->target - surface->position;
    const real3 way = flat_way - surface->bulge;
    const real square = vector_dot(way, way);
    sample->wi = way / real_sqrt(square);
    real ratio = REAL(1.0);
    if (sample->triangle == NO_INDEX)
        sample->radiance *= vector_dot(flat_way, flat_way) / square;
    else {
        real3 p0, p1, p2;
        surface_corners(scene, scene->triangles + sample->triangle, &p0, &p1, &p2);
        ratio = light_density_ratio(way, flat_way, surface_cross(p1 - p0, p2 - p0));
    }
    const bool is_seen = square > REAL(0.0) && ratio > REAL(0.0) && ratio < REAL_FAR;
    sample->pdf_w = is_seen && surface_reflects(surface, sample->wi) ? sample->pdf_w * ratio : REAL(0.0);
}

/* Decides on which side of the surface a light lies that was sampled from its facet. */
static inline void light_choose_side(const Scene* scene, const Surface* surface, LightSample* sample)
{
    sample->reflects = surface_reflects(surface, sample->wi);
    if (!sample->is_distant && surface_is_lifted(surface, sample->reflects, sample->wi))
        light_from_curved(scene, surface, sample);
}

/* The shadow ray from a surface to the sampled light. */
static inline Ray light_shadow_ray(const Surface* surface, const LightSample* sample)
{
    Ray ray = surface_ray(surface, sample->reflects, sample->wi);
    if (sample->is_distant)
        return ray;
    ray_end_at(sample->target, &ray);
    return ray;
}

#endif
