// SPDX-License-Identifier: Apache-2.0
// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997): simulates
// L(D|G|S)*E. One path a sample; a segment is one ray, so a path of max_depth segments scatters max_depth - 1 times.
// The paths of a few samples advance together: all trace a segment, all handle their vertex, all test their shadow ray.
#ifndef CLRT_INTEGRATORS_PATH_H
#define CLRT_INTEGRATORS_PATH_H

#include "film/film.h"
#include "geometry/visibility.h"
#include "lights/lights.h"
#include "pixel.h"

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

/* A path on its way. */
typedef struct {
    Ray ray;               /* the segment to trace */
    Hit hit;               /* where it ended */
    PathNumbers numbers;   /* of the vertex there */
    real3 throughput;      /* of the path so far: product of BSDF times cosine over pdf */
    real eta_squared;      /* product of the squared index ratios crossed */
    real pdf_w;            /* of the ray's direction; 0 for camera rays and delta lobes */
    Ray shadow;            /* from the vertex to a light, */
    real3 connection;      /* and what arrives if nothing is in between */
    bool is_alive, is_connected;
} Path;

static inline void path_begin(Path* path, const Ray* ray)
{
    path->ray = *ray;
    path->throughput = (real3)(REAL(1.0));
    path->eta_squared = REAL(1.0);
    path->pdf_w = REAL(0.0);
    path->is_alive = true;
}

/* Samples a light and prepares the shadow ray to it; its contribution is weighted against BSDF sampling. */
static inline void path_connect(const Scene* scene, const RenderParams* params, const Surface* surface,
                                       const Bsdf* bsdf, Path* path)
{
    const LightSample light =
        lights_sample(scene, params, surface, bsdf->frame.z, path->numbers.light, path->numbers.alias);
    if (light.pdf_w == REAL(0.0))
        return;
    const BsdfValue eval = bsdf_eval(bsdf, light.wi);
    const real3 arriving = eval.value * light.radiance;
    if (vector_is_black(arriving))
        return;
    const real weight = light.is_delta ? REAL(1.0) : mis_weight(light.pdf_w, eval.pdf_w);
    path->connection = path->throughput * arriving * (weight / light.pdf_w);
    path->shadow = light_shadow_ray(surface, &light);
    path->is_connected = true;
}

/* Ends paths of small weight without bias; the throughput of a survivor grows accordingly. The index ratios crossed so far
   are taken out: light inside glass is not lost, only compressed. */
static inline bool path_survives(const RenderParams* params, const Sampler* sampler, uint segment, Path* path)
{
    if (segment < params->roulette_depth)
        return true;
    const real survival =
        clamp(vector_max_component(path->throughput) / path->eta_squared, PATH_SMALLEST_SURVIVAL, REAL(1.0));
    if (sampler_number(sampler, segment, SAMPLE_ROULETTE) >= survival)
        return false;
    path->throughput /= survival;
    return true;
}

/* Handles the vertex at the end of a segment: adds its emission, connects it to a light, chooses the next segment or ends
   the path. */
static CLRT_NOINLINE void path_vertex(const Scene* scene, const RenderParams* params, uint segment, Path* path,
                                      CameraSample* sample, PixelRays* rays)
{
    const real3 wo = -path->ray.direction;
    path->is_alive = false;
    if (path->hit.triangle == NO_INDEX) {
        sample->radiance += path->throughput * lights_escape(scene, params, path->ray.direction, path->pdf_w);
        return;
    }
    const Surface surface = surface_at(scene, &path->hit, wo);

    /* Add what it emits. */
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX)
        sample->radiance +=
            path->throughput * path_emission(scene, params, &surface, path->hit.t, wo, path->pdf_w);
    if (segment >= params->max_depth)
        return;
    const Bsdf bsdf = material_bsdf(scene, &surface, wo);
    if (bsdf.lobes == 0u)
        return;

    /* Choose the next direction, connect to a light. */
    const BsdfSample next = bsdf_sample(&bsdf, path->numbers.lobe, path->numbers.direction);
    if (bsdf_has_smooth_lobe(&bsdf))
        path_connect(scene, params, &surface, &bsdf, path);

    /* Go on, or let Russian roulette end the path. */
    if (!next.is_valid)
        return;
    path->throughput *= next.weight;
    path->pdf_w = next.pdf_w;
    path->eta_squared *= next.eta * next.eta;
    path->is_alive = path_survives(params, &sample->sampler, segment, path);
    path->ray = ray_make(surface_origin(&surface, next.wi), next.wi);
    rays->secondary += path->is_alive ? 1u : 0u;
}

/* Advances all paths by a segment and its vertex; gives the number that are alive after it. */
static inline uint path_advance(const Scene* scene, const RenderParams* params, uint segment, Path* paths,
                                       CameraSample* samples, uint count, PixelRays* rays)
{
    /* Draw random numbers. */
    for (uint k = 0; k < count; ++k)
        if (paths[k].is_alive)
            paths[k].numbers = path_numbers(&samples[k].sampler, segment);

    /* Find the next vertices. */
    for (uint k = 0; k < count; ++k)
        if (paths[k].is_alive)
            paths[k].hit = visible_hit(scene, params, &samples[k].sampler, segment, &paths[k].ray);

    /* Handle them. */
    uint alive = 0u;
    for (uint k = 0; k < count; ++k) {
        paths[k].is_connected = false;
        if (paths[k].is_alive)
            path_vertex(scene, params, segment, &paths[k], &samples[k], rays);
        alive += paths[k].is_alive ? 1u : 0u;
    }

    /* Add the light that nothing keeps away. */
    for (uint k = 0; k < count; ++k) {
        if (!paths[k].is_connected)
            continue;
        ++rays->shadow;
        samples[k].radiance += paths[k].connection * visible_share(scene, params, &paths[k].shadow);
    }
    return alive;
}

static CLRT_NOINLINE void path_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples, uint count,
                                        PixelRays* rays)
{
    Path paths[SAMPLES_AT_ONCE];
    for (uint k = 0; k < count; ++k)
        path_begin(&paths[k], &samples[k].ray);
    uint segment = 1u;
    while (path_advance(scene, params, segment, paths, samples, count, rays) != 0u)
        ++segment;
}

#endif
