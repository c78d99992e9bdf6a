// SPDX-License-Identifier: Apache-2.0
// The entry point of builds with -DCLRT_TRACE: one work-item replays one sample of the picture and writes its
// record. Included by entry_point.h, in place of the loop over samples.
#ifndef CLRT_INTEGRATORS_REPLAY_H
#define CLRT_INTEGRATORS_REPLAY_H

#include "emission_rays.h"

/* The counter that stands at a sample. */
static inline SampleCounter trace_counter(const RenderParams* params, uint sample)
{
    SampleCounter counter;
    counter.sample = sample;
    counter.replicate = sample % params->replicates;
    counter.index = sample / params->replicates;
    return counter;
}

/* Under which counter the film books a finished sample; its sums where it is good. */
static inline uint trace_film(const RenderParams* params, const CameraSample* sample, global long* sums)
{
    sums[0] = sums[1] = sums[2] = 0;
    const uint fault = film_fault(params, sample->radiance);
    if (fault != COUNT_WORDS)
        return fault;
    film_add(params, sums, &sample->sampler, sample->radiance);
#if PATH_LAYERS > 0
    for (uint i = 0; i < PATH_LAYERS; ++i)
        if (film_fault(params, sample->layers.radiance[i]) != COUNT_WORDS)
            return COUNT_OVERFLOW;
#endif
    return pixel_fault(sample, COUNT_WORDS);
}

/* Finds what the sample sees of lights, without a word of it in the record but for its sum. */
static inline void replay_emission(const Scene* scene, const RenderParams* params, uint emission, uint x,
                                   uint y, SampleCounter counter, CameraSample* sample, PixelRays* rays)
{
    Trace unread = {scene->trace->events, 0u, 0u, 0u};
    Scene unwatched = *scene;
    unwatched.trace = &unread;
    const uint state = emission_settled(&unwatched, params, emission, x, y, &sample->ray);
    emission_begin(&unwatched, params, state, x, y, counter, sample, 1u, rays);
}

static inline void trace_finish(const Scene* scene, const CameraSample* sample)
{
    TRACE_VECTOR(scene, TRACE_RADIANCE, sample->radiance);
#if PATH_LAYERS > 0
    for (uint i = 0; i < PATH_LAYERS; ++i)
        TRACE_VECTOR(scene, TRACE_LAYER, sample->layers.radiance[i]);
#endif
}

/* Replays sample `number` of a pixel, whose emission comes from `emission` (EMISSION_*), and writes the head of
   its record. */
static CLRT_NOINLINE void replay_sample(const Scene* scene, const RenderParams* params, uint pixel,
                                        uint number, uint emission, global ulong* head)
{
    CameraSample sample;
    PixelRays rays = {0u, 0u, 0u, 0ul, 0u};
    const uint x = pixel % params->width, y = pixel / params->width;
    const SampleCounter counter = trace_counter(params, number);
    replay_emission(scene, params, emission, x, y, counter, &sample, &rays);
    pixel_aim(scene, params, 0, x, y, counter, &sample, 1u);
    INTEGRATOR_RADIANCE(scene, params, &sample, 1u, &rays);
    trace_finish(scene, &sample);
    head[TRACE_HEAD_FAULT] = trace_film(params, &sample, (global long*)(head + TRACE_HEAD_FILM));
    head[TRACE_HEAD_COUNT] = scene->trace->count;
    head[TRACE_HEAD_DECISIONS] = scene->trace->decisions;
}

CLRT_KERNEL void replay_samples(const RenderParams params, SCENE_PARAMS,
                                global const uint* restrict addresses, global ulong* records)
{
    const uint i = (uint)get_global_id(0);
    if (i >= addresses[TRACE_ADDRESS_COUNT])
        return;
    const uint capacity = addresses[TRACE_ADDRESS_CAPACITY];
    global ulong* head = records + (ulong)i * (TRACE_HEAD_WORDS + TRACE_EVENT_WORDS * capacity);
    global const uint* address = addresses + TRACE_ADDRESS_FIRST + TRACE_ADDRESS_WORDS * i;
    Trace trace = {head + TRACE_HEAD_WORDS, capacity, 0u, 0u};
    Scene scene = SCENE_MAKE;
    scene.trace = &trace;
    replay_sample(&scene, &params, address[TRACE_ADDRESS_PIXEL], address[TRACE_ADDRESS_SAMPLE],
                  address[TRACE_ADDRESS_EMISSION], head);
}

#endif
