// SPDX-License-Identifier: Apache-2.0
// Entry points of Metropolis light transport: of pixels and of chains.
#define SPLATS_ARE_WEIGHTED 1
#define SAMPLER_CHAINS 1
#include "mlt.h"

#define INTEGRATOR_KERNEL render_mlt
#define INTEGRATOR_RADIANCE mlt_radiance
#include "entry_point.h"

#ifndef CLRT_TRACE
CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void render_chains(
    const RenderParams params, SCENE_PARAMS, global long* restrict film, global uint* restrict pixel_rays,
    global volatile uint* counters, const ChainLaunch launch, global Chain* restrict chains,
    global uint* restrict words, global float* restrict scores, global const uint* restrict starts,
    global const float* restrict scales, global const float* restrict importance)
{
    const Scene scene = SCENE_MAKE;
    const ChainArrays arrays = {chains, words, scores, starts, scales, importance};
    mlt_chain(&scene, &params, &launch, &arrays, launch.first + tile_launch_slot(), film, pixel_rays,
              counters);
}
#endif
