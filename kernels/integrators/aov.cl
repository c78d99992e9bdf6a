// SPDX-License-Identifier: Apache-2.0
// Entry point for the layers of the primary hits: what the picture's samples see first, by the same camera
// rays.
#include "camera/camera.h"
#include "film/matte.h"
#include "film/tile.h"
#include "path/visibility.h"
#include "shared/aov_types.h"

/* Whether samples are counted by object and material: a literal of the program. */
#ifndef AOV_MATTES
#define AOV_MATTES 0
#endif

/* Words of a pixel's mattes; without mattes there is no buffer. */
#if AOV_MATTES
#define AOV_MATTE_PARAM , global uint* restrict hit_mattes
#define AOV_PIXEL_MATTES(slot) (hit_mattes + tile_index(slot, MATTE_WORDS))
#else
#define AOV_MATTE_PARAM
#define AOV_PIXEL_MATTES(slot) 0
#endif

/* Sums over a pixel's samples of this launch. */
typedef struct {
    long values[AOV_SUMS];
    uint words[AOV_WORDS];
} AovSums;

/* In fixed point, rounded to nearest; 0 for what is no number. */
static inline long aov_fixed(real x)
{
    const real largest = (real)AOV_LARGEST;
    return real_is_finite(x) ? convert_long_rte(clamp(x, -largest, largest) * (real)(1ul << AOV_BITS)) : 0;
}

static inline void aov_add(long* sums, real3 v)
{
    sums[0] += aov_fixed(v.x);
    sums[1] += aov_fixed(v.y);
    sums[2] += aov_fixed(v.z);
}

/* Adds what one sample hits first. */
static CLRT_NOINLINE void aov_sample(const Scene* scene, const RenderParams* params, uint x, uint y,
                                     SampleCounter counter, AovSums* sums, global uint* mattes)
{
    const Sampler sampler = tile_sampler(params, x, y, counter);
    Ray ray = camera_ray(params, &sampler, x, y);
    if (HAS(EFFECT_NESTED))
        visible_find_nest(scene, params, &ray);
    real3 carried = (real3)(REAL(1.0));
    Hit hit = visible_hit(scene, params, &sampler, 1u, &ray, &carried);
    if (hit.triangle == NO_INDEX)
        return;
    const real3 wo = -ray.direction;
    const Surface surface = visible_surface(scene, params, &ray, &hit);
    const Bsdf bsdf = material_bsdf(scene, &surface, wo, TRANSPORT_RADIANCE);
    aov_add(sums->values + AOV_ALBEDO, bsdf_albedo(&bsdf));
    aov_add(sums->values + AOV_NORMAL, bsdf.frame.z);
    aov_add(sums->values + AOV_POSITION, surface.position);
    if (HAS(EFFECT_AREA_LIGHT) && surface.emitter != NO_INDEX)
        sums->values[AOV_EMISSION] += aov_fixed(
            vector_luminance(carried * material_emitted(scene, &surface, wo)) / (real)AOV_EMISSION_UNIT);
    const uint object = surface_object(scene, &hit);
    if (sums->words[AOV_HITS]++ == 0u) {
        sums->words[AOV_OBJECT] = object;
        sums->words[AOV_MATERIAL] = surface.material;
    }
    if (AOV_MATTES)
        matte_add(mattes, object, surface.material);
}

/* Writes the sums of the launch's samples, tile by tile in the order of the launch. */
CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void render_aov(
    const RenderParams params, SCENE_PARAMS, global const uint* restrict pixel_rays,
    global long* restrict hit_sums, global uint* restrict hit_words AOV_MATTE_PARAM)
{
    TilePixel place;
    if (!tile_pixel(&params, &place))
        return;
    const Scene scene = SCENE_MAKE;
    AovSums sums;
    for (uint i = 0; i < AOV_SUMS; ++i)
        sums.values[i] = 0;
    for (uint i = 0; i < AOV_WORDS; ++i)
        sums.words[i] = 0u;
    const uint slot = tile_launch_slot();
    const SampleRange range = tile_samples(&params, pixel_rays, place.slot);
    SampleCounter counter = sample_counter_make(&params, range.first);
    for (uint i = 0; i < range.count; ++i, sample_counter_next(&params, &counter))
        aov_sample(&scene, &params, params.crop_x + place.x, params.crop_y + place.y, counter, &sums,
                   AOV_PIXEL_MATTES(slot));
    for (uint i = 0; i < AOV_SUMS; ++i)
        hit_sums[tile_index(slot, AOV_SUMS) + i] = sums.values[i];
    for (uint i = 0; i < AOV_WORDS; ++i)
        hit_words[tile_index(slot, AOV_WORDS) + i] = sums.words[i];
}
