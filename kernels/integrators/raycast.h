// SPDX-License-Identifier: Apache-2.0
// Ray casting (Appel 1968): the first hit, lit locally with shadows. Simulates L(D|G)?E and traces no
// secondary ray.
#ifndef CLRT_INTEGRATORS_RAYCAST_H
#define CLRT_INTEGRATORS_RAYCAST_H

#include "direct.h"
#include "pixel.h"

static CLRT_NOINLINE real3 raycast_sample(const Scene* scene, const RenderParams* params,
                                          const Sampler* sampler, Ray ray, PixelRays* rays)
{
    real3 radiance = (real3)(REAL(0.0));
    real3 carried = (real3)(REAL(1.0));
    Hit hit = vertex_hit(scene, params, sampler, 1u, 0u, &ray, &carried);
    if (hit.triangle == NO_INDEX) {
        ++rays->missed;
        if (!nan_carry(scene, nan_of_miss(&hit), &radiance))
            vertex_add(scene, carried * vertex_sky(scene, params, 1u, 0, &ray, REAL(0.0), KINDS_ALL),
                       &radiance);
        return radiance;
    }
    const real3 wo = -ray.direction;
    const Surface surface = visible_surface(scene, params, &ray, &hit);
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX)
        vertex_add(scene, carried * material_emitted(scene, &surface, wo), &radiance);
    if (params->max_depth < 2u)
        return radiance;
    const Bsdf bsdf = vertex_bsdf(scene, &surface, wo);
    nan_carry(scene, nan_of_vector(surface.normal_g + bsdf.wo), &radiance);
    const real3 direct = direct_light(scene, params, sampler, 1u, &surface, &bsdf, true, rays);
    vertex_add(scene, carried * direct, &radiance);
    return radiance;
}

static inline void raycast_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples,
                                    uint count, PixelRays* rays)
{
    for (uint k = 0; k < count; ++k)
        samples[k].radiance = raycast_sample(scene, params, &samples[k].sampler, samples[k].ray, rays);
}

#endif
