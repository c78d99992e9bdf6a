// SPDX-License-Identifier: Apache-2.0
// Light tracing (Arvo 1986; Dutre, Lafortune and Willems 1993): paths from the lights are connected to the
// camera at every vertex. Simulates L((D|G|S)*(D|G))?E: a light that is seen directly is gathered by the
// camera's ray, and nothing is seen in mirrors.
#ifndef CLRT_INTEGRATORS_LIGHT_H
#define CLRT_INTEGRATORS_LIGHT_H

#include "light_paths.h"

/* Gathers the light that a camera's ray meets. */
static inline void light_gather(const Scene* scene, const RenderParams* params, CameraSample* sample,
                                PixelRays* rays)
{
    if (pixel_has_seen(sample)) {
        TRACE_VECTOR(scene, TRACE_ADDED, sample->radiance);
    }
    real3 carried = (real3)(REAL(1.0));
    Hit hit = vertex_hit(scene, params, &sample->sampler, 1u, 0u, &sample->ray, &carried);
    if (hit.triangle == NO_INDEX) {
        ++rays->missed;
        if (nan_carry(scene, nan_of_miss(&hit), &sample->radiance))
            return;
        const real3 sky = vertex_sky(scene, params, 1u, 0, &sample->ray, REAL(0.0), KINDS_ALL);
        vertex_add(scene, carried * sky, &sample->radiance);
        return;
    }
    const Surface surface = visible_surface(scene, params, &sample->ray, &hit);
    nan_carry(scene, nan_of_vector(surface.normal_g), &sample->radiance);
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX && !pixel_has_seen(sample))
        vertex_add(scene, carried * material_emitted(scene, &surface, -sample->ray.direction),
                   &sample->radiance);
}

static CLRT_NOINLINE void light_radiance(const Scene* scene, const RenderParams* params,
                                         CameraSample* samples, uint count, PixelRays* rays)
{
    for (uint k = 0; k < count; ++k) {
        light_gather(scene, params, &samples[k], rays);
        light_paths_trace(scene, params, &samples[k], 0, rays);
    }
}

#endif
