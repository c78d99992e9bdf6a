// SPDX-License-Identifier: Apache-2.0
// The ends of a path from the eye that shares its light with splats: what its sample sees of lights by rays
// of its own (emission_rays.h), which no splat brings, and where it leaves the scene.
#ifndef CLRT_INTEGRATORS_SPLAT_ESCAPE_H
#define CLRT_INTEGRATORS_SPLAT_ESCAPE_H

#include "path/splat_alone.h"
#include "pixel.h"

/* Takes what the sample has begun with, if it has. */
static inline void splat_take_seen(const Scene* scene, CameraSample* sample)
{
    if (!pixel_has_seen(sample))
        return;
    TRACE_VECTOR(scene, TRACE_ADDED, sample->radiance);
#if FILM_MOMENTS
    moments_gather(sample->radiance, sample->radiance, &sample->moments);
#endif
}

/* Adds the light from outside the scene to what the sample gathers in `sum`. */
static inline void splat_add_escape(const Scene* scene, const RenderParams* params, uint segment,
                                    const Path* path, const SplatWeights* weights, CameraSample* sample,
                                    real3* sum, PixelRays* rays)
{
    rays->missed += segment == 1u ? 1u : 0u;
    if (nan_carry(scene, nan_of_miss(&path->hit), &sample->radiance))
        return;
    const real3 sky = segment == 1u ? vertex_sky(scene, params, 1u, 0, &path->ray, REAL(0.0), KINDS_ALL)
                                    : splat_escape(scene, params, path, weights);
    vertex_add(scene, path->throughput * sky, sum);
#if FILM_MOMENTS
    alone_sky(scene, params, segment, path, path->throughput * sky, &sample->moments);
#endif
}

#endif
