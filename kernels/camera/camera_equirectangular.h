// SPDX-License-Identifier: Apache-2.0
// A panorama of all directions, longitude to the right and latitude upwards, a turn a width and half a turn a
// height: the lat-long map of an environment, whose middle is the camera's axis.
#ifndef CLRT_CAMERA_CAMERA_EQUIRECTANGULAR_H
#define CLRT_CAMERA_CAMERA_EQUIRECTANGULAR_H

#include "camera_connection.h"
#include "camera_panorama.h"
#include "geometry/ray.h"

static inline Ray camera_equirectangular_generate(const CameraParams* camera, real2 film, real2 lens,
                                                  real time)
{
    const real2 longitude = camera_sin_cos(film.x * (real)camera->pixel_x);
    const real2 latitude = camera_sin_cos(film.y * (real)camera->pixel_y);
    const real3 direction = camera_from_axes(
        camera, vector_make(latitude.y * longitude.x, latitude.x, latitude.y * longitude.y));
    return ray_make(vector_from(camera->eye), vector_normalize(direction), time);
}

/* A pixel's solid angle is that of its sides times the cosine of the latitude. */
static inline CameraPdf camera_equirectangular_pdf(const CameraParams* camera, real3 direction)
{
    const real3 axes = camera_to_axes(camera, direction);
    const real cosine = real_sqrt(fma(axes.x, axes.x, axes.z * axes.z)) / vector_length(axes);
    CameraPdf pdf;
    pdf.pdf_a = REAL(1.0);
    pdf.pdf_w = REAL(1.0) / (camera_panorama_area(camera) * fmax(cosine, REAL_ROUNDING));
    return pdf;
}

static inline CameraConnection camera_equirectangular_project(const CameraParams* camera, real3 point,
                                                              real2 lens)
{
    const real3 way = point - vector_from(camera->eye);
    const real3 axes = camera_to_axes(camera, way);
    const real level = real_sqrt(fma(axes.x, axes.x, axes.z * axes.z));
    const real2 turns = (real2)(real_atan2(axes.x, axes.z), real_atan2(axes.y, level)) *
                        (REAL(0.5) * REAL_INVERSE_PI);
    return camera_panorama_connection(
        camera, way, turns / (real2)((real)camera->pixel_x, (real)camera->pixel_y),
        camera_equirectangular_pdf(camera, way).pdf_w);
}

#endif
