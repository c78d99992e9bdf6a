// SPDX-License-Identifier: Apache-2.0
// Parallel projection: rays start on the film, a plane through the eye. What is behind it is not seen. A lens
// makes it that of a telecentric objective: each film position has one of its own, with the same focus.
#ifndef CLRT_CAMERA_CAMERA_ORTHOGRAPHIC_H
#define CLRT_CAMERA_CAMERA_ORTHOGRAPHIC_H

#include "camera_connection.h"
#include "camera_lens.h"
#include "geometry/ray.h"

/* The direction of the rays through a point of the lenses, its part along look 1. */
static inline real3 camera_orthographic_way(const CameraParams* camera, real2 place)
{
    return vector_from(camera->look) - camera_film_offset(camera, place) * (real)camera->inverse_focus;
}

static inline Ray camera_orthographic_generate(const CameraParams* camera, real2 film, real2 lens, real time)
{
    real3 way = vector_from(camera->look);
    if (camera_has_lens(camera)) {
        const real2 place = camera_lens_film(camera, lens);
        film += place;
        way = camera_orthographic_way(camera, place);
    }
    const real3 column = fma((real3)(film.x), vector_from(camera->film_dx), vector_from(camera->eye));
    const real3 origin = fma((real3)(film.y), vector_from(camera->film_dy), column);
    return ray_make(origin, vector_normalize(way), time);
}

/* The lens makes the directions: its points fill 1 / focus^2 of their area at depth 1, a solid angle of that
   times cos^3. */
static inline CameraPdf camera_orthographic_pdf(const CameraParams* camera, real3 direction)
{
    CameraPdf pdf;
    pdf.pdf_a = REAL(1.0) / vector_length(camera_pixel_area(camera));
    pdf.pdf_w = REAL(1.0);
    if (camera_has_lens(camera)) {
        const real cosine = vector_dot(vector_from(camera->look), direction);
        const real focus = REAL(1.0) / (real)camera->inverse_focus;
        pdf.pdf_a /= cosine;
        pdf.pdf_w = camera->inverse_focus > 0.0f
                        ? focus * focus / (camera_lens_area(camera) * cosine * cosine * cosine)
                        : REAL(1.0);
    }
    return pdf;
}

static inline CameraConnection camera_orthographic_project(const CameraParams* camera, real3 point,
                                                           real2 lens)
{
    const real3 look = vector_from(camera->look);
    real3 way = point - vector_from(camera->eye);
    if (!(vector_dot(way, look) > REAL(0.0)))
        return camera_connection_none();
    real cosine = REAL(1.0);
    if (camera_has_lens(camera)) {
        /* Back along the ray through the point to the film, and to the lens's middle there. */
        const real2 place = camera_lens_film(camera, lens);
        const real3 back = camera_orthographic_way(camera, place);
        way -= back * vector_dot(way, look) + camera_film_offset(camera, place);
        cosine = REAL(1.0) / vector_length(back);
    }
    CameraConnection connection;
    connection.film = camera_film_position(camera, way);
    connection.lens = camera_orthographic_generate(camera, connection.film, lens, REAL(0.0)).origin;
    connection.pdf_a = REAL(1.0) / (vector_length(camera_pixel_area(camera)) * cosine);
    return connection;
}

#endif
