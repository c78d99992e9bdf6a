// SPDX-License-Identifier: Apache-2.0
// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997): simulates
// L(D|G|S)*E. One path a sample; a segment is one ray, so a path of max_depth segments scatters max_depth - 1 times.
// The paths of a few samples advance together: all trace a segment, all handle their vertex, all test their shadow ray.
#ifndef CLRT_INTEGRATORS_PATH_H
#define CLRT_INTEGRATORS_PATH_H

#include "film/film.h"
#include "lights/lights.h"
#include "path/filter.h"
#include "path/layers.h"
#include "path/nan.h"
#include "path/visibility.h"
#include "trace/vertex.h"
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

/* A path on its way. */
typedef struct {
    Ray ray;               /* the segment to trace */
    Hit hit;               /* where it ended */
    PathNumbers numbers;   /* of the vertex there */
    real3 from;            /* whence the surface that it left looked at lights; unused for camera rays */
    bool has_crossed_curved; /* it did not start there but at the plane below */
    real3 throughput;      /* of the path so far: product of BSDF times cosine over pdf */
    real eta_squared;      /* product of the squared index ratios crossed */
    real pdf_w;            /* of the ray's direction; 0 for camera rays and delta lobes */
    Ray shadow;            /* from the vertex to a light, */
    real3 connection;      /* and what arrives if nothing is in between */
    real3 watched;         /* sum of directions and normals, for NaNs among them */
    uint state;            /* of the automaton, behind all vertices so far */
    LayerPath layers;
    bool is_alive, is_connected;
} Path;

static inline void path_begin(Path* path, const Ray* ray)
{
    path->ray = *ray;
    path->from = ray->origin;
    path->has_crossed_curved = false;
    path->throughput = (real3)(REAL(1.0));
    path->watched = (real3)(REAL(0.0));
    path->eta_squared = REAL(1.0);
    path->pdf_w = REAL(0.0);
    path->state = STATE_START;
    layers_begin_path(&path->layers);
    path->is_alive = true;
}

/* The kinds of light whose emission the path may add. */
static inline uint path_accepted(const Path* path)
{
    return HAS(EFFECT_PATH_FILTER) ? AUTOMATON_STATES[path->state] & STATE_KINDS_MASK : KINDS_ALL;
}

/* Emission of the surface that was hit, weighted against the light sampling at the vertex before that could have found it. */
static inline real3 path_emission(const Scene* scene, const RenderParams* params, const Surface* surface, const Path* path,
                                  real3 wo)
{
    const real3 emitted = material_emitted(scene, surface);
    TRACE_VECTOR(scene, TRACE_EMITTED, emitted);
    const real pdf_w = path->pdf_w;
    if (pdf_w == REAL(0.0))
        return emitted;
    const real t = path->hit.t;
    const real point_pdf_w = HAS(EFFECT_SMOOTH_NORMALS) && HAS(EFFECT_ROUGH_REFRACTION) && path->has_crossed_curved
                                 ? emitter_crossed_pdf_w(scene, surface, path->from, t, wo)
                                 : emitter_hit_pdf_w(scene, surface, path->from, t, wo);
    const real light_pdf_w = (real)params->choose_emitter * point_pdf_w;
    TRACE_NUMBER(scene, TRACE_LIGHT_PDF, light_pdf_w);
    TRACE_NUMBER(scene, TRACE_LIGHT_WEIGHT, mis_weight(pdf_w, light_pdf_w));
    return emitted * mis_weight(pdf_w, light_pdf_w);
}

/* Adds light of one kind that the path has met to the layers. */
static inline void path_add_layers(const Path* path, uint kind, real3 radiance, CameraSample* sample)
{
#if PATH_LAYERS > 0
    layers_add(path->state, kind, path->throughput * path->layers.share * radiance, &sample->layers);
#endif
}

/* The same connection for the layers, class by class of the event; `factor` is all that arrives over the BSDF's value. */
static inline void path_connect_layers(const Bsdf* bsdf, const AutomatonStep* step, const LightSample* light,
                                       real3 factor, Path* path)
{
#if PATH_LAYERS > 0
    path->layers.kind = light->kind;
    path->layers.matte_state = step->matte;
    path->layers.glossy_state = step->glossy;
    const real3 shared = factor * path->layers.share;
    path->layers.matte = path->layers.glossy = (real3)(REAL(0.0));
    if (filter_is_ambiguous(step, bsdf)) {
        path->layers.matte = shared * filter_matte_part(bsdf, light->wi);
        path->layers.glossy = shared * filter_glossy_part(bsdf, light->wi);
    } else if (bsdf->lobes & LOBE_MATTE)
        path->layers.matte = path->connection * path->layers.share;
    else
        path->layers.glossy = path->connection * path->layers.share;
#endif
}

/* Adds the share of the connection that arrives. */
static inline void path_add_connection(const Path* path, real share, CameraSample* sample)
{
    sample->radiance += path->connection * share;
#if PATH_LAYERS > 0
    layers_add(path->layers.matte_state, path->layers.kind, path->layers.matte * share, &sample->layers);
    layers_add(path->layers.glossy_state, path->layers.kind, path->layers.glossy * share, &sample->layers);
#endif
}

/* Samples a light and prepares the shadow ray to it; its contribution is weighted against BSDF sampling. */
static inline void path_connect(const Scene* scene, const RenderParams* params, const Surface* surface,
                                const Bsdf* bsdf, const AutomatonStep* step, Path* path)
{
    const LightSample light =
        lights_sample(scene, params, surface, bsdf->frame.z, path->numbers.light, path->numbers.alias);
    TRACE_LIGHT(scene, &light);
    nan_watch(scene, light.wi, &path->watched);
    if (light.pdf_w == REAL(0.0))
        return;
    BsdfValue eval = bsdf_eval(bsdf, light.wi);
    if (HAS(EFFECT_PATH_FILTER))
        eval.value = filter_value(step, bsdf, light.wi, light.kind, eval.value);
    const real3 arriving = eval.value * light.radiance;
    TRACE_VECTOR(scene, TRACE_LIGHT_BSDF, eval.value);
    TRACE_NUMBER(scene, TRACE_LIGHT_BSDF_PDF, eval.pdf_w);
    TRACE_CHOICE(scene, TRACE_CONNECTS, vector_is_black(arriving) ? 0u : 1u);
    if (vector_is_black(arriving))
        return;
    const real weight = light.is_delta ? REAL(1.0) : mis_weight(light.pdf_w, eval.pdf_w);
    path->connection = path->throughput * arriving * (weight / light.pdf_w);
    TRACE_NUMBER(scene, TRACE_LIGHT_WEIGHT, weight);
    TRACE_VECTOR(scene, TRACE_CONNECTION, path->connection);
    path->shadow = light_shadow_ray(surface, &light);
    path->is_connected = true;
    path_connect_layers(bsdf, step, &light, path->throughput * light.radiance * (weight / light.pdf_w), path);
}

/* Moves the automaton along a sampled direction; false if a ray would find nothing there. */
static inline bool path_follow(const Sampler* sampler, uint segment, const Bsdf* bsdf, const AutomatonStep* step,
                               const BsdfSample* next, Path* path)
{
    if (!filter_is_ambiguous(step, bsdf) || next->pdf_w == REAL(0.0)) {
        path->state = filter_state(step, bsdf, next);
        return automaton_continues(path->state);
    }
    real3 share;
    const real u = sampler_number(sampler, segment, SAMPLE_CLASS);
    const bool is_matte = filter_choose_matte(step, bsdf, next->wi, u, &share);
    if (automaton_splits(path->state))
        path->throughput *= share;
#if PATH_LAYERS > 0
    else
        path->layers.share *= share;
#endif
    path->state = is_matte ? step->matte : step->glossy;
    return true;
}

/* Ends paths of small weight without bias; the throughput of a survivor grows accordingly. The index ratios crossed so far
   are taken out: light inside glass is not lost, only compressed. */
static inline bool path_survives(const Scene* scene, const RenderParams* params, const Sampler* sampler, uint segment,
                                 Path* path)
{
    if (segment < params->roulette_depth)
        return true;
    const real survival =
        clamp(vector_max_component(path->throughput) / path->eta_squared, PATH_SMALLEST_SURVIVAL, REAL(1.0));
    const bool survives = !(sampler_number(sampler, segment, SAMPLE_ROULETTE) >= survival);
    TRACE_NUMBER(scene, TRACE_SURVIVAL, survival);
    TRACE_CHOICE(scene, TRACE_SURVIVES, survives ? 1u : 0u);
    if (!survives)
        return false;
    path->throughput /= survival;
    return true;
}

/* Counts a path that would have gone on from here but for max_depth: it has a direction and survives roulette, by the same
   random numbers as a longer path. What it would have met next counts by the weight that it has there. With --paths, only
   the lobes that max_depth closes count. */
static CLRT_NOINLINE void path_cut(const Scene* scene, const RenderParams* params, const Sampler* sampler, uint segment,
                                   const Bsdf* whole, const Path* path, PixelRays* rays)
{
    Bsdf bsdf = *whole;
    Path longer = *path;
    if (HAS(EFFECT_PATH_FILTER)) {
        const AutomatonStep open = automaton_step(params, path->state, segment);
        const AutomatonStep closed = automaton_cut_step(&open, path->state);
        filter_lobes(&closed, &bsdf);
    }
    if (bsdf.lobes == 0u)
        return;
    const BsdfSample next = bsdf_sample(&bsdf, longer.numbers.lobe, longer.numbers.direction);
    if (!next.is_valid)
        return;
    longer.throughput *= next.weight;
    longer.eta_squared *= next.eta * next.eta;
    if (!path_survives(scene, params, sampler, segment, &longer))
        return;
    TRACE_CHOICE(scene, TRACE_CUT, 1u);
    film_count_cut(longer.throughput, rays);
}

/* Adds the light from outside the scene. */
static inline void path_escape(const Scene* scene, const RenderParams* params, uint segment, const Path* path,
                               CameraSample* sample)
{
    if (nan_carry(scene, nan_of_miss(&path->hit), &sample->radiance))
        return;
    const real3 direction = path->ray.direction;
    const real pdf_w = path->pdf_w;
    const real3 sky = lights_outside(scene, params, segment, direction, pdf_w, path_accepted(path));
    sample->radiance += path->throughput * sky;
    TRACE_VECTOR(scene, TRACE_SKY, sky);
    TRACE_VECTOR(scene, TRACE_ADDED, path->throughput * sky);
    if (PATH_LAYERS == 0)
        return;
    path_add_layers(path, KIND_SKY, lights_outside(scene, params, segment, direction, pdf_w, KIND_SKY), sample);
    path_add_layers(path, KIND_SUN, lights_outside(scene, params, segment, direction, pdf_w, KIND_SUN), sample);
}

/* Handles the vertex at the end of a segment: adds its emission, connects it to a light, chooses the next segment or ends
   the path. */
static CLRT_NOINLINE void path_vertex(const Scene* scene, const RenderParams* params, uint segment, Path* path,
                                      CameraSample* sample, PixelRays* rays)
{
    const real3 wo = -path->ray.direction;
    path->is_alive = false;
    TRACE_HIT(scene, segment, 0u, &path->ray, &path->hit);
    if (path->hit.triangle == NO_INDEX) {
        rays->missed += segment == 1u ? 1u : 0u;
        path_escape(scene, params, segment, path, sample);
        return;
    }
    const Surface surface = visible_surface(scene, params, &path->ray, &path->hit);
    TRACE_SURFACE(scene, &surface);

    /* Add what it emits. */
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX && (path_accepted(path) & KIND_AREA)) {
        const real3 emitted = path_emission(scene, params, &surface, path, wo);
        sample->radiance += path->throughput * emitted;
        TRACE_VECTOR(scene, TRACE_ADDED, path->throughput * emitted);
        path_add_layers(path, KIND_AREA, emitted, sample);
    }
    Bsdf bsdf = material_bsdf(scene, &surface, wo);
    if (segment >= params->max_depth) {
        path_cut(scene, params, &sample->sampler, segment, &bsdf, path, rays);
        return;
    }
    TRACE_VECTOR(scene, TRACE_NORMAL_S, bsdf.frame.z);
    AutomatonStep step;
    bool continues = true;
    if (HAS(EFFECT_PATH_FILTER)) {
        step = automaton_step(params, path->state, segment);
        if (automaton_is_cut(&step, path->state))
            path_cut(scene, params, &sample->sampler, segment, &bsdf, path, rays);
        filter_lobes(&step, &bsdf);
        continues = filter_continues(&step, &bsdf);
    }
    if (bsdf.lobes == 0u)
        return;

    /* Choose the next direction, connect to a light. */
    const BsdfSample next = bsdf_sample(&bsdf, path->numbers.lobe, path->numbers.direction);
    TRACE_DIRECTION(scene, &next, continues);
    nan_watch(scene, surface.normal_g + bsdf.wo + next.wi, &path->watched);
    if (bsdf_has_smooth_lobe(&bsdf) && (!HAS(EFFECT_PATH_FILTER) || filter_wants_light(&step, &bsdf)))
        path_connect(scene, params, &surface, &bsdf, &step, path);

    /* Go on, or let Russian roulette end the path. */
    if (!next.is_valid || !continues)
        return;
    path->throughput *= next.weight;
    if (HAS(EFFECT_PATH_FILTER)) {
        if (!path_follow(&sample->sampler, segment, &bsdf, &step, &next, path))
            return;
        TRACE_CHOICE(scene, TRACE_STATE, path->state);
    }
    TRACE_VECTOR(scene, TRACE_THROUGHPUT, path->throughput);
    path->pdf_w = next.pdf_w;
    path->eta_squared *= next.eta * next.eta;
    path->is_alive = path_survives(scene, params, &sample->sampler, segment, path);
    path->ray = surface_ray(&surface, next.reflects, next.wi);
    path->from = surface_lifted(&surface);
    path->has_crossed_curved = surface.is_curved && !next.reflects;
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
        const real share = visible_share(scene, params, &paths[k].shadow);
        path_add_connection(&paths[k], share, &samples[k]);
        TRACE_VISIBILITY(scene, share);
        TRACE_VECTOR(scene, TRACE_ADDED, paths[k].connection * share);
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
    while (path_advance(scene, params, segment, paths, samples, count, rays) != 0u && segment < PATH_SEGMENTS)
        ++segment;
    for (uint k = 0; k < count; ++k)
        nan_carry(scene, nan_of_vector(paths[k].throughput + paths[k].watched), &samples[k].radiance);
}

#endif
