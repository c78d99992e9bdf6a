// SPDX-License-Identifier: Apache-2.0
// What integrators do where a ray ends, whatever they make of it; a replay's record (trace/trace.h) is
// written on the way.
#ifndef CLRT_PATH_VERTEX_H
#define CLRT_PATH_VERTEX_H

#include "lights/lights.h"
#include "nan.h"
#include "solid.h"
#include "visibility.h"

/* Finds where a ray ends. `segment`: of its path, from 1; `node`: its number in a tree of rays, 0 on a path.
   The random numbers of cut-outs and panes are addressed by the node, on a path by the segment. `carried`: as
   in visible_hit. */
static inline Hit vertex_hit(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                             uint segment, uint node, Ray* ray, real3* carried)
{
    const Hit hit = visible_hit(scene, params, sampler, node != 0u ? node : segment, ray, carried);
    TRACE_CHOICES(scene, TRACE_VERTEX, segment, node);
    TRACE_VECTOR(scene, TRACE_RAY_ORIGIN, ray->origin);
    TRACE_VECTOR(scene, TRACE_RAY_DIRECTION, ray->direction);
    TRACE_CHOICES(scene, TRACE_TRIANGLE, hit.triangle, hit_instance(&hit));
    if (hit.triangle != NO_INDEX) {
        TRACE_NUMBER(scene, TRACE_DISTANCE, hit.t);
        TRACE_VECTOR(scene, TRACE_BARYCENTRIC, vector_make(hit.b1, hit.b2, REAL(0.0)));
    }
    return hit;
}

/* The BSDF by which radiance is scattered on. */
static inline Bsdf vertex_bsdf(const Scene* scene, const Surface* surface, real3 wo)
{
    const Bsdf bsdf = material_bsdf(scene, surface, wo, TRANSPORT_RADIANCE);
    TRACE_VECTOR(scene, TRACE_NORMAL_S, bsdf.frame.z);
    return bsdf;
}

/* The light from outside the scene to a ray that has left it (lights_outside). */
static inline real3 vertex_sky(const Scene* scene, const RenderParams* params, uint segment,
                               const LightView* view, const Ray* ray, real pdf_w, uint kinds)
{
    const real3 sky = lights_outside(scene, params, segment, view, ray->direction, pdf_w, kinds);
    TRACE_VECTOR(scene, TRACE_SKY, sky);
    return sky;
}

/* Adds light to a sample's radiance. */
static inline void vertex_add(const Scene* scene, real3 light, real3* radiance)
{
    *radiance += light;
    TRACE_VECTOR(scene, TRACE_ADDED, light);
}

#endif
