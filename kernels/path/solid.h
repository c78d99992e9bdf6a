// SPDX-License-Identifier: Apache-2.0
// Solids that absorb on the way through them (Beer and Lambert). A segment lies in a solid where it begins or
// ends on the inner side of the solid's surface, which both ends can tell without knowing the path before:
// so every way to find a path weighs it alike. Between two things that are both inside, as ice in a drink,
// nothing is absorbed; where solids have priorities (geometry/nest.h), what is there absorbs.
#ifndef CLRT_PATH_SOLID_H
#define CLRT_PATH_SOLID_H

#include "geometry/scene.h"
#include "lights/light_sample.h"
#include "numerics/real_functions.h"
#include "shared/effects.h"

/* The material of the solid that lies on the side of a surface, NO_INDEX where nothing absorbs there.
   `reflects`: the side that the surface is seen from. */
static inline uint solid_beside(const Scene* scene, const Surface* surface, bool reflects)
{
    if (!HAS(EFFECT_ATTENUATION))
        return NO_INDEX;
    uint solid = HAS(EFFECT_NESTED) ? nest_top(scene, surface_nest(surface, reflects)) : NO_INDEX;
    if (solid == NO_INDEX)
        solid = surface->front == reflects ? NO_INDEX : surface->material;
    return solid != NO_INDEX && (scene->materials[solid].flags & MATERIAL_ATTENUATES) ? solid : NO_INDEX;
}

static inline real solid_share(real absorption, real distance)
{
    return absorption > REAL(0.0) ? real_exp(-absorption * distance) : REAL(1.0);
}

/* The share of light that a solid lets pass over a distance, which may be infinite. */
static CLRT_NOINLINE real3 solid_passes(const Scene* scene, uint solid, real distance)
{
    const vec4 absorption = scene->extensions[solid].attenuation;
    return vector_make(solid_share((real)absorption.x, distance), solid_share((real)absorption.y, distance),
                       solid_share((real)absorption.z, distance));
}

/* Multiplies what a ray carries that has left a surface on the side of the solid `left` and has met another
   one at distance t. */
static inline void solid_arrive(const Scene* scene, uint left, const Surface* met, real t, real3* carried)
{
    if (!HAS(EFFECT_ATTENUATION))
        return;
    const uint solid = left != NO_INDEX ? left : solid_beside(scene, met, true);
    if (solid != NO_INDEX)
        *carried *= solid_passes(scene, solid, t);
}

/* The same of a ray that has met nothing. */
static inline void solid_escape(const Scene* scene, uint left, real3* carried)
{
    if (HAS(EFFECT_ATTENUATION) && left != NO_INDEX)
        *carried *= solid_passes(scene, left, INFINITY);
}

/* What a solid beside the surface leaves of a sampled light. */
static inline void solid_dim_light(const Scene* scene, const Surface* surface, LightSample* light)
{
    if (!HAS(EFFECT_ATTENUATION) || light->pdf_w == REAL(0.0))
        return;
    const uint solid = solid_beside(scene, surface, surface_reflects(surface, light->wi));
    if (solid == NO_INDEX)
        return;
    const real distance = light->is_distant ? INFINITY : vector_length(light->target - surface->position);
    light->radiance *= solid_passes(scene, solid, distance);
}

#endif
