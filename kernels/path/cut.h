// SPDX-License-Identifier: Apache-2.0
// What max_depth ends: paths that would have gone on are counted by their weight, so that the picture's
// report knows a bound of the light that it lacks.
#ifndef CLRT_PATH_CUT_H
#define CLRT_PATH_CUT_H

#include "film/film.h"
#include "walk.h"

/* Counts a path that would have gone on from here but for max_depth: it has a direction and survives
   roulette, by the same random numbers as a longer path. What it would have met next counts by the weight
   that it has there. With --paths, only the lobes that max_depth closes count. */
static CLRT_NOINLINE void path_cut(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                                   uint segment, const Surface* surface, const Path* path, PixelRays* rays)
{
    Bsdf bsdf;
    material_set_bsdf_apart(scene, surface, -path->ray.direction, TRANSPORT_RADIANCE, &bsdf);
    Path longer = *path;
    if (HAS(EFFECT_PATH_FILTER)) {
        const AutomatonStep open = automaton_step(scene, params, path->state, segment);
        const AutomatonStep closed = automaton_cut_step(scene, &open, path->state);
        filter_lobes(&closed, &bsdf);
    }
    if (bsdf.lobes == 0u)
        return;
    const BsdfSample next = bsdf_sample(&bsdf, longer.numbers.lobe, longer.numbers.direction);
    if (!next.is_valid)
        return;
    longer.throughput *= next.weight;
    longer.eta_squared *= next.eta * next.eta;
    if (!path_survives(scene, params, sampler, segment, REAL(0.0), &longer))
        return;
    TRACE_CHOICE(scene, TRACE_CUT, 1u);
    film_count_cut(longer.throughput, rays);
}

/* Leaves the lobes by which the automaton lets the path go on; true if a ray by one of them can find
   anything. What only max_depth closes is cut. */
static inline bool path_filter(const Scene* scene, const RenderParams* params, const Sampler* sampler,
                               uint segment, const Surface* surface, const Path* path,
                               AutomatonStep* step, Bsdf* bsdf, PixelRays* rays)
{
    if (!HAS(EFFECT_PATH_FILTER))
        return true;
    *step = automaton_step(scene, params, path->state, segment);
    if (automaton_is_cut(scene, step, path->state))
        path_cut(scene, params, sampler, segment, surface, path, rays);
    filter_lobes(step, bsdf);
    return filter_continues(step, bsdf);
}

#endif
