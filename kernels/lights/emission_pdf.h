// SPDX-License-Identifier: Apache-2.0
// Densities of the rays with which light paths start (emission.h). Functions of a whole ray know whether
// emission is aimed; the others are of emission that is not.
#ifndef CLRT_LIGHTS_EMISSION_PDF_H
#define CLRT_LIGHTS_EMISSION_PDF_H

#include "emission_aim.h"
#include "lights.h"

static inline LightKinds emission_kinds(const RenderParams* params)
{
    const LightKinds kinds = {(real)params->emit_emitter, (real)params->emit_environment,
                              (real)params->emit_light};
    return kinds;
}

/* Density of a point on the disc through which light at infinity comes. */
static inline real emission_disc_pdf_a(const RenderParams* params)
{
    const real radius = (real)params->emission_radius;
    return REAL_INVERSE_PI / (radius * radius);
}

/* Density of the parallel ray along w through a point, aimed or not. */
static inline real emission_disc_ray_pdf_a(const Scene* scene, const RenderParams* params, real3 point,
                                           real3 w)
{
    return EMISSION_IS_AIMED ? aim_disc_pdf_a(scene, params, point, w) : emission_disc_pdf_a(params);
}

/* The part of an emitter's rays that leaves on one side. */
static inline real emission_side_share(const Scene* scene, uint material)
{
    return (scene->materials[material].flags & MATERIAL_EMITS_BOTH_SIDES) ? REAL(0.5) : REAL(1.0);
}

/* Density of a point on an emissive triangle, on the side that is asked for. */
static inline real emission_triangle_pdf_a(const Scene* scene, const RenderParams* params, uint emitter)
{
    const uint material = scene->triangles[scene->emitters[emitter].triangle].material;
    return (real)params->emit_emitter * (real)scene->emitters[emitter].pdf_a *
           emission_side_share(scene, material);
}

/* Density of the ray that leaves an emissive triangle at a point of cosine `cosine`. */
static inline real emission_triangle_pdf(const Scene* scene, const RenderParams* params, uint emitter,
                                         real cosine)
{
    return emission_triangle_pdf_a(scene, params, emitter) * cosine * REAL_INVERSE_PI;
}

/* The same of the ray from a point along w, aimed or not; `normal_g` is on the side that shines. */
static inline real emission_triangle_ray_pdf(const Scene* scene, const RenderParams* params, uint emitter,
                                             real3 point, real3 normal_g, real3 w)
{
    if (!EMISSION_IS_AIMED)
        return emission_triangle_pdf(scene, params, emitter, vector_dot(normal_g, w));
    const AimOrigin origin = aim_origin(scene, params, point, normal_g);
    return emission_triangle_pdf_a(scene, params, emitter) * aim_pdf_w(scene, params, &origin, w);
}

/* Density per steradian of light of the sky from direction wi. */
static inline real emission_sky_pdf_w(const Scene* scene, const RenderParams* params, real3 wi)
{
    const real pdf_w = HAS(EFFECT_ENVIRONMENT_MAP) && params->environment_width != 0u
                           ? environment_map_pdf_w(scene, params, wi)
                           : REAL(0.25) * REAL_INVERSE_PI;
    return (real)params->emit_environment * pdf_w;
}

/* The directions in which a point light sends its rays, all alike. */
typedef struct {
    real3 axis;         /* unit */
    real one_minus_cos; /* 2: all around */
} EmissionCone;

/* All around from within the sphere, else only to the sphere; of a spot its own cone where that is
   narrower. */
static inline EmissionCone emission_point_cone(const RenderParams* params, global const Light* light)
{
    EmissionCone cone = {(real3)(REAL(0.0), REAL(0.0), REAL(1.0)), REAL(2.0)};
    const real3 position = vector_from(light->vector);
    const real radius = (real)params->emission_radius;
    const real square = vector_dot(position, position);
    if (square > radius * radius) {
        const real sine_squared = radius * radius / square;
        cone.axis = vector_normalize(-position);
        cone.one_minus_cos = sine_squared / (REAL(1.0) + real_root(REAL(1.0) - sine_squared));
    }
    if (delta_light_is_spot(light) && (real)light->one_minus_cos < cone.one_minus_cos) {
        cone.axis = (real3)((real)light->axis_x, (real)light->axis_y, (real)light->axis_z);
        cone.one_minus_cos = (real)light->one_minus_cos;
    }
    return cone;
}

/* Density per steradian of a sun's direction, the choice of the sun included; 1 over what a delta sun leaves
   to choose. */
static inline real emission_sun_pdf_w(const Scene* scene, const RenderParams* params, uint index)
{
    const real disc = (real)scene->lights[index].one_minus_cos;
    return (real)params->emit_light * (real)scene->lights[index].probability *
           (disc > REAL(0.0) ? warp_cone_pdf_w(disc) : REAL(1.0));
}

/* Density per steradian of the ray that leaves a point light along w, aimed or not: w is within its cone. */
static inline real emission_point_ray_pdf_w(const Scene* scene, const RenderParams* params, uint index,
                                            real3 w)
{
    global const Light* light = scene->lights + index;
    const real chosen = (real)params->emit_light * (real)light->probability;
    if (!EMISSION_IS_AIMED)
        return chosen * warp_cone_pdf_w(emission_point_cone(params, light).one_minus_cos);
    const AimOrigin origin = aim_origin(scene, params, vector_from(light->vector), (real3)(REAL(0.0)));
    return chosen * aim_pdf_w(scene, params, &origin, w);
}

#endif
