// SPDX-License-Identifier: Apache-2.0
// The pinhole, where all rays start at the eye, and the lens around it.
#ifndef CLRT_CAMERA_CAMERA_PERSPECTIVE_H
#define CLRT_CAMERA_CAMERA_PERSPECTIVE_H

#include "camera_connection.h"
#include "camera_lens.h"
#include "geometry/ray.h"

static inline Ray camera_perspective_generate(const CameraParams* camera, real2 film, real2 lens, real time)
{
    real3 origin = vector_from(camera->eye);
    if (camera_has_lens(camera)) {
        const real2 point = camera_lens_film(camera, lens);
        origin += camera_film_offset(camera, point);
        film -= point * (real)camera->inverse_focus;
    }
    const real3 direction =
        fma((real3)(film.x), vector_from(camera->film_dx),
            fma((real3)(film.y), vector_from(camera->film_dy), vector_from(camera->look)));
    return ray_make(origin, vector_normalize(direction), time);
}

/* A pixel of area A at distance 1 fills the solid angle A cos^3, from any point of the lens. */
static inline CameraPdf camera_perspective_pdf(const CameraParams* camera, real3 direction)
{
    const real3 pixel = camera_pixel_area(camera);
    const real area = vector_dot(pixel, vector_from(camera->look));
    const real cosine = vector_dot(pixel, direction) / area;
    CameraPdf pdf;
    pdf.pdf_a = REAL(1.0);
    if (camera_has_lens(camera))
        pdf.pdf_a = REAL(1.0) / (camera_lens_area(camera) * fabs(cosine));
    pdf.pdf_w = cosine > REAL(0.0) ? REAL(1.0) / (area * cosine * cosine * cosine) : REAL(0.0);
    return pdf;
}

static inline CameraConnection camera_perspective_project(const CameraParams* camera, real3 point, real2 lens)
{
    const bool has_lens = camera_has_lens(camera);
    const real2 place = has_lens ? camera_lens_film(camera, lens) : (real2)(REAL(0.0));
    CameraConnection connection;
    connection.lens = vector_from(camera->eye);
    if (has_lens)
        connection.lens += camera_film_offset(camera, place);
    const real3 way = point - connection.lens;
    const real3 pixel = camera_pixel_area(camera);
    const real depth = vector_dot(way, pixel) / vector_dot(vector_from(camera->look), pixel);
    if (!(depth > REAL(0.0)))
        return camera_connection_none();
    const real distance = vector_length(way);
    connection.film = camera_film_position(camera, way) / depth;
    if (has_lens)
        connection.film += place * (real)camera->inverse_focus;
    connection.pdf_a = camera_perspective_pdf(camera, way / distance).pdf_w / (distance * distance);
    return connection;
}

#endif
