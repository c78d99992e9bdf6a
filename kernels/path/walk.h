// SPDX-License-Identifier: Apache-2.0
// A path on its way from the eye: what it carries from vertex to vertex, and how it goes on.
#ifndef CLRT_PATH_WALK_H
#define CLRT_PATH_WALK_H

#include "filter.h"
#include "geometry/ray_cone.h"
#include "guide_learn.h"
#include "layers.h"
#include "numbers.h"
#include "roulette.h"
#include "sky.h"
#include "slab_bend.h"
#include "vertex.h"

/* 1 where a path's first vertex may take several light samples (light_samples.h). */
#if defined(LIGHT_SAMPLES_ARE_SPLIT) && (CLRT_EFFECTS & EFFECT_LIGHT_TREE)
#define SPLITS_LIGHT 1
#else
#define SPLITS_LIGHT 0
#endif

/* A path on its way. */
typedef struct {
    Ray ray;                 /* the segment to trace */
    Hit hit;                 /* where it ended */
    PathNumbers numbers;     /* of the vertex there */
    SkySample sky;           /* drawn for it, where light_is_drawn */
    LightView view;          /* whence the surface that it left looked at lights; unused for camera rays and
                                delta lobes */
    real lift;               /* surface_lift of the ray */
    real3 throughput;        /* of the path so far: product of BSDF times cosine over pdf */
    real eta_squared;        /* product of the squared index ratios crossed */
    real pdf_w;              /* of the ray's direction over the light samples taken where it started; 0 for
                                camera rays and delta lobes */
    Ray shadow;              /* from the vertex to a light, */
    real3 connection;        /* and what arrives if nothing is in between */
#if PATH_REUSE
    real3 light_wi; /* the light's direction */
#endif
    real3 watched;           /* sum of directions and normals, for NaNs among them */
    uint state;              /* of the automaton, behind all vertices so far */
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    uint solid; /* that the ray goes through from where it left; NO_INDEX: none is known there */
#endif
#if HAS_SLABS
    SlabChain slabs;           /* since its last lobe with a density, */
    real3 before_slabs;        /* its direction there, */
    real pdf_w_before_slabs;   /* and that density; `view` is kept meanwhile */
    bool is_behind_slabs;      /* it has left the scene through some */
    real connects_with_others; /* weight of the connection beside light paths over that without; 0: it cannot
                                  cross slabs, */
    uint facets;               /* of which it has crossed so many */
#endif
#if LAMPS_BEHIND_SLABS
    real3 slab_origin; /* where it began its way to slabs, */
    real3 slab_facet;  /* and the facet's normal there, towards them */
#endif
    LayerPath layers;
    GuidePath guided;
    bool is_alive, is_connected;
#if SPLITS_LIGHT
    uint light_samples_log; /* of the number that its next vertex takes */
#endif
} Path;

/* How many light samples the next vertex takes, and the logarithm. */
static inline uint path_light_samples_log(const Path* path)
{
#if SPLITS_LIGHT
    return path->light_samples_log;
#else
    return 0u;
#endif
}

static inline uint path_light_samples(const Path* path)
{
    return 1u << path_light_samples_log(path);
}

static inline void path_begin(const Scene* scene, Path* path, const Ray* ray)
{
    path->ray = *ray;
    path->view.position = ray->origin;
    path->view.normal = (real3)(REAL(0.0));
    path->lift = REAL(0.0);
    path->throughput = (real3)(REAL(1.0));
    path->watched = (real3)(REAL(0.0));
    path->eta_squared = REAL(1.0);
    path->pdf_w = REAL(0.0);
    path->state = automaton_start(scene);
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    path->solid = NO_INDEX;
#endif
#if HAS_SLABS
    slab_end(&path->slabs);
#endif
#if SPLITS_LIGHT
    path->light_samples_log = 0u;
#endif
    layers_begin_path(&path->layers);
    guide_begin(&path->guided);
    path->is_alive = true;
}

/* The kinds of light whose emission the path may add. */
static inline uint path_accepted(const Path* path)
{
    return automaton_accepted(path->state);
}

/* Absorbs what a solid takes on the segment that has met a surface, 0: nothing. */
static inline void path_absorb(const Scene* scene, const Surface* met, Path* path)
{
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    if (met != 0)
        solid_arrive(scene, path->solid, met, path->hit.t, &path->throughput);
    else
        solid_escape(scene, path->solid, &path->throughput);
#endif
}

/* Adds light of one kind that the path has met to the layers. */
static inline void path_add_layers(const Scene* scene, const Path* path, uint kind, real3 radiance,
                                   LayerSums* layers)
{
#if PATH_LAYERS > 0
    layers_add(scene, path->state, kind, path->throughput * path->layers.share * radiance, layers);
#endif
}

/* Samples the next direction. `continues`: whether a ray by any lobe can find light (filter_continues). */
static inline BsdfSample path_sample(const Scene* scene, const Surface* surface, const Bsdf* bsdf,
                                     bool continues, Guide* guide, Path* path)
{
    const BsdfSample next = guide_sample(scene, bsdf, path->numbers.lobe, path->numbers.direction, guide);
    guide_note(guide, &next, path->throughput, &path->guided);
    TRACE_CHOICE(scene, TRACE_LOBE, next.lobe);
    TRACE_VECTOR(scene, TRACE_WI, next.wi);
    TRACE_VECTOR(scene, TRACE_WEIGHT, next.weight);
    TRACE_NUMBER(scene, TRACE_PDF, next.pdf_w);
    TRACE_NUMBER(scene, TRACE_ETA, next.eta);
    TRACE_CHOICE(scene, TRACE_CONTINUES, next.is_valid && continues ? 1u : 0u);
    nan_watch(scene, surface->normal_g + bsdf->wo + next.wi, &path->watched);
    return next;
}

/* Moves the automaton along a sampled direction; false if a ray would find nothing there. */
static inline bool path_follow(const Scene* scene, const Sampler* sampler, uint segment, const Bsdf* bsdf,
                               const AutomatonStep* step, const BsdfSample* next, Path* path)
{
    if (!filter_is_ambiguous(step, bsdf) || next->pdf_w == REAL(0.0)) {
        path->state = step->next[filter_letter(bsdf, next)];
        if (!automaton_continues(path->state))
            return false;
    } else {
        real3 share;
        const real u = sampler_number(sampler, segment, SAMPLE_CLASS);
        const uint letter = filter_choose_letter(step, bsdf, next->wi, u, &share);
        if (automaton_splits(path->state))
            path->throughput *= share;
#if PATH_LAYERS > 0
        else
            path->layers.share *= share;
#endif
        path->state = step->next[letter];
    }
    TRACE_CHOICE(scene, TRACE_STATE, path->state & STATE_NUMBER_MASK);
    return true;
}

/* Ends paths of small weight without bias; the throughput of a survivor grows accordingly. `worth` is what a
   guide says of the path, 0 where none does; else its throughput tells, the index ratios crossed so far taken
   out: light inside glass is not lost, only compressed. */
static inline bool path_survives(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                 uint segment, real worth, Path* path)
{
    if (segment < params->roulette_depth)
        return true;
    const real size = vector_max_component(path->throughput) / path->eta_squared;
    const real survival = roulette_survival(worth > REAL(0.0) ? worth : size);
    const bool survives = !(sampler_number(sampler, segment, SAMPLE_ROULETTE) >= survival);
    TRACE_NUMBER(scene, TRACE_SURVIVAL, survival);
    TRACE_CHOICE(scene, TRACE_SURVIVES, survives ? 1u : 0u);
    if (!survives)
        return false;
    path->throughput /= survival;
    guide_survive(survival, size, &path->guided);
    return true;
}

/* Notes whence a path looks at lights that leaves a surface, and what it may cross. */
static inline void path_look(const Scene* scene, const Surface* surface, const Bsdf* bsdf,
                             const BsdfSample* next, Path* path)
{
#if HAS_SLABS
    if (next->pdf_w == REAL(0.0)) {
        slab_leave(scene, surface, next->reflects, next->eta, &path->slabs);
        return;
    }
    slab_begin(&path->slabs);
    if (solid_beside(scene, surface, next->reflects) != NO_INDEX)
        slab_end(&path->slabs);
    path->before_slabs = next->wi;
    path->pdf_w_before_slabs = path->pdf_w;
#endif
#if LAMPS_BEHIND_SLABS
    path->slab_origin = path->ray.origin;
    path->slab_facet = next->reflects ? surface->normal_g : -surface->normal_g;
    if (!slab_can_begin(surface, next->reflects))
        path->slab_facet = (real3)(REAL(0.0)); /* slab_is_ahead of nothing */
#endif
    path->view = lights_view(surface, bsdf_light_normal(bsdf));
}

/* A path that leaves the scene behind slabs counts as one from the vertex before them. */
static inline void path_skip_slabs(const RenderParams* params, Path* path)
{
#if HAS_SLABS
    path->is_behind_slabs = slab_is_behind(params, &path->slabs, path->before_slabs, path->ray.direction);
    if (!path->is_behind_slabs)
        return;
    path->pdf_w = path->pdf_w_before_slabs;
#endif
}

/* Leaves a vertex in a sampled direction, unless nothing can be found there or Russian roulette ends the
   path. */
static inline void path_leave(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                              uint segment, const Surface* surface, const Bsdf* bsdf,
                              const AutomatonStep* step, const Guide* guide, const BsdfSample* next,
                              Path* path)
{
    const real worth = guide_worth(guide, path->throughput, &path->guided);
    path->throughput *= next->weight;
    if (HAS(EFFECT_PATH_FILTER) && !path_follow(scene, sampler, segment, bsdf, step, next, path))
        return;
    TRACE_VECTOR(scene, TRACE_THROUGHPUT, path->throughput);
    path->pdf_w = next->pdf_w / (real)path_light_samples(path);
    path->eta_squared *= next->eta * next->eta;
    guide_leave(guide, &path->guided);
    path->is_alive = path_survives(scene, params, sampler, segment, worth, path);
    path->ray = surface_ray(surface, next->reflects, next->wi);
    ray_cone_scatter(params, sampler, next->pdf_w, &path->ray);
    dispersion_leave(dispersion_splits(bsdf, next->reflects), &path->ray);
    path_look(scene, surface, bsdf, next, path);
#if SPLITS_LIGHT
    path->light_samples_log = next->pdf_w == REAL(0.0) ? path->light_samples_log : 0u;
#endif
    path->lift = surface_lift(surface, next->reflects, next->wi);
#if CLRT_EFFECTS & EFFECT_ATTENUATION
    path->solid = solid_beside(scene, surface, next->reflects);
#endif
}

#endif
