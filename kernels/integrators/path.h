// SPDX-License-Identifier: Apache-2.0
// Path tracing (Kajiya 1986) with next-event estimation and multiple importance sampling (Veach 1997):
// simulates L(D|G|S)*E. One path a sample; a segment is one ray, so a path of max_depth segments scatters
// max_depth - 1 times. The paths of a few samples advance together: all trace a segment, all handle their
// vertex, all test their shadow ray.
#ifndef CLRT_INTEGRATORS_PATH_H
#define CLRT_INTEGRATORS_PATH_H

#include "path/cut.h"
#include "path/light_samples.h"
#include "path_reuse.h"

/* Adds the light from outside the scene. */
static inline void path_escape(const Scene* scene, const RenderParams* params, uint segment, const Path* path,
                               CameraSample* sample, PixelRays* rays)
{
    rays->missed += segment == 1u ? 1u : 0u;
    if (nan_carry(scene, nan_of_miss(&path->hit), &sample->radiance))
        return;
    const real3 direction = path->ray.direction;
    const real pdf_w = path->pdf_w;
    const real3 sky = vertex_sky(scene, params, segment, &path->view, &path->ray, pdf_w, path_accepted(path));
    vertex_add(scene, path->throughput * sky, &sample->radiance);
    if (PATH_LAYERS == 0)
        return;
    const LightView* view = &path->view;
    path_add_layers(scene, path, KIND_SKY,
                    lights_outside(scene, params, segment, view, direction, pdf_w, KIND_SKY),
                    &sample->layers);
    path_add_layers(scene, path, KIND_SUN,
                    lights_outside(scene, params, segment, view, direction, pdf_w, KIND_SUN),
                    &sample->layers);
}

/* Takes what the sample has begun with; the path is at the camera. */
static inline void path_take_seen(const Scene* scene, const Path* path, CameraSample* sample)
{
    if (!pixel_has_seen(sample))
        return;
    TRACE_VECTOR(scene, TRACE_ADDED, sample->radiance);
    path_add_layers(scene, path, KIND_AREA, sample->radiance, &sample->layers);
}

/* Adds what the surface emits. */
static inline void path_add_emission(const Scene* scene, const RenderParams* params, uint segment,
                                     const Surface* surface, const Path* path, CameraSample* sample,
                                     PixelRays* rays)
{
    if (!HAS(EFFECT_AREA_LIGHT) || surface->emitter == NO_INDEX || !(path_accepted(path) & KIND_AREA))
        return;
    if (pixel_has_seen(sample))
        return;
    const real3 emitted = path_emission(scene, params, surface, path, -path->ray.direction, rays);
    vertex_add(scene, path->throughput * emitted, &sample->radiance);
    path_add_layers(scene, path, KIND_AREA, emitted, &sample->layers);
}

/* Handles the vertex at the end of a segment: adds its emission, chooses the next direction, connects to a
   light, and goes on or ends the path. */
static CLRT_NOINLINE void path_vertex(const Scene* scene, const RenderParams* params, uint segment,
                                      Path* path, CameraSample* sample, ReusedPath* reused,
                                      PixelRays* rays)
{
    const real3 wo = -path->ray.direction;
    const Sampler* sampler = &sample->sampler;
    path->is_alive = path->is_connected = false;
    guide_arrive(sample->radiance, &path->guided);
    if (path->hit.triangle == NO_INDEX) {
        path_absorb(scene, 0, path);
        path_skip_slabs(params, path);
        path_escape(scene, params, segment, path, sample, rays);
        return;
    }
    const Surface surface = visible_surface(scene, params, &path->ray, &path->hit);
    path_absorb(scene, &surface, path);
    path_add_emission(scene, params, segment, &surface, path, sample, rays);
    if (segment >= params->max_depth) {
        path_cut(scene, params, sampler, segment, &surface, path, rays);
        return;
    }
    Bsdf bsdf = vertex_bsdf(scene, &surface, wo);
    AutomatonStep step;
    const bool continues = path_filter(scene, params, sampler, segment, &surface, path, &step, &bsdf, rays);
    if (bsdf.lobes == 0u)
        return;
    Guide guide = guide_of(scene, &bsdf, &path->guided);
    reuse_keep_first(params, segment, &surface, &bsdf, &guide, path, reused);
    reuse_keep_second(scene, segment, &surface, &bsdf, path, &sample->radiance, reused);
    const BsdfSample next = path_sample(scene, &surface, &bsdf, continues, &guide, path);
    pixel_leave(segment, next.pdf_w, sample);
    light_samples_connect(scene, params, segment, &surface, &bsdf, &step, path, &sample->radiance,
                          &sample->layers, rays);
    reuse_keep_shares(segment, &bsdf, &next, path, reused);
    if (next.is_valid && continues)
        path_leave(scene, params, sampler, segment, &surface, &bsdf, &step, &guide, &next, path);
}

/* Some of a group's paths, by number and without gaps: asking each path whether it takes part would be a
   branch that nobody can predict. */
typedef struct {
    uint at[SAMPLES_AT_ONCE];
    uint count;
} PathList;

static inline void path_list_add(PathList* list, uint k, bool takes_part)
{
    list->at[list->count] = k;
    list->count += takes_part ? 1u : 0u;
}

/* Draws the random numbers of the vertices at the ends of these paths' segments. */
static inline void path_draw(const Scene* scene, const RenderParams* params, const CameraSample* samples,
                             uint segment, const PathList* list, Path* paths)
{
    NumberLanes numbers;
    for (uint i = 0; i < list->count || i % DEVICE_LANES != 0u; ++i)
        numbers_set_sampler(&numbers, i, &samples[list->at[min(i, list->count - 1u)]].sampler);
    numbers_draw(&numbers, segment, params->epoch, list->count);
    for (uint i = 0; i < list->count; ++i) {
        paths[list->at[i]].numbers = numbers_of(&numbers, i);
        environment_prefetch_slot(scene, params, paths[list->at[i]].numbers.light);
    }
}

/* Draws light samples for the paths of a list that have hit something. */
static inline void path_draw_sky(const Scene* scene, const RenderParams* params, const PathList* list,
                                 Path* paths)
{
    if (!light_is_drawn(params))
        return;
    PathList hit;
    hit.count = 0u;
    for (uint i = 0; i < list->count; ++i)
        path_list_add(&hit, list->at[i], paths[list->at[i]].hit.triangle != NO_INDEX);
    if (hit.count == 0u)
        return;
    SkyLanes lanes;
    for (uint i = 0; i < hit.count || i % DEVICE_LANES != 0u; ++i)
        sky_set_numbers(&lanes, i, &paths[hit.at[min(i, hit.count - 1u)]].numbers);
    sky_draw(scene, params, &lanes, hit.count);
    for (uint i = 0; i < hit.count; ++i)
        paths[hit.at[i]].sky = sky_of(&lanes, i);
}

/* Advances the paths of a list by a segment and its vertex; leaves those in it that go on. */
static inline void path_advance(const Scene* scene, const RenderParams* params, uint segment, Path* paths,
                                CameraSample* samples, ReusedPath* reused, PathList* alive,
                                PixelRays* rays)
{
    path_draw(scene, params, samples, segment, alive, paths);

    /* Find the next vertices. What they will read is on the way from memory while other rays are traced;
       where a ray has missed, the triangle's address is nowhere, which a prefetch may be asked for. */
    for (uint i = 0; i < alive->count; ++i) {
        const uint k = alive->at[i];
        paths[k].hit = vertex_hit(scene, params, &samples[k].sampler, segment, 0u, &paths[k].ray,
                                  &paths[k].throughput);
        environment_prefetch_texel(scene, params, paths[k].numbers.light, paths[k].numbers.alias);
        CLRT_PREFETCH((ulong)scene->triangles + sizeof(Triangle) * paths[k].hit.triangle);
    }

#if PATH_GUIDE
    for (uint i = 0; i < alive->count; ++i) {
        Path* path = &paths[alive->at[i]];
        guide_approach(scene, params, &path->ray, &path->hit, path->numbers.direction, &path->guided);
    }
#endif

    path_draw_sky(scene, params, alive, paths);

    /* Handle them. */
    PathList next, connected;
    next.count = connected.count = 0u;
    for (uint i = 0; i < alive->count; ++i) {
        const uint k = alive->at[i];
        PixelRays* counts = pixel_rays_of(&samples[k], rays);
        path_vertex(scene, params, segment, &paths[k], &samples[k], &reused[k], counts);
        path_list_add(&next, k, paths[k].is_alive);
        path_list_add(&connected, k, paths[k].is_connected);
        counts->secondary += paths[k].is_alive ? 1u : 0u;
        counts->shadow += paths[k].is_connected ? 1u : 0u;
    }
    *alive = next;

    /* Add the light that nothing keeps away. */
    for (uint i = 0; i < connected.count; ++i) {
        const uint k = connected.at[i];
        PixelRays* counts = pixel_rays_of(&samples[k], rays);
        const real3 share = path_connection_share(scene, params, segment, &paths[k], counts);
        path_add_connection(scene, &paths[k], share, &samples[k].radiance, &samples[k].layers);
        reuse_keep_connection(segment, samples[k].radiance, &reused[k]);
    }
}

static CLRT_NOINLINE void path_radiance(const Scene* scene, const RenderParams* params, CameraSample* samples,
                                        uint count, PixelRays* rays)
{
    Path paths[SAMPLES_AT_ONCE];
    ReusedPath reused[SAMPLES_AT_ONCE];
    PathList alive;
    alive.count = 0u;
    for (uint k = 0; k < count; ++k) {
        path_begin(scene, &paths[k], &samples[k].ray);
        light_samples_begin(params, &paths[k]);
        path_take_seen(scene, &paths[k], &samples[k]);
        reuse_begin(&reused[k]);
        guide_choose(params, &samples[k].sampler, &paths[k].guided);
        path_list_add(&alive, k, true);
    }
    for (uint segment = 1u; alive.count != 0u; ++segment)
        path_advance(scene, params, segment, paths, samples, reused, &alive, rays);
#if PATH_GUIDE
    for (uint k = 0; k < count; ++k)
        samples[k].guide_gain = guide_learn(scene, params, samples[k].radiance, &paths[k].guided);
#endif
    reuse_share(scene, params, count, reused, samples, rays);
    for (uint k = 0; k < count; ++k)
        nan_carry(scene, nan_of_vector(paths[k].throughput + paths[k].watched), &samples[k].radiance);
}

#endif
