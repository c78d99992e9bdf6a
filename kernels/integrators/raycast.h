// SPDX-License-Identifier: Apache-2.0
// Ray casting (Appel 1968): the first hit, lit locally with shadows. Simulates L(D|G)?E and traces no secondary ray.
#ifndef CLRT_INTEGRATORS_RAYCAST_H
#define CLRT_INTEGRATORS_RAYCAST_H

#include "direct.h"
#include "path/nan.h"
#include "pixel.h"

static CLRT_NOINLINE real3 raycast_sample(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                          Ray ray, PixelRays* rays)
{
    const real3 wo = -ray.direction;
    Hit hit = visible_hit(scene, params, sampler, 1u, &ray);
    TRACE_HIT(scene, 1u, 0u, &ray, &hit);
    real3 radiance = (real3)(REAL(0.0));
    if (hit.triangle == NO_INDEX) {
        ++rays->missed;
        if (nan_carry(scene, nan_of_miss(&hit), &radiance))
            return radiance;
        const real3 sky = lights_outside(scene, params, 1u, ray.direction, REAL(0.0), KINDS_ALL);
        TRACE_VECTOR(scene, TRACE_SKY, sky);
        TRACE_VECTOR(scene, TRACE_ADDED, sky);
        return sky;
    }
    const Surface surface = visible_surface(scene, params, &ray, &hit);
    TRACE_SURFACE(scene, &surface);
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX) {
        radiance = material_emitted(scene, &surface);
        TRACE_VECTOR(scene, TRACE_EMITTED, radiance);
        TRACE_VECTOR(scene, TRACE_ADDED, radiance);
    }
    if (params->max_depth < 2u)
        return radiance;
    const Bsdf bsdf = material_bsdf(scene, &surface, wo, TRANSPORT_RADIANCE);
    TRACE_VECTOR(scene, TRACE_NORMAL_S, bsdf.frame.z);
    nan_carry(scene, nan_of_vector(surface.normal_g + bsdf.wo), &radiance);
    const real3 direct = direct_light(scene, params, sampler, 1u, &surface, &bsdf, true, rays);
    TRACE_VECTOR(scene, TRACE_ADDED, direct);
    return radiance + direct;
}

static inline void raycast_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples, uint count,
                                    PixelRays* rays)
{
    for (uint k = 0; k < count; ++k)
        samples[k].radiance = raycast_sample(scene, params, &samples[k].sampler, samples[k].ray, rays);
}

#endif
