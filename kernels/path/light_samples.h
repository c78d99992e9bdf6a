// SPDX-License-Identifier: Apache-2.0
// Several light samples at a path's first vertex (splitting, Veach 1997, section 10.4): which of many lights
// is sampled, and whether it is seen, is most of the noise there, and what comes behind is not worth a path
// of its own. All vertices count as first until one is left by a lobe with a density.
//
// The samples of a vertex are its point of the net, shifted digit by digit to a Hammersley set: even among
// themselves, and every one of them a net of its own over the samples of a pixel. Multiple importance
// sampling counts them as one technique with so many times the density.
#ifndef CLRT_PATH_LIGHT_SAMPLES_H
#define CLRT_PATH_LIGHT_SAMPLES_H

#include "connect.h"

/* The words of one of the 1 << log light samples of a vertex; number 0 has the vertex's own. */
static inline uint2 light_samples_words(uint2 words, uint number, uint log)
{
    /* At most three digits: reversed for the first word, as they are for the second. */
    const uint reversed = (number & 1u) << 2 | (number & 2u) | number >> 2;
    const uint digits = log == 0u ? 0u : number << (32u - log);
    return (uint2)(words.x ^ reversed << 29, words.y ^ digits);
}

/* The path's first vertex is to take as many light samples as the launch says. */
static inline void light_samples_begin(const RenderParams* params, Path* path)
{
#if SPLITS_LIGHT
    path->light_samples_log = LIGHT_SAMPLES_LOG(*params);
#endif
}

/* Connects a vertex to its light samples. All but one are added here; the last is left to the caller, as by
   path_connect. */
static inline void light_samples_connect(const Scene* scene, const RenderParams* params, uint segment,
                                         const Surface* surface, const Bsdf* bsdf,
                                         const AutomatonStep* step, Path* path, real3* radiance,
                                         LayerSums* layers, PixelRays* rays)
{
    const uint2 words = path->numbers.light;
    for (uint number = path_light_samples(path) - 1u;; --number) {
        path->numbers.light = light_samples_words(words, number, path_light_samples_log(path));
        path_connect(scene, params, segment, surface, bsdf, step, path, rays);
        if (number == 0u)
            return;
        if (!path->is_connected)
            continue;
        ++rays->shadow;
        const real3 share = path_connection_share(scene, params, segment, path, rays);
        path_add_connection(scene, path, share, radiance, layers);
        path->is_connected = false;
    }
}

#endif
