// SPDX-License-Identifier: Apache-2.0
// Entry point for the auxiliary layers: what the primary hits are. The same camera rays as the picture's samples.
#include "camera/camera.h"
#include "film/tile.h"
#include "geometry/visibility.h"

/* Floats a pixel: albedo rgb, normal xyz, position xyz, distance along look: sums over samples that hit; number of hits;
   object and material of the first hit (NO_INDEX as -1). */
#define AOV_FLOATS 13

/* Reflectance of the surface seen along wo: reflection head-on and what of the matte colour it leaves; 1 for dielectrics. */
static inline real3 aov_albedo(const Bsdf* bsdf)
{
    if (bsdf->lobes & LOBE_DIELECTRIC)
        return (real3)(REAL(1.0));
    real3 albedo = (bsdf->lobes & LOBE_MATTE) ? bsdf->matte : (real3)(REAL(0.0));
    if (bsdf->flags & BSDF_COUPLED)
        albedo *= (real3)(REAL(1.0)) - bsdf->specular;
    if (bsdf->lobes & (LOBE_GLOSSY | LOBE_MIRROR))
        albedo += bsdf->specular;
    return albedo;
}

static inline void aov_add(global float* out, real3 v)
{
    out[0] += (float)v.x;
    out[1] += (float)v.y;
    out[2] += (float)v.z;
}

/* Adds one sample's layers. */
static CLRT_NOINLINE void aov_sample(const Scene* scene, const RenderParams* params, uint x, uint y, uint sample,
                                     global float* out)
{
    const Sampler sampler = sampler_make(params->seed, y * params->width + x, sample % params->replicates,
                                         sample / params->replicates);
    const Ray ray = camera_ray(params, &sampler, x, y);
    const Hit hit = visible_hit(scene, params, &sampler, 1u, &ray);
    if (hit.triangle == NO_INDEX)
        return;
    const real3 wo = -ray.direction;
    const Surface surface = surface_at(scene, &hit, wo);
    const Bsdf bsdf = material_bsdf(scene, &surface, wo);
    aov_add(out, aov_albedo(&bsdf));
    aov_add(out + 3, bsdf.frame.z);
    aov_add(out + 6, surface.position);
    out[9] += (float)(hit.t * vector_dot(ray.direction, vector_from(params->look)));
    if (out[10] == 0.0f) {
        out[11] = (float)scene->triangles[hit.triangle].object;
        out[12] = (float)surface.material;
    }
    out[10] += 1.0f;
}

CLRT_KERNEL __attribute__((reqd_work_group_size(TILE_SIZE, TILE_SIZE, 1))) void render_aov(const RenderParams params,
                                                                                      SCENE_PARAMS,
                                                                                      global float* restrict layers)
{
    TilePixel place;
    if (!tile_pixel(&params, &place))
        return;
    const Scene scene = SCENE_MAKE;
    global float* out = layers + AOV_FLOATS * (place.y * params.crop_width + place.x);
    for (uint i = 0; i < AOV_FLOATS; ++i)
        out[i] = 0.0f;
    for (uint s = 0; s < params.sample_count; ++s)
        aov_sample(&scene, &params, params.crop_x + place.x, params.crop_y + place.y, params.first_sample + s, out);
}
