// SPDX-License-Identifier: Apache-2.0
// The light paths that accompany a pixel's sample: the pixels of the window share those of a pass.
#ifndef CLRT_INTEGRATORS_LIGHT_PATHS_H
#define CLRT_INTEGRATORS_LIGHT_PATHS_H

#include "path/light_path.h"
#include "pixel.h"

/* Follows those of one sample. */
static CLRT_NOINLINE void light_paths_trace(const Scene* scene, const RenderParams* params,
                                            CameraSample* sample, PixelRays* rays)
{
    SplatSink sink = {sample->film, sample->replicate, COUNT_WORDS, (real3)(REAL(0.0))};
    const ulong of_pass = params->light_path_count;
    const uint of_window = params->crop_width * params->crop_height;
    for (ulong path = sample->place; path < of_pass; path += of_window)
        light_path_trace(scene, params, sample->index * of_pass + path, &sink, rays);
    if (sink.fault != COUNT_WORDS)
        sample->splat_fault = sink.fault;
    nan_carry(scene, nan_of_vector(sink.watched), &sample->radiance);
}

#endif
