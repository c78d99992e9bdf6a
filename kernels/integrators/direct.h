// SPDX-License-Identifier: Apache-2.0
// Local illumination after Appel (1968) and Whitted (1980): one shadow ray to every light; matte reflection
// and Phong's highlight. All emissive triangles together are one light, the environment is one, each point
// light and sun is one.
#ifndef CLRT_INTEGRATORS_DIRECT_H
#define CLRT_INTEGRATORS_DIRECT_H

#include "film/film.h"
#include "lights/each_light.h"
#include "numerics/real_functions.h"
#include "path/vertex.h"

/* Matte reflection plus the highlight Ks (Ns + 2) / (2 pi) cos^Ns(r, wi), times cos_i. */
static inline real3 direct_eval(const Bsdf* bsdf, real3 wi_world, bool highlight)
{
    const real3 wi = frame_to_local(&bsdf->frame, wi_world);
    real3 value = (real3)(REAL(0.0));
    if (!(wi.z > REAL(0.0)) || !bsdf_sides_agree(bsdf, wi_world, wi))
        return value;
    if (HAS(EFFECT_MATTE) && (bsdf->lobes & LOBE_MATTE))
        value += bsdf_eval_matte(bsdf, wi);
    if (HAS(EFFECT_GLOSSY) && highlight && bsdf->exponent > REAL(0.0)) {
        const real cos_r = vector_dot(vector_make(-bsdf->wo.x, -bsdf->wo.y, bsdf->wo.z), wi);
        if (cos_r > REAL(0.0))
            value += bsdf_reflection_albedo(bsdf) *
                     ((bsdf->exponent + REAL(2.0)) * REAL(0.5) * REAL_INVERSE_PI *
                      real_pow(cos_r, bsdf->exponent) * wi.z);
    }
    const uint whole = bsdf->lobes & (uint)BSDF_LOBES & (LOBE_SHEEN | LOBE_MEASURED);
    if (HAS(EFFECT_SHEEN | EFFECT_MEASURED) && whole != 0u)
        value += bsdf_eval_lobes(bsdf, whole, wi).value;
    return value;
}

/* What one sampled light sends towards the eye by way of the surface. */
static CLRT_NOINLINE real3 direct_from(const Scene* scene, const RenderParams* params, const Surface* surface,
                                       const Bsdf* bsdf, bool highlight, LightSample* light, PixelRays* rays)
{
    real3 nothing = (real3)(REAL(0.0));
    solid_dim_light(scene, surface, light);
    light_record(scene, light);
    if (nan_carry(scene, nan_of_vector(light->wi), &nothing) || light->pdf_w == REAL(0.0))
        return nothing;
    const real3 value = direct_eval(bsdf, light->wi, highlight);
    const real3 contribution = value * light->radiance;
    TRACE_VECTOR(scene, TRACE_LIGHT_BSDF, value);
    TRACE_CHOICE(scene, TRACE_CONNECTS, vector_is_black(contribution) ? 0u : 1u);
    if (vector_is_black(contribution))
        return nothing;
    const Ray shadow = light_shadow_ray(surface, light);
    ++rays->shadow;
    const real3 share = visible_share(scene, params, &shadow);
    TRACE_VECTOR(scene, TRACE_CONNECTION, contribution * (share / light->pdf_w));
    return contribution * (share / light->pdf_w);
}

/* Sums over all lights; `node` addresses the random numbers of this surface. */
static CLRT_NOINLINE real3 direct_light(const Scene* scene, const RenderParams* params,
                                        const Sampler* sampler, uint node, const Surface* surface,
                                        const Bsdf* bsdf, bool highlight, PixelRays* rays)
{
    real3 radiance = (real3)(REAL(0.0));
    const uint alias_word = sampler_word(sampler, node, SAMPLE_LIGHT_ALIAS);
    if (HAS(EFFECT_AREA_LIGHT) && params->emitter_count != 0u) {
        const uint2 words = sampler_light_words(sampler, node);
        LightSample light = emitter_sample(scene, params, surface->position, words.x, alias_word,
                                           sampler_unit(words.y));
        light.kind = KIND_AREA;
        light_choose_side(scene, surface, &light);
        radiance += direct_from(scene, params, surface, bsdf, highlight, &light, rays);
    }
    if (HAS(EFFECT_ENVIRONMENT)) {
        const uint2 words = sampler_pair_words(sampler, node, SAMPLE_SKY);
        LightSample light = each_light_sky(scene, params, surface, bsdf->frame.z, words, alias_word);
        radiance += direct_from(scene, params, surface, bsdf, highlight, &light, rays);
    }
    for (uint i = 0; HAS(EFFECT_DELTA_LIGHT) && i < params->light_count; ++i) {
        const real2 u = sampler_pair(sampler, sampler_hash(node) + i, SAMPLE_DIRECTION);
        LightSample light = each_light_delta(scene, surface, i, u);
        radiance += direct_from(scene, params, surface, bsdf, highlight, &light, rays);
    }
    return radiance;
}

#endif
