// SPDX-License-Identifier: Apache-2.0
// Emission that the camera sees, from camera rays of its own (splitting, Arvo and Kirk 1990). A lamp is
// often brighter than what it lights by orders of magnitude, and smaller than a pixel: where its outline
// crosses one, whether a path's first segment meets it is most of the pixel's noise. A camera ray is a small
// part of a path, so there the emission comes from several camera rays a sample, and the path leaves out what
// its first segment meets. Where mirrors and smooth glass are seen, and few pixels see them, such rays go on
// by their delta lobes, and the path leaves out all that it meets before a lobe with a density. For programs
// with CAMERA_RAYS_ARE_SPLIT.
//
// The host tells the pixels that may see an outline or look into mirrors (render/light_outlines.h). Which of
// them do is looked at once, by rays that are the same whatever the seed; the picture has no bias whatever
// they find. Lights may be so small that these find none: where few pixels may see such, they take emission
// by rays unless they see a light all over.
#ifndef CLRT_INTEGRATORS_EMISSION_RAYS_H
#define CLRT_INTEGRATORS_EMISSION_RAYS_H

#include "geometry/ray_cone.h"
#include "path/automaton.h"
#include "path/solid.h"
#include "pixel.h"

#if SPLITS_EMISSION
/* Rays that look whether the emission within a pixel varies, and as many in the eight pixels around it: of an
   outline so close to its side that they miss it, samples would meet a sliver now and then. */
#define EMISSION_PROBES 64u

/* It varies where the darkest is less than this share of the brightest. */
#define EMISSION_EVEN REAL(0.5)

/* Nets of their own, apart from those of the samples: a seed for probes, what is added to one for rays. */
#define EMISSION_PROBE_SEED 0x5eed0e31u
#define EMISSION_RAY_SEED 0x85ebca6bu

/* A camera ray that looks at emission. */
typedef struct {
    Ray* ray;
    real3 carried; /* of the emission that it meets next */
    uint solid;    /* that it goes through; NO_INDEX: none is known */
} EmissionView;

/* Takes the ray on from the surface that ends a segment, as a path goes on by a lobe without a density; false
   where it ends. */
static CLRT_NOINLINE bool emission_go_on(const Scene* scene, const RenderParams* params, uint state,
                                         const Sampler* sampler, uint segment, const Surface* surface,
                                         EmissionView* view)
{
    if (segment >= params->max_depth || !pixel_view_goes_on(state, segment, REAL(0.0)))
        return false;
    const Bsdf bsdf = material_bsdf(scene, surface, -view->ray->direction, TRANSPORT_RADIANCE);
    if (bsdf.lobes == 0u)
        return false;
    const uint2 choices = sampler_partner_words(sampler, segment, SAMPLE_DIRECTION);
    const BsdfSample next = bsdf_sample(&bsdf, sampler_unit(choices.x),
                                        sampler_pair(sampler, segment, SAMPLE_DIRECTION));
    if (!next.is_valid || next.pdf_w != REAL(0.0))
        return false;
    view->carried *= next.weight;
    *view->ray = surface_ray(surface, next.reflects, next.wi);
    ray_cone_scatter(params, sampler, next.pdf_w, view->ray);
    dispersion_leave(dispersion_splits(&bsdf, next.reflects), view->ray);
    view->solid = solid_beside(scene, surface, next.reflects);
    return true;
}

/* The emission that a camera ray of pixel (x, y) of the whole picture meets, number `index` of a replicate.
   Its segments are added to `segments`; `state`: EMISSION_* of the pixel. `ray` is room for it. */
static CLRT_NOINLINE real3 emission_seen(const Scene* scene, const RenderParams* params, uint state, uint x,
                                         uint y, uint seed, uint replicate, uint index, Ray* ray,
                                         uint* segments)
{
    const Sampler sampler = sampler_make(seed, tile_pixel_number(params, x, y), replicate, index);
    *ray = camera_ray(params, &sampler, x, y);
    if (HAS(EFFECT_NESTED))
        visible_find_nest(scene, params, ray);
    EmissionView view = {ray, (real3)(REAL(1.0)), NO_INDEX};
    real3 seen = (real3)(REAL(0.0));
    for (uint segment = 1u;; ++segment) {
        ++*segments;
        Hit hit = visible_hit(scene, params, &sampler, segment, ray, &view.carried);
        if (hit.triangle == NO_INDEX)
            return seen;
        const Surface surface = visible_surface(scene, params, ray, &hit);
        solid_arrive(scene, view.solid, &surface, hit.t, &view.carried);
        if (surface.emitter != NO_INDEX)
            seen += view.carried * material_emitted(scene, &surface, -ray->direction);
        if (!emission_go_on(scene, params, state, &sampler, segment, &surface, &view))
            return seen;
    }
}

/* Number k of the pixels around one, row by row; the fifth is itself. */
static inline int2 emission_neighbour(uint k) { return (int2)((int)(k % 3u) - 1, (int)(k / 3u) - 1); }

/* Whether the emission within a pixel varies or, where lights may be small, may do so. */
static inline bool emission_varies(const Scene* scene, const RenderParams* params, uint state, uint x, uint y,
                                   Ray* ray)
{
    real least = REAL(0.0), most = REAL(0.0);
    uint unused = 0u;
    for (uint k = 0; k < 2u * EMISSION_PROBES; ++k) {
        const uint around = k / 2u % 8u;
        const int2 place = emission_neighbour(k % 2u == 0u ? 4u : around < 4u ? around : around + 1u);
        const real3 emission = emission_seen(scene, params, state, x + (uint)place.x, y + (uint)place.y,
                                             EMISSION_PROBE_SEED, 0u, k / 2u, ray, &unused);
        const real seen = vector_max_component(emission);
        least = k == 0u ? seen : fmin(least, seen);
        most = fmax(most, seen);
        if (least < EMISSION_EVEN * most)
            return true;
    }
    return most == REAL(0.0) && (state & EMISSION_SMALL);
}

/* Finds what samples of pixel (x, y) see of lights, the first of them being at the counter. The nets of their
   rays go on from sample to sample. */
static CLRT_NOINLINE void emission_look(const Scene* scene, const RenderParams* params, uint state, uint x,
                                        uint y, SampleCounter counter, CameraSample* samples,
                                        uint sample_count, PixelRays* rays)
{
    const uint count = EMISSION_RAYS(*params);
    for (uint i = 0; i < sample_count; ++i, sample_counter_next(params, &counter)) {
        real3 seen = (real3)(REAL(0.0));
        for (uint k = 0; k < count; ++k)
            seen += emission_seen(scene, params, state, x, y, params->seed + EMISSION_RAY_SEED,
                                  counter.replicate, counter.index * count + k, &samples[i].ray,
                                  &rays->secondary);
        samples[i].radiance = seen / (real)count;
    }
}
#endif

/* Whence the emission that pixel (x, y) sees comes, EMISSION_*: `state`, or what probes tell where it is
   open; from paths where none may add any. `ray` is room for one. */
static inline uint emission_settled(const Scene* scene, const RenderParams* params, uint state, uint x,
                                    uint y, Ray* ray)
{
#if SPLITS_EMISSION
    if (!(automaton_accepted(automaton_start(scene)) & KIND_AREA))
        return EMISSION_BY_PATHS;
    if (state & EMISSION_OPEN)
        return emission_varies(scene, params, state, x, y, ray)
                   ? EMISSION_BY_RAYS | (state & EMISSION_GOES_ON)
                   : EMISSION_BY_PATHS;
#endif
    return state;
}

/* The same of a pixel of the film, which keeps it. */
static inline uint emission_settle(const Scene* scene, const RenderParams* params, global uint* pixel_rays,
                                   TilePixel place, Ray* ray)
{
    global uint* state = pixel_rays + tile_index(place.slot, PIXEL_RAYS_WORDS) + PIXEL_EMISSION;
    const uint x = params->crop_x + place.x, y = params->crop_y + place.y;
    *state = emission_settled(scene, params, *state, x, y, ray);
    return *state;
}

/* Begins samples of pixel (x, y), the first of them at the counter, which are to be aimed yet: with what they
   see of lights where that is not their paths' to find, else with nothing. */
static inline void emission_begin(const Scene* scene, const RenderParams* params, uint state, uint x, uint y,
                                  SampleCounter counter, CameraSample* samples, uint count, PixelRays* rays)
{
    for (uint i = 0; i < count; ++i) {
        samples[i].radiance = (real3)(REAL(0.0));
#if SPLITS_EMISSION
        samples[i].emission = state;
#endif
    }
#if SPLITS_EMISSION
    if (state & EMISSION_BY_RAYS)
        emission_look(scene, params, state, x, y, counter, samples, count, rays);
#endif
}

#endif
