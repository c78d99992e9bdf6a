// SPDX-License-Identifier: Apache-2.0
// The light paths that accompany a pixel's sample: the pixels of the window share those of a pass.
#ifndef CLRT_INTEGRATORS_LIGHT_PATHS_H
#define CLRT_INTEGRATORS_LIGHT_PATHS_H

#include "path/light_path.h"
#include "pixel.h"

/* The light path of a pixel of the window. */
static inline ulong light_paths_of_pixel(const RenderParams* params, uint place)
{
    const uint x = params->crop_x + place % params->crop_width;
    const uint y = params->crop_y + place / params->crop_width;
    return tile_pixel_number(params, x, y);
}

/* Whether a light path is that of a pixel of the window. */
static inline bool light_paths_has_eye(const RenderParams* params, ulong path)
{
    const uint x = (uint)(path % params->width);
    const uint y = (uint)(path / params->width);
    return x - params->crop_x < params->crop_width && y - params->crop_y < params->crop_height;
}

/* Follows those of one sample. With inner connections a sample's path from the eye belongs to the light path
   of its pixel's number in the whole picture, whose vertices `kept` takes. */
static CLRT_NOINLINE void light_paths_trace(const Scene* scene, const RenderParams* params,
                                            CameraSample* sample, LightVertices* kept, PixelRays* rays)
{
    SplatSink sink = {sample->film, sample->replicate, COUNT_WORDS, (real3)(REAL(0.0)), 0};
#if FILM_MOMENTS
    const PixelRays before = *rays;
#endif
    const ulong of_pass = params->light_path_count;
    const uint of_window = params->crop_width * params->crop_height;
    for (ulong path = sample->place; path < of_pass; path += of_window)
        if (!INNER_CONNECTIONS || !light_paths_has_eye(params, path))
            light_path_trace(scene, params, sample->index * of_pass + path, &sink, rays);
    if (INNER_CONNECTIONS) {
        sink.kept = kept;
        const ulong own = light_paths_of_pixel(params, sample->place);
        light_path_trace(scene, params, sample->index * of_pass + own, &sink, rays);
    }
#if FILM_MOMENTS
    sample->moments.light_rays = rays->secondary - before.secondary;
    sample->moments.camera_rays = rays->shadow - before.shadow;
#endif
    if (sink.fault != COUNT_WORDS)
        sample->splat_fault = sink.fault;
    nan_carry(scene, nan_of_vector(sink.watched), &sample->radiance);
}

#endif
