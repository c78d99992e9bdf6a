// SPDX-License-Identifier: Apache-2.0
// Layers of paths: the picture's light, added again to each layer whose expression a path matches. A layer
// has one sum a pixel behind the picture's replicates in the film. The picture does not depend on them: where
// only a layer must know whether an event was matte or glossy, the class is chosen for the layers alone, and
// what it weighs is carried beside the throughput.
#ifndef CLRT_PATH_LAYERS_H
#define CLRT_PATH_LAYERS_H

#include "automaton.h"
#include "film/film.h"

#if PATH_LAYERS > 0
/* What a sample has gathered. */
typedef struct {
    real3 radiance[PATH_LAYERS];
} LayerSums;

/* What a path carries: its weight beside the throughput, and a connection to a light by class of the last
   event. */
typedef struct {
    real3 share;
    real3 matte, glossy; /* what arrives if nothing is in between */
    uint matte_state, glossy_state, kind;
} LayerPath;
#else
typedef struct {
    uint unused;
} LayerSums, LayerPath;
#endif

static inline void layers_begin(LayerSums* sums)
{
#if PATH_LAYERS > 0
    for (uint i = 0; i < PATH_LAYERS; ++i)
        sums->radiance[i] = (real3)(REAL(0.0));
#endif
}

static inline void layers_begin_path(LayerPath* path)
{
#if PATH_LAYERS > 0
    path->share = (real3)(REAL(1.0));
#endif
}

/* Adds light of one kind that ends a path in a state. */
static inline void layers_add(const Scene* scene, uint state, uint kind, real3 radiance, LayerSums* sums)
{
#if PATH_LAYERS > 0
    const uint kinds = scene->path_states[state & STATE_NUMBER_MASK].layers;
    for (uint i = 0; i < PATH_LAYERS; ++i)
        if ((kinds >> (LAYER_KINDS_BITS * i)) & kind)
            sums->radiance[i] += radiance;
#endif
}

/* The three sums of a slot in a layer. */
static inline global long* layers_film_sums(const RenderParams* params, global long* film, uint slot,
                                            uint layer)
{
    return film_plane_sums(params, film, slot, params->film_replicates + layer);
}

/* Adds a sample to the film; the number of layers whose value is bad and left out. */
static inline uint layers_film_add(const RenderParams* params, global long* film, uint slot,
                                   const Sampler* sampler, const LayerSums* sums)
{
    uint bad = 0u;
#if PATH_LAYERS > 0
    for (uint i = 0; i < PATH_LAYERS; ++i)
        if (film_fault(params, sums->radiance[i]) != COUNT_WORDS ||
            !film_add(params, layers_film_sums(params, film, slot, i), sampler, sums->radiance[i]))
            ++bad;
#endif
    return bad;
}

#endif
