// SPDX-License-Identifier: Apache-2.0
// What a path from the eye would gather if there were no splats and no inner connections, and if it were path's
// own, which is connected to lamps through slabs: for a pilot (film/moments.h).
#ifndef CLRT_PATH_SPLAT_ALONE_H
#define CLRT_PATH_SPLAT_ALONE_H

#include "film/moments.h"
#include "splat_connect.h"

#if FILM_MOMENTS
/* Notes what the present vertex of the path is connected to. */
static inline void alone_connect(const Scene* scene, const RenderParams* params, const Surface* surface,
                                 const Bsdf* bsdf, real3 wo, const Path* path, Moments* moments)
{
    const SplatWeights none = splat_weights_none();
    Path alone = *path;
    splat_connect(scene, params, surface, bsdf, wo, &none, &alone);
    moments->connection = alone.connection;
}

#if LAMPS_BEHIND_SLABS
/* Notes light through slabs that nothing but hits finds of what arrives at the present vertex. The chance of
   a hit to be refracted at all facets counts as 1. */
static CLRT_NOINLINE void alone_miss(const Scene* scene, const RenderParams* params, uint segment,
                                     const Surface* surface, const Bsdf* bsdf, const SplatWeights* weights,
                                     const Path* path, Moments* moments)
{
    if (!splat_is_alone(weights) || !bsdf_has_smooth_lobe(bsdf))
        return;
    LightSample light = lights_sample(scene, params, surface, bsdf_light_normal(bsdf), path->numbers.light,
                                      path->numbers.alias);
    if (light.pdf_w == REAL(0.0))
        return;
    const real3 straight = light.wi;
    Ray shadow;
    PixelRays unused = {0u, 0u, 0u, 0ul, 0u};
    if (!path_see_light(scene, params, segment, surface, bsdf, &light, &shadow, &unused) ||
        vector_is_zero(light.wi - straight))
        return;
    const BsdfValue eval = bsdf_eval(bsdf, light.wi);
    if (eval.pdf_w > REAL(0.0))
        moments_miss(path->throughput * eval.value * light.radiance / light.pdf_w *
                         visible_share(scene, params, &shadow),
                     light.pdf_w / eval.pdf_w, moments);
}
#endif

/* Notes what is told at the present vertex of the path. */
static inline void alone_notes(const Scene* scene, const RenderParams* params, uint segment,
                               const Surface* surface, const Bsdf* bsdf, real3 wo,
                               const SplatWeights* weights, const Path* path, Moments* moments)
{
    alone_connect(scene, params, surface, bsdf, wo, path, moments);
#if LAMPS_BEHIND_SLABS
    alone_miss(scene, params, segment, surface, bsdf, weights, path, moments);
#endif
}

/* Gathers the emission of the surface that was hit, which is `emitted` as weighted against the others. */
static inline void alone_emission(const Scene* scene, const RenderParams* params, const Surface* surface,
                                  const Path* path, real3 wo, real3 emitted, Moments* moments)
{
    const SplatWeights none = splat_weights_none();
    real3 alone = splat_emission(scene, params, surface, path, wo, &none);
    PixelRays unused = {0u, 0u, 0u, 0ul, 0u};
    if (path->pdf_w == REAL(0.0) && !vector_is_black(alone))
        alone *= path_delta_weight(scene, params, surface, path, wo, &unused);
    moments_gather(path->throughput * emitted, path->throughput * alone, moments);
}

/* Gathers the light from outside the scene, which is `sky` as weighted against the others. */
static inline void alone_sky(const Scene* scene, const RenderParams* params, uint segment, const Path* path,
                             real3 sky, Moments* moments)
{
    const SplatWeights none = splat_weights_none();
    const real3 alone = segment == 1u ? sky : path->throughput * splat_escape(scene, params, path, &none);
    moments_gather(sky, alone, moments);
}
#endif

#endif
