// SPDX-License-Identifier: Apache-2.0
// The vertices of a light path that a path from the eye is connected to: kept in private memory, 48 bytes
// each in single precision. Surface and BSDF are made again where a vertex is connected. Of a path that
// scatters more often than there is room, a random choice is kept, all vertices alike (reservoir sampling,
// Vitter 1985), and each of them counts for more.
#ifndef CLRT_PATH_LIGHT_VERTICES_H
#define CLRT_PATH_LIGHT_VERTICES_H

#include "film/moments.h"
#include "splat_weight.h"

/* Of a path, at most: a literal of the program (src/render/kernels.h). */
#ifndef BDPT_VERTICES
#define BDPT_VERTICES 30
#endif

/* The first bit of a kept vertex's wave, above all segments. */
#define KEPT_WAVE 24u

/* A vertex that scatters other than as a delta function. */
typedef struct {
    uint triangle;
#if CLRT_EFFECTS & EFFECT_INSTANCES
    uint instance;
#endif
#if CLRT_EFFECTS & EFFECT_NESTED
    Nest nest;            /* of the ray that has met it */
#endif
    uint segment;         /* of the light path up to the vertex, from 1; from KEPT_WAVE on, that ray's wave */
    real b1, b2;          /* barycentric weights of corners 1 and 2 */
    real wo[3];           /* unit, to where the light has come from */
    real power[3];        /* that arrives: emitted, times the throughput */
    SplatWeights weights; /* of the path up to the vertex */
#if FILM_MOMENTS
    SplatWeights alone; /* the same without inner connections */
    real survived, size; /* the probability of surviving roulette up to here, and the throughput without */
#endif
} KeptVertex;

/* Those of one path, from the light on. */
typedef struct {
    KeptVertex at[BDPT_VERTICES];
    uint count;
    uint met; /* vertices of the path, kept or not */
} LightVertices;

static inline void light_vertices_begin(LightVertices* kept) { kept->count = kept->met = 0u; }

/* How many vertices of the path a kept one counts for. */
static inline real light_vertices_share(const LightVertices* kept)
{
    return (real)kept->met / (real)kept->count;
}

/* Where the path's next vertex is kept, behind the others; 0 where it is not. */
static inline KeptVertex* light_vertices_next(const Sampler* sampler, uint segment, LightVertices* kept)
{
    ++kept->met;
    if (kept->count < BDPT_VERTICES)
        return &kept->at[kept->count++];
    const uint leaving = warp_index(sampler_word(sampler, segment, SAMPLE_PARTNER), kept->met);
    if (leaving >= BDPT_VERTICES)
        return 0;
    for (uint i = leaving; i + 1u < BDPT_VERTICES; ++i)
        kept->at[i] = kept->at[i + 1u];
    return &kept->at[BDPT_VERTICES - 1u];
}

/* Keeps the vertex at the end of a ray, all but its weights, and tells where; 0 where it is not kept. `kept`
   may be 0. `sampler`: of the light path. */
static inline KeptVertex* light_vertices_keep(const Sampler* sampler, uint segment, const Hit* hit,
                                              const Ray* ray, real3 power, LightVertices* kept)
{
    if (!INNER_CONNECTIONS || kept == 0)
        return 0;
    KeptVertex* vertex = light_vertices_next(sampler, segment, kept);
    if (vertex == 0)
        return 0;
    vertex->triangle = hit->triangle;
#if CLRT_EFFECTS & EFFECT_INSTANCES
    vertex->instance = hit->instance;
#endif
#if CLRT_EFFECTS & EFFECT_NESTED
    vertex->nest = ray->nest;
#endif
    vertex->segment = segment | ray_wave(ray) << KEPT_WAVE;
    vertex->b1 = hit->b1;
    vertex->b2 = hit->b2;
    vstore3(-ray->direction, 0, vertex->wo);
    vstore3(power, 0, vertex->power);
    return vertex;
}

/* Segments of the light path up to a kept vertex. */
static inline uint light_vertices_segment(const KeptVertex* kept)
{
    return kept->segment & ((1u << KEPT_WAVE) - 1u);
}

/* The ray that has met a kept vertex, but for its origin. */
static inline Ray light_vertices_ray(const KeptVertex* kept, real time)
{
    Ray ray = ray_make((real3)(REAL(0.0)), -vload3(0, kept->wo), time);
    ray_set_wave(kept->segment >> KEPT_WAVE, &ray);
#if CLRT_EFFECTS & EFFECT_NESTED
    ray.nest = kept->nest;
#endif
    return ray;
}

/* How many vertices are at most `segments` segments from the light. */
static inline uint light_vertices_within(const LightVertices* kept, uint segments)
{
    uint count = kept->count;
    while (count > 0u && light_vertices_segment(&kept->at[count - 1u]) > segments)
        --count;
    return count;
}

/* The hit of a kept vertex, but for its distance. */
static inline Hit light_vertices_hit(const KeptVertex* kept)
{
    Hit hit = hit_none(REAL(0.0));
    hit.triangle = kept->triangle;
#if CLRT_EFFECTS & EFFECT_INSTANCES
    hit.instance = kept->instance;
#endif
    hit.b1 = kept->b1;
    hit.b2 = kept->b2;
    return hit;
}

#endif
