// SPDX-License-Identifier: Apache-2.0
// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997): simulates
// L(D|G|S)*E. One path a sample; a segment is one ray, so a path of max_depth segments scatters max_depth - 1 times.
#ifndef CLRT_INTEGRATORS_PATH_H
#define CLRT_INTEGRATORS_PATH_H

#include "film/film.h"
#include "geometry/visibility.h"
#include "lights/lights.h"

/* Russian roulette never continues with less than this: a weight grows at most twentyfold. */
#define PATH_SMALLEST_SURVIVAL REAL(0.05)

/* The random numbers of one vertex. They are drawn before the ray is traced: they do not wait for the hit, so a processor
   that works ahead hides their long chain of multiplications. */
typedef struct {
    uint2 light;
    uint alias;
    real lobe;
    real2 direction;
} PathNumbers;

static inline PathNumbers path_numbers(const Sampler* sampler, uint segment)
{
    PathNumbers numbers;
    numbers.light = sampler_pair_words(sampler, segment, SAMPLE_LIGHT);
    numbers.alias = sampler_word(sampler, segment, SAMPLE_LIGHT_ALIAS);
    numbers.lobe = sampler_number(sampler, segment, SAMPLE_LOBE);
    numbers.direction = sampler_pair(sampler, segment, SAMPLE_DIRECTION);
    return numbers;
}

/* Emission of a surface hit at distance t, weighted against the light sampling that could have found it. */
static inline real3 path_emission(const Scene* scene, const RenderParams* params, const Surface* surface, real t, real3 wo,
                                  real pdf_w)
{
    const real3 emitted = material_emitted(scene, surface);
    if (pdf_w == REAL(0.0))
        return emitted;
    const real light_pdf_w = (real)params->choose_emitter * emitter_hit_pdf_w(scene, surface, t, wo);
    return emitted * mis_weight(pdf_w, light_pdf_w);
}

/* Radiance that one sampled light sends towards the eye by way of this surface, weighted against BSDF sampling. */
static CLRT_NOINLINE real3 path_direct(const Scene* scene, const RenderParams* params, const PathNumbers* numbers,
                                       const Surface* surface, const Bsdf* bsdf, PixelRays* rays)
{
    const real3 nothing = (real3)(REAL(0.0));
    const LightSample light =
        lights_sample(scene, params, surface, bsdf->frame.z, numbers->light, numbers->alias);
    if (light.pdf_w == REAL(0.0))
        return nothing;
    const BsdfValue eval = bsdf_eval(bsdf, light.wi);
    const real3 contribution = eval.value * light.radiance;
    if (vector_is_black(contribution))
        return nothing;
    const Ray shadow = light_shadow_ray(surface, &light);
    ++rays->shadow;
    const real share = visible_share(scene, params, &shadow);
    if (share == REAL(0.0))
        return nothing;
    const real weight = light.is_delta ? REAL(1.0) : mis_weight(light.pdf_w, eval.pdf_w);
    return contribution * (share * weight / light.pdf_w);
}

/* Ends paths of small weight without bias; the throughput of a survivor grows accordingly. The index ratios crossed so far
   are taken out: light inside glass is not lost, only compressed. */
static inline bool path_survives(const RenderParams* params, const Sampler* sampler, uint segment, real eta_squared,
                                 real3* throughput)
{
    if (segment < params->roulette_depth)
        return true;
    const real survival =
        clamp(vector_max_component(*throughput) / eta_squared, PATH_SMALLEST_SURVIVAL, REAL(1.0));
    if (sampler_number(sampler, segment, SAMPLE_ROULETTE) >= survival)
        return false;
    *throughput /= survival;
    return true;
}

static CLRT_NOINLINE real3 path_radiance(const Scene* scene, const RenderParams* params, const Sampler* sampler, Ray ray,
                                         PixelRays* rays)
{
    real3 radiance = (real3)(REAL(0.0));
    real3 throughput = (real3)(REAL(1.0));
    real eta_squared = REAL(1.0);
    real pdf_w = REAL(0.0); /* of the ray's direction; 0 for camera rays and delta lobes */
    for (uint segment = 1u;; ++segment) {
        const real3 wo = -ray.direction;
        const PathNumbers numbers = path_numbers(sampler, segment);

        /* Find the next vertex. */
        const Hit hit = visible_hit(scene, params, sampler, segment, &ray);
        if (hit.triangle == NO_INDEX) {
            radiance += throughput * lights_escape(scene, params, ray.direction, pdf_w);
            break;
        }
        const Surface surface = surface_at(scene, &hit, wo);

        /* Add what it emits. */
        if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX)
            radiance += throughput * path_emission(scene, params, &surface, hit.t, wo, pdf_w);
        if (segment >= params->max_depth)
            break;
        const Bsdf bsdf = material_bsdf(scene, &surface, wo);
        if (bsdf.lobes == 0u)
            break;

        /* Choose the next direction. */
        const BsdfSample sample = bsdf_sample(&bsdf, numbers.lobe, numbers.direction);

        /* Connect to a light. */
        if (bsdf_has_smooth_lobe(&bsdf))
            radiance += throughput * path_direct(scene, params, &numbers, &surface, &bsdf, rays);

        /* Go on, or let Russian roulette end the path. */
        if (!sample.is_valid)
            break;
        throughput *= sample.weight;
        pdf_w = sample.pdf_w;
        eta_squared *= sample.eta * sample.eta;
        if (!path_survives(params, sampler, segment, eta_squared, &throughput))
            break;
        ray = ray_make(surface_origin(&surface, sample.wi), sample.wi);
        ++rays->secondary;
    }
    return radiance;
}

#endif
