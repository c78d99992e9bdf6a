// SPDX-License-Identifier: Apache-2.0
// Cones around rays, over which textures are filtered (Amanatides 1984; Akenine-Moeller et al. 2021, Ray
// Tracing Gems II, ch. 10). A direction of density p, one of n, stands for the solid angle 1 / (n p) (after
// the path differentials of Suykens and Willems 2001): a pixel's camera ray for its share of the pixel, one
// that a rough surface has scattered for more, one from a mirror for no more than before. Cones narrow as
// samples are added, and what filtering changes in the picture fades with them.
#ifndef CLRT_GEOMETRY_RAY_CONE_H
#define CLRT_GEOMETRY_RAY_CONE_H

#include "numerics/sampler.h"
#include "ray.h"
#include "shared/render_types.h"

/* Directions scatter into a cone no wider than this, sr: about 30 degrees across. */
#define RAY_CONE_LARGEST REAL(0.25)

static inline bool ray_cone_is_wanted(const RenderParams* params)
{
    return HAS(EFFECT_TEXTURE_FILTER) && params->texture_filter != 0u;
}

/* The solid angle of a direction of this density: one of as many as the pixel has samples before this one's
   round of replicates, and this one. A function of the sample alone, so that runs merge. */
static inline real ray_cone_share(const RenderParams* params, const Sampler* sampler, real pdf_w)
{
    const uint index = sampler_reverse_bits(sampler->index_reversed);
    const real samples = (real)index * (real)params->replicates + REAL(1.0);
    return fmin(REAL(1.0) / (samples * pdf_w), RAY_CONE_LARGEST);
}

/* The cone of a ray that has not been scattered yet. */
static inline void ray_cone_begin(const RenderParams* params, const Sampler* sampler, real pdf_w, Ray* ray)
{
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    if (ray_cone_is_wanted(params) && pdf_w > REAL(0.0))
        ray->spread = ray_cone_share(params, sampler, pdf_w);
#endif
}

/* The cone of a ray that a surface has scattered, by a density of 0 where by a delta lobe. Solid angles add
   up as variances do. */
static inline void ray_cone_scatter(const RenderParams* params, const Sampler* sampler, real pdf_w, Ray* ray)
{
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    if (ray_cone_is_wanted(params) && pdf_w > REAL(0.0))
        ray->spread = fmin(ray->spread + ray_cone_share(params, sampler, pdf_w), RAY_CONE_LARGEST);
#endif
}

#endif
