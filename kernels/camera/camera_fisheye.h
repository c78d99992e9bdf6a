// SPDX-License-Identifier: Apache-2.0
// The equidistant fisheye: the angle from the axis grows with the distance from the picture's middle, at most
// to half a turn.
#ifndef CLRT_CAMERA_CAMERA_FISHEYE_H
#define CLRT_CAMERA_CAMERA_FISHEYE_H

#include "camera_connection.h"
#include "camera_panorama.h"
#include "geometry/ray.h"

static inline Ray camera_fisheye_generate(const CameraParams* camera, real2 film, real2 lens, real time)
{
    const real radius = real_sqrt(fma(film.x, film.x, film.y * film.y));
    const real2 angle = camera_sin_cos(radius * (real)camera->pixel_x);
    const real2 outward = radius > REAL(0.0) ? film * (angle.x / radius) : (real2)(REAL(0.0));
    const real3 direction = camera_from_axes(camera, vector_make(outward.x, outward.y, angle.y));
    return ray_make(vector_from(camera->eye), vector_normalize(direction), time);
}

/* At the angle a from the axis a pixel is narrower across than along by sin a / a. */
static inline CameraPdf camera_fisheye_pdf(const CameraParams* camera, real3 direction)
{
    const real3 axes = camera_to_axes(camera, direction);
    const real off = real_sqrt(fma(axes.x, axes.x, axes.y * axes.y));
    const real angle = real_atan2(off, axes.z);
    const real sine = off / vector_length(axes);
    CameraPdf pdf;
    pdf.pdf_a = REAL(1.0);
    pdf.pdf_w = (sine > REAL(0.0) ? angle / sine : REAL(1.0)) / camera_panorama_area(camera);
    return pdf;
}

static inline CameraConnection camera_fisheye_project(const CameraParams* camera, real3 point, real2 lens)
{
    const real3 way = point - vector_from(camera->eye);
    const real3 axes = camera_to_axes(camera, way);
    const real off = real_sqrt(fma(axes.x, axes.x, axes.y * axes.y));
    const real radius = real_atan2(off, axes.z) * (REAL(0.5) * REAL_INVERSE_PI) / (real)camera->pixel_x;
    const real scale = off > REAL(0.0) ? radius / off : REAL(0.0);
    return camera_panorama_connection(camera, way, axes.xy * scale, camera_fisheye_pdf(camera, way).pdf_w);
}

#endif
