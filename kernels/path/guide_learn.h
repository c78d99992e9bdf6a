// SPDX-License-Identifier: Apache-2.0
// What a path teaches the cells that it went through: the light that it found behind each of its first
// vertices, as seen from there. Paths from lights teach, too, whence light comes by mirrors and glass that
// paths from the eye hardly find (Jensen 1995). Sums are integers, so they are the same in any order; and
// they hold no more of a path than 2^GUIDE_RECORD_BITS quanta, which keeps outliers from the guide, not from
// the picture.
#ifndef CLRT_PATH_GUIDE_LEARN_H
#define CLRT_PATH_GUIDE_LEARN_H

#include "film/sum.h"
#include "guide.h"
#include "guide_gain.h"

/* Vertices of a path that learn from it: those behind are rarely reached, and their light is small. */
#define GUIDE_VERTICES 12

#if PATH_GUIDE
/* A vertex that will learn from its path. */
typedef struct {
    uint cell, bin; /* of the sampled direction */
    real weight;    /* of radiance behind it: 1 / throughput in front of it */
    real radiance;  /* that the path had found before it went on */
} GuideVertex;

/* What a path carries for its cells. */
typedef struct {
    GuideVertex vertices[GUIDE_VERTICES];
    uint count;
    uint cell; /* of what the path has hit; NO_INDEX: nothing */
    bool teaches;
    bool is_open;  /* the last one's radiance is to be set */
    real expected; /* contribution of the path behind its first vertex that knew; 0: none did */
    GuideGain gain;
} GuidePath;
#else
typedef struct {
    uint unused;
} GuidePath;
#endif

static inline void guide_begin(GuidePath* path)
{
#if PATH_GUIDE
    path->teaches = true;
    path->count = 0u;
    path->is_open = false;
    path->expected = REAL(0.0);
    gain_begin(&path->gain);
#endif
}

/* Whether cells learn from the path of this sample: the same part of the samples of every pixel and
   replicate, and of all pixels' where an epoch has only one of each. */
static inline bool guide_teaches(const RenderParams* params, const Sampler* sampler)
{
    return sampler->index_reversed + sampler->key <= params->guide_learns;
}

static inline void guide_choose(const RenderParams* params, const Sampler* sampler, GuidePath* path)
{
#if PATH_GUIDE
    path->teaches = guide_teaches(params, sampler);
#endif
}

static inline real guide_size(real3 radiance) { return radiance.x + radiance.y + radiance.z; }

/* By what factor the contribution that is expected behind a vertex is smaller than it was behind the path's
   first: what the path is worth (Vorba and Krivanek 2016). 0: not known. */
static inline real guide_worth(const Guide* guide, real3 throughput, GuidePath* path)
{
#if PATH_GUIDE
    if (guide->radiance == REAL(0.0))
        return REAL(0.0);
    const real expected = guide_size(throughput) * guide->radiance;
    if (path->expected == REAL(0.0))
        path->expected = expected;
    return expected / path->expected;
#else
    return REAL(0.0);
#endif
}

/* Notes a vertex and its sampled direction; `throughput`: of the path in front of it. Delta lobes teach
   nothing. */
static inline void guide_note(const Guide* guide, const BsdfSample* next, real3 throughput, GuidePath* path)
{
#if PATH_GUIDE
    path->is_open = false;
    if (!path->teaches || guide->cell == NO_INDEX || next->pdf_w == REAL(0.0))
        return;
    if (path->count == GUIDE_VERTICES)
        return;
    GuideVertex* vertex = &path->vertices[path->count++];
    vertex->cell = guide->cell;
    vertex->bin = guide->bin;
    vertex->weight = REAL(1.0) / guide_size(throughput);
    vertex->radiance = REAL_FAR; /* a path that ends here finds nothing behind */
    path->is_open = true;
#endif
}

/* Finds the cell of what the path has hit (guide_find_cell). */
static inline void guide_approach(const Scene* scene, const RenderParams* params, const Ray* ray,
                                  const Hit* hit, real2 direction_numbers, GuidePath* path)
{
#if PATH_GUIDE
    path->cell = guide_find_cell(scene, params, ray, hit, direction_numbers);
#endif
}

/* A path that serves other pixels counts what it finds from zero behind its second vertex: `radiance` is what
   it has found so far, and its throughput, which was `throughput`, becomes `scale` in every channel. What the
   vertex before learns takes the mean of the channels for each. */
static inline void guide_count_anew(real3 radiance, real3 throughput, real scale, GuidePath* path)
{
#if PATH_GUIDE
    const real unit = guide_size(throughput) / (REAL(3.0) * scale);
    gain_add(guide_size(radiance), &path->gain);
    gain_count_anew(unit, &path->gain);
    if (!path->is_open)
        return;
    GuideVertex* vertex = &path->vertices[path->count - 1u];
    vertex->radiance = (vertex->radiance - guide_size(radiance)) / unit;
    vertex->weight *= unit;
#endif
}

/* The guide of the path's vertex there. */
static inline Guide guide_of(const Scene* scene, const Bsdf* bsdf, const GuidePath* path)
{
#if PATH_GUIDE
    return guide_at(scene, path->cell, path->gain.ratio, bsdf);
#else
    return guide_none();
#endif
}

/* The path comes to its next vertex; `radiance`: what it has found before. */
static inline void guide_arrive(real3 radiance, GuidePath* path)
{
#if PATH_GUIDE
    if (path->is_open)
        path->vertices[path->count - 1u].radiance = guide_size(radiance);
    gain_add(guide_size(radiance), &path->gain);
    gain_advance(&path->gain);
#endif
}

/* The path goes on in the guide's direction. */
static inline void guide_leave(const Guide* guide, GuidePath* path)
{
#if PATH_GUIDE
    gain_leave(guide->ratio, &path->gain);
#endif
}

/* The path has survived Russian roulette; without the guide it would have gone by `size`. */
static inline void guide_survive(real survival, real size, GuidePath* path)
{
#if PATH_GUIDE
    gain_survive(survival, size, &path->gain);
#endif
}

#if PATH_GUIDE
/* Adds a record of light to the sums of a cell. */
static inline void guide_record(global long* sums, uint bin, real quanta)
{
    if (quanta >= REAL(1.0))
        sum_add_modulo(sums + bin, (1ul << GUIDE_SUM_BITS) +
                                       (ulong)fmin(quanta, (real)(1u << GUIDE_RECORD_BITS)));
}

/* Adds what a finished path has found to the sums of its vertices; returns what the guide gains by it. */
static inline real guide_learn(const Scene* scene, const RenderParams* params, real3 radiance,
                               GuidePath* path)
{
    gain_add(guide_size(radiance), &path->gain);
    const real whole = guide_size(radiance);
    for (uint i = 0; i < path->count; ++i) {
        const GuideVertex* vertex = &path->vertices[i];
        global long* sums = scene->guide.sums + (ulong)vertex->cell * GUIDE_SUMS;
        sum_add_modulo(sums + GUIDE_SUM_VERTICES, 1ul);
        guide_record(sums, vertex->bin,
                     (whole - vertex->radiance) * vertex->weight * (real)params->inverse_quantum);
    }
    return path->gain.gain;
}

/* Adds the power that a light path brings along a ray to the cell of what it has hit: as radiance that a
   vertex of its own there scatters to the eye. */
static CLRT_NOINLINE void guide_learn_light(const Scene* scene, const RenderParams* params, const Ray* ray,
                                            const Hit* hit, real3 power)
{
    Guide guide = guide_none();
    guide.cell = guide_find_cell(scene, params, ray, hit, (real2)(REAL(0.0)));
    guide_pdf_w(scene, &guide, -ray->direction, &guide.bin);
    const real side = REAL(2.0) * (real)params->scene_extent;
    const real density = (real)scene->guide.cells[guide.cell].light / (side * side);
    guide_record(scene->guide.sums + (ulong)guide.cell * GUIDE_SUMS, guide.bin,
                 guide_size(power) * density * (real)params->inverse_quantum);
}
#endif

#endif
