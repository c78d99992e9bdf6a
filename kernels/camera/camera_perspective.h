// SPDX-License-Identifier: Apache-2.0
// The pinhole: all rays start at the eye.
#ifndef CLRT_CAMERA_CAMERA_PERSPECTIVE_H
#define CLRT_CAMERA_CAMERA_PERSPECTIVE_H

#include "camera_connection.h"
#include "geometry/ray.h"

static inline Ray camera_perspective_generate(const CameraParams* camera, real2 film, real2 lens, real time)
{
    const real3 direction =
        fma((real3)(film.x), vector_from(camera->film_dx),
            fma((real3)(film.y), vector_from(camera->film_dy), vector_from(camera->look)));
    return ray_make(vector_from(camera->eye), vector_normalize(direction), time);
}

/* A pixel of area A at distance 1 fills the solid angle A cos^3. */
static inline CameraPdf camera_perspective_pdf(const CameraParams* camera, real3 direction)
{
    const real3 pixel = camera_pixel_area(camera);
    const real area = vector_dot(pixel, vector_from(camera->look));
    const real cosine = vector_dot(pixel, direction) / area;
    CameraPdf pdf;
    pdf.pdf_a = REAL(1.0);
    pdf.pdf_w = cosine > REAL(0.0) ? REAL(1.0) / (area * cosine * cosine * cosine) : REAL(0.0);
    return pdf;
}

static inline CameraConnection camera_perspective_project(const CameraParams* camera, real3 point, real2 lens)
{
    const real3 way = point - vector_from(camera->eye);
    const real3 pixel = camera_pixel_area(camera);
    const real depth = vector_dot(way, pixel) / vector_dot(vector_from(camera->look), pixel);
    if (!(depth > REAL(0.0)))
        return camera_connection_none();
    const real distance = vector_length(way);
    CameraConnection connection;
    connection.film = camera_film_position(camera, way) / depth;
    connection.lens = vector_from(camera->eye);
    connection.pdf_a = camera_perspective_pdf(camera, way / distance).pdf_w / (distance * distance);
    return connection;
}

#endif
