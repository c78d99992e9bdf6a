// SPDX-License-Identifier: Apache-2.0
// Film positions and the rays through them: the pixel filter, and the table of cameras. All cameras have
//   Ray camera_NAME_generate(const CameraParams*, real2 film, real2 lens, real time)
//   CameraPdf camera_NAME_pdf(const CameraParams*, real3 direction)
//   CameraConnection camera_NAME_project(const CameraParams*, real3 point, real2 lens)
// of film positions that count from the camera's axis. A camera that moves is taken at a time before
// (camera_at).
#ifndef CLRT_CAMERA_CAMERA_H
#define CLRT_CAMERA_CAMERA_H

#include "camera_equirectangular.h"
#include "camera_fisheye.h"
#include "camera_motion.h"
#include "camera_orthographic.h"
#include "camera_perspective.h"
#include "geometry/ray_cone.h"
#include "numerics/real_functions.h"
#include "numerics/sampler.h"
#include "shared/effects.h"
#include "shared/render_types.h"

/* A Gaussian filter's standard deviation as a share of its radius. */
#define CAMERA_GAUSSIAN_SHARE REAL(0.3333333333)

/* A number distributed as the tent of radius 1, from one in (0, 1). */
static inline real camera_tent(real u)
{
    return u < REAL(0.5) ? real_sqrt(REAL(2.0) * u) - REAL(1.0)
                         : REAL(1.0) - real_sqrt(REAL(2.0) * (REAL(1.0) - u));
}

/* Film position of a sample relative to its pixel's centre, distributed as the pixel filter (filter
   importance sampling, Ernst et al. 2006): every sample has weight 1. */
static inline real2 camera_filter_sample(const RenderParams* params, real2 u)
{
    const real radius = (real)params->filter_radius;
    if (!HAS(EFFECT_FILTER) || params->filter == FILTER_BOX)
        return (u - (real2)(REAL(0.5))) * (REAL(2.0) * radius);
    if (params->filter == FILTER_TENT)
        return (real2)(camera_tent(u.x), camera_tent(u.y)) * radius;
    /* Box-Muller, cut at the radius by scaling the radial distribution. */
    const real sigma = CAMERA_GAUSSIAN_SHARE * radius;
    const real cut = REAL(1.0) - real_exp(-radius * radius / (REAL(2.0) * sigma * sigma));
    const real r = sigma * real_root(REAL(-2.0) * real_log(REAL(1.0) - u.x * cut));
    const real2 sc = real_sin_cos_turn(u.y);
    return (real2)(r * sc.y, r * sc.x);
}

/* From the camera's axis to the picture's centre, pixels. */
static inline real2 camera_shift(const CameraParams* camera)
{
    return (real2)((real)camera->shift_x, (real)camera->shift_y);
}

/* Which camera takes the picture is a run-time choice: a branch that all work-items take alike, once a
   path, while programs of their own would be compiled and kept apart for each. `film` counts from the
   picture's centre. `lens` is a pair of numbers in (0, 1) that chooses a point of the lens, where there is
   one. A camera without a row sees nothing: its ray has no direction. */
static inline Ray camera_generate(const CameraParams* camera, real2 film, real2 lens, real time)
{
#define CAMERA_GENERATE(constant, name)                \
    if (camera->projection == PROJECTION_##constant) \
        return camera_##name##_generate(camera, film + camera_shift(camera), lens, time);
    PROJECTION_ROWS(CAMERA_GENERATE)
    return ray_make((real3)(REAL(0.0)), (real3)(REAL(0.0)), time);
}

/* Densities of a ray that the camera generates in this direction. */
static inline CameraPdf camera_pdf(const CameraParams* camera, real3 direction)
{
#define CAMERA_PDF(constant, name)                   \
    if (camera->projection == PROJECTION_##constant) \
        return camera_##name##_pdf(camera, direction);
    PROJECTION_ROWS(CAMERA_PDF)
    const CameraPdf none = {REAL(0.0), REAL(0.0)};
    return none;
}

/* Importance that the camera emits along such a ray, times its cosine (Veach 1997, 8.3): all rays of a
   pixel weigh alike in the picture, so it is their density. */
static inline real camera_importance(const CameraParams* camera, real3 direction)
{
    const CameraPdf pdf = camera_pdf(camera, direction);
    return pdf.pdf_a * pdf.pdf_w;
}

/* Where the film sees a point, through the point of the lens that `lens` chooses. Light that leaves the
   point for the lens adds its radiance times the point's cosine times pdf_a to the pixel there, over the
   number of such connections a pixel. */
static inline CameraConnection camera_project(const CameraParams* camera, real3 point, real2 lens)
{
    CameraConnection connection = camera_connection_none();
#define CAMERA_PROJECT(constant, name)               \
    if (camera->projection == PROJECTION_##constant) \
        connection = camera_##name##_project(camera, point, lens);
    PROJECTION_ROWS(CAMERA_PROJECT)
    connection.film -= camera_shift(camera);
    return connection;
}

/* The same at a time within the shutter's opening. */
static inline CameraConnection camera_project_at(const RenderParams* params, real3 point, real2 lens,
                                                 real time)
{
    if (!camera_moves(&params->camera))
        return camera_project(&params->camera, point, lens);
    const CameraParams camera = camera_at(&params->camera, time);
    return camera_project(&camera, point, lens);
}

/* Film position of the centre of pixel (x, y) of the whole picture: from its middle, exact, because
   counted from a corner the terms of a wide angle would cancel. */
static inline real2 camera_pixel_centre(const RenderParams* params, uint x, uint y)
{
    const int from_left = 2 * (int)x + 1 - (int)params->width,
              from_top = 2 * (int)y + 1 - (int)params->height;
    return (real2)((real)from_left, (real)from_top) * REAL(0.5);
}

/* The pixel of the whole picture that a film position lies in, row by row; NO_INDEX outside the picture. */
static inline uint camera_pixel(const RenderParams* params, real2 film)
{
    const real2 corner = floor(film + (real2)((real)params->width, (real)params->height) * REAL(0.5));
    const bool is_inside = corner.x >= REAL(0.0) && corner.x < (real)params->width && corner.y >= REAL(0.0) &&
                           corner.y < (real)params->height;
    return is_inside ? (uint)corner.y * params->width + (uint)corner.x : NO_INDEX;
}

/* A ray with its wave and its cone: the sample's share of a pixel, as a pinhole sees it. Parallel rays stand for parts of
   the film instead. */
static inline Ray camera_cone_ray(const RenderParams* params, const Sampler* sampler,
                                  const CameraParams* camera, real2 film, real2 lens, real time)
{
    Ray ray = camera_generate(camera, film, lens, time);
    ray_set_wave(ray_sampled_wave(sampler), &ray);
#if CLRT_EFFECTS & EFFECT_TEXTURE_FILTER
    if (ray_cone_is_wanted(params)) {
        const CameraPdf pdf = camera_pdf(camera, ray.direction);
        if (camera->projection == PROJECTION_ORTHOGRAPHIC)
            ray.width = real_sqrt(ray_cone_share(params, sampler, pdf.pdf_a));
        else
            ray_cone_begin(params, sampler, pdf.pdf_w, &ray);
    }
#endif
    return ray;
}

/* The film position of a sample of pixel (x, y) of the whole picture; `u` chooses the point in the pixel's
   filter. Patches of a pilot shrink about their centres. */
static inline real2 camera_sample_position(const RenderParams* params, uint x, uint y, real2 u)
{
    const real2 centre = camera_pixel_centre(params, x, y);
    const real2 offset = camera_filter_sample(params, u);
    const uint last = params->patch_last;
    const int to_right = 2 * (int)((x - params->crop_x) & last) - (int)last,
              down = 2 * (int)((y - params->crop_y) & last) - (int)last;
    const real2 from_patch_centre = (real2)((real)to_right, (real)down) * REAL(0.5);
    return centre - from_patch_centre +
           (from_patch_centre + offset) * (REAL(1.0) - (real)params->patch_gap);
}

/* The ray of a sample through pixel (x, y) of the whole picture; `u` chooses the point in the pixel's
   filter. */
static inline Ray camera_ray_at(const RenderParams* params, const Sampler* sampler, uint x, uint y, real2 u)
{
    const real2 film = camera_sample_position(params, x, y, u);
    const real2 lens = sampler_pair(sampler, 0u, SAMPLE_LENS);
    const real time = HAS(EFFECT_MOTION_BLUR) ? sampler_pair(sampler, 0u, SAMPLE_TIME).x : REAL(0.0);
    if (!camera_moves(&params->camera))
        return camera_cone_ray(params, sampler, &params->camera, film, lens, time);
    const CameraParams camera = camera_at(&params->camera, time);
    return camera_cone_ray(params, sampler, &camera, film, lens, time);
}

/* The same at the sample's own point. */
static inline Ray camera_ray(const RenderParams* params, const Sampler* sampler, uint x, uint y)
{
    return camera_ray_at(params, sampler, x, y, sampler_pair(sampler, 0u, SAMPLE_FILM));
}

#endif
