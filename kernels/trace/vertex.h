// SPDX-License-Identifier: Apache-2.0
// What the integrators record of a vertex; see trace.h.
#ifndef CLRT_TRACE_VERTEX_H
#define CLRT_TRACE_VERTEX_H

#include "lights/light_sample.h"
#include "scattering/bsdf_types.h"
#include "trace.h"

#ifdef CLRT_TRACE

/* A vertex begins: the ray that leads there and what it hits. */
static inline void trace_hit(const Scene* scene, uint bounce, uint node, const Ray* ray, const Hit* hit)
{
    TRACE_CHOICES(scene, TRACE_VERTEX, bounce, node);
    TRACE_VECTOR(scene, TRACE_RAY_ORIGIN, ray->origin);
    TRACE_VECTOR(scene, TRACE_RAY_DIRECTION, ray->direction);
    TRACE_CHOICE(scene, TRACE_TRIANGLE, hit->triangle);
    if (hit->triangle == NO_INDEX)
        return;
    TRACE_NUMBER(scene, TRACE_DISTANCE, hit->t);
    TRACE_VECTOR(scene, TRACE_BARYCENTRIC, vector_make(hit->b1, hit->b2, REAL(0.0)));
}

static inline void trace_surface(const Scene* scene, const Surface* surface)
{
    TRACE_CHOICE(scene, TRACE_FRONT, surface->front ? 1u : 0u);
    TRACE_VECTOR(scene, TRACE_POSITION, surface->position);
    TRACE_VECTOR(scene, TRACE_NORMAL_G, surface->normal_g);
    TRACE_NUMBER(scene, TRACE_OFFSET, surface->offset);
}

static inline void trace_direction(const Scene* scene, const BsdfSample* next, bool continues)
{
    TRACE_CHOICE(scene, TRACE_LOBE, next->lobe);
    TRACE_VECTOR(scene, TRACE_WI, next->wi);
    TRACE_VECTOR(scene, TRACE_WEIGHT, next->weight);
    TRACE_NUMBER(scene, TRACE_PDF, next->pdf_w);
    TRACE_NUMBER(scene, TRACE_ETA, next->eta);
    TRACE_CHOICE(scene, TRACE_CONTINUES, next->is_valid && continues ? 1u : 0u);
}

static inline void trace_light(const Scene* scene, const LightSample* light)
{
    TRACE_CHOICE(scene, TRACE_LIGHT_KIND, light->pdf_w == REAL(0.0) ? 0u : light->kind);
    if (light->pdf_w == REAL(0.0))
        return;
    TRACE_VECTOR(scene, TRACE_LIGHT_DIRECTION, light->wi);
    TRACE_VECTOR(scene, TRACE_LIGHT_RADIANCE, light->radiance);
    TRACE_NUMBER(scene, TRACE_LIGHT_PDF, light->pdf_w);
}

static inline void trace_visibility(const Scene* scene, real share)
{
    TRACE_CHOICE(scene, TRACE_VISIBLE, share > REAL(0.0) ? 1u : 0u);
    TRACE_NUMBER(scene, TRACE_SHARE, share);
}

#define TRACE_HIT(scene, bounce, node, ray, hit) trace_hit(scene, bounce, node, ray, hit)
#define TRACE_SURFACE(scene, surface) trace_surface(scene, surface)
#define TRACE_DIRECTION(scene, next, continues) trace_direction(scene, next, continues)
#define TRACE_LIGHT(scene, light) trace_light(scene, light)
#define TRACE_VISIBILITY(scene, share) trace_visibility(scene, share)

#else

#define TRACE_HIT(scene, bounce, node, ray, hit)
#define TRACE_SURFACE(scene, surface)
#define TRACE_DIRECTION(scene, next, continues)
#define TRACE_LIGHT(scene, light)
#define TRACE_VISIBILITY(scene, share)

#endif

#endif
