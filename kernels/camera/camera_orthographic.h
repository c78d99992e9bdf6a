// SPDX-License-Identifier: Apache-2.0
// Parallel projection: rays start on the film, a plane through the eye. What is behind it is not seen.
#ifndef CLRT_CAMERA_CAMERA_ORTHOGRAPHIC_H
#define CLRT_CAMERA_CAMERA_ORTHOGRAPHIC_H

#include "camera_connection.h"
#include "geometry/ray.h"

static inline Ray camera_orthographic_generate(const CameraParams* camera, real2 film, real2 lens, real time)
{
    const real3 column = fma((real3)(film.x), vector_from(camera->film_dx), vector_from(camera->eye));
    const real3 origin = fma((real3)(film.y), vector_from(camera->film_dy), column);
    return ray_make(origin, vector_normalize(vector_from(camera->look)), time);
}

static inline CameraPdf camera_orthographic_pdf(const CameraParams* camera, real3 direction)
{
    CameraPdf pdf;
    pdf.pdf_a = REAL(1.0) / vector_length(camera_pixel_area(camera));
    pdf.pdf_w = REAL(1.0);
    return pdf;
}

static inline CameraConnection camera_orthographic_project(const CameraParams* camera, real3 point,
                                                           real2 lens)
{
    const real3 look = vector_from(camera->look);
    const real3 way = point - vector_from(camera->eye);
    if (!(vector_dot(way, look) > REAL(0.0)))
        return camera_connection_none();
    CameraConnection connection;
    connection.film = camera_film_position(camera, way);
    connection.lens = camera_orthographic_generate(camera, connection.film, lens, REAL(0.0)).origin;
    connection.pdf_a = camera_orthographic_pdf(camera, look).pdf_a;
    return connection;
}

#endif
