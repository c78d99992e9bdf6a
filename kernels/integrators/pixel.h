// SPDX-License-Identifier: Apache-2.0
// What all integrators share of a pixel: its samples, aimed by the camera and added to the film. An
// integrator is a function
//   void NAME(const Scene*, const RenderParams*, CameraSample* samples, uint count, PixelRays*)
// which fills in the radiance of each sample; entry_point.h makes a kernel of it.
#ifndef CLRT_INTEGRATORS_PIXEL_H
#define CLRT_INTEGRATORS_PIXEL_H

#include "camera/camera.h"
#include "film/film.h"
#include "film/moments.h"
#include "film/splat.h"
#include "film/tile.h"
#include "geometry/scene.h"
#include "path/layers.h"
#include "path/strategies.h"
#include "path/visibility.h"

/* 1 where emission that the camera sees may come from camera rays of its own (emission_rays.h). */
#if defined(CAMERA_RAYS_ARE_SPLIT) && (CLRT_EFFECTS & EFFECT_AREA_LIGHT)
#define SPLITS_EMISSION 1
#else
#define SPLITS_EMISSION 0
#endif

/* 1 where such rays may go on, by lobes without a density. */
#if SPLITS_EMISSION && !(CLRT_EFFECTS & EFFECT_PATH_FILTER) &&                                               \
    (CLRT_EFFECTS & (EFFECT_MIRROR | EFFECT_REFRACTION | EFFECT_THIN_WALL))
#define EMISSION_VIEW_GOES_ON 1
#else
#define EMISSION_VIEW_GOES_ON 0
#endif

/* One sample of a pixel: what an integrator gets and gives. */
typedef struct {
    Sampler sampler;
    LayerSums layers;
    StrategySums strategies;
    Ray ray;
    real3 radiance;
#if SPLITS_EMISSION
    uint emission; /* EMISSION_* of its pixel: by rays, `radiance` starts with what the camera sees of lights;
                      by paths once its own is where no such ray comes */
#endif
#if PATH_GUIDE
    real guide_gain; /* path/guide_gain.h */
#endif
#if PATH_REUSE
    uint member; /* number of its pixel in the group (pixel_group.h) */
#endif
#if FILM_SPLATS
    global long* film; /* for pixel_splat; 0 in a replay, which only looks at splats */
    uint place;        /* of the pixel among those of the window, row by row */
    uint replicate, index;
    uint splat_fault; /* under which counter the last bad splat belongs, or COUNT_WORDS */
#endif
#if FILM_MOMENTS
    Moments moments;
#endif
} CameraSample;

/* True where a sample's path leaves out the emission that its segment meets. */
static inline bool pixel_has_seen(const CameraSample* sample)
{
#if SPLITS_EMISSION
    return (sample->emission & EMISSION_BY_RAYS) != 0u;
#else
    return false;
#endif
}

/* Whether what lies behind the vertex at the end of a segment is still the camera's view: through a lobe of
   this density, 0 for delta lobes. */
static inline bool pixel_view_goes_on(uint emission, uint segment, real pdf_w)
{
    return EMISSION_VIEW_GOES_ON && (emission & EMISSION_GOES_ON) && segment < EMISSION_SEGMENTS &&
           pdf_w == REAL(0.0);
}

/* The sample's path leaves such a vertex. */
static inline void pixel_leave(uint segment, real pdf_w, CameraSample* sample)
{
#if SPLITS_EMISSION
    if (!pixel_view_goes_on(sample->emission, segment, pdf_w))
        sample->emission = EMISSION_BY_PATHS;
#endif
}

/* What counts the rays of a sample's pixel, `rays` being those of its group, or of the pixel alone. */
static inline PixelRays* pixel_rays_of(const CameraSample* sample, PixelRays* rays)
{
#if PATH_REUSE
    rays += sample->member;
#endif
    return rays;
}

/* Aims `count` samples of the pixel (x, y) from the counter on, which have begun (emission_begin); `film`
   takes their splats. */
static CLRT_NOINLINE void pixel_aim(const Scene* scene, const RenderParams* params, global long* film, uint x,
                                    uint y, SampleCounter counter, CameraSample* samples, uint count)
{
    for (uint k = 0; k < count; ++k, sample_counter_next(params, &counter)) {
        samples[k].sampler = tile_sampler(params, x, y, counter);
        samples[k].ray = camera_ray(params, &samples[k].sampler, x, y);
        if (HAS(EFFECT_NESTED))
            visible_find_nest(scene, params, &samples[k].ray);
        layers_begin(&samples[k].layers);
        strategies_begin(&samples[k].strategies);
#if FILM_SPLATS
        samples[k].film = film;
        samples[k].place = (y - params->crop_y) * params->crop_width + (x - params->crop_x);
        samples[k].replicate = counter.replicate;
        samples[k].index = counter.index;
        samples[k].splat_fault = COUNT_WORDS;
#endif
#if FILM_MOMENTS
        moments_begin(&samples[k].moments);
#endif
    }
}

#if FILM_SPLATS
/* Adds a sample's splat number `number` (film/splat.h) to the film. A bad one is left out, and its sample
   is counted as bad. */
static inline void pixel_splat(const RenderParams* params, CameraSample* sample, uint number, real2 position,
                               real3 radiance)
{
    const uint fault =
        film_splat(params, sample->film, sample->replicate, &sample->sampler, number, position, radiance);
    if (fault != COUNT_WORDS)
        sample->splat_fault = fault;
}
#endif

#if PATH_GUIDE
/* Adds what the guide gains by these samples to their tile's sum. */
static inline void pixel_add_gain(const Scene* scene, uint slot, const CameraSample* samples, uint count)
{
    const uint tile = slot / TILE_PIXELS;
    const real weight = (real)scene->guide.weights[tile];
    const real most = (real)GUIDE_LARGEST_GAIN;
    for (uint k = 0; k < count; ++k) {
        const real gain = samples[k].guide_gain * weight;
        if (gain != REAL(0.0) && fabs(gain) < REAL_FAR)
            sum_add_modulo(scene->guide.gains + tile,
                           (ulong)convert_long(clamp(gain, -most, most) * (real)GUIDE_GAIN_UNITS));
    }
}
#endif

/* The fault of a sample whose gathered radiance has this one: that of a splat where the radiance is good. */
static inline uint pixel_fault(const CameraSample* sample, uint fault)
{
#if FILM_SPLATS
    if (fault == COUNT_WORDS)
        return sample->splat_fault;
#endif
    return fault;
}

/* Adds finished samples to the pixel's sums and moves the counter past them. */
static CLRT_NOINLINE void pixel_add(const RenderParams* params, TilePixel place, const CameraSample* samples,
                                    uint count, SampleCounter* counter, global long* film,
                                    global uint* pixel_rays, global volatile uint* counters)
{
    const uint pixel = tile_pixel_number(params, params->crop_x + place.x, params->crop_y + place.y);
    for (uint k = 0; k < count; ++k, sample_counter_next(params, counter)) {
        uint fault = film_fault(params, samples[k].radiance);
        if (fault == COUNT_WORDS) {
            const bool fits = film_add(params, film_sums(params, film, place.slot, counter->replicate),
                                       &samples[k].sampler, samples[k].radiance);
            if (layers_film_add(params, film, place.slot, &samples[k].sampler, &samples[k].layers) != 0u ||
                !fits)
                fault = COUNT_OVERFLOW;
            strategies_film_add(params, film, place.slot, &samples[k].strategies);
        }
#if FILM_MOMENTS
        moments_add_sample(params, film, place.slot, &samples[k].sampler, samples[k].radiance,
                           &samples[k].moments);
#endif
        fault = pixel_fault(&samples[k], fault);
        if (fault != COUNT_WORDS) {
            film_report_fault(counters, fault, pixel, counter->sample);
            ++pixel_rays[tile_index(place.slot, PIXEL_RAYS_WORDS) + PIXEL_BAD_SAMPLES];
        }
    }
}

#endif
