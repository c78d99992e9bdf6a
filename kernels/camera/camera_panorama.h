// SPDX-License-Identifier: Apache-2.0
// What cameras share whose film positions are angles and whose rays start at the eye: their pixels count in
// turns, and film_dx, film_dy and look are unit vectors.
#ifndef CLRT_CAMERA_CAMERA_PANORAMA_H
#define CLRT_CAMERA_CAMERA_PANORAMA_H

#include "camera_connection.h"
#include "numerics/real_functions.h"

/* (sin, cos) of an angle in turns, from -1 to 1. */
static inline real2 camera_sin_cos(real turns)
{
    const real2 sc = real_sin_cos_turn(fabs(turns));
    return turns < REAL(0.0) ? (real2)(-sc.x, sc.y) : sc;
}

/* The vector of these parts to the right, down, and along the axis. */
static inline real3 camera_from_axes(const CameraParams* camera, real3 parts)
{
    return fma((real3)(parts.x), vector_from(camera->film_dx),
               fma((real3)(parts.y), vector_from(camera->film_dy), parts.z * vector_from(camera->look)));
}

static inline real3 camera_to_axes(const CameraParams* camera, real3 v)
{
    return vector_make(vector_dot(v, vector_from(camera->film_dx)),
                       vector_dot(v, vector_from(camera->film_dy)), vector_dot(v, vector_from(camera->look)));
}

/* Product of the angles that the sides of a pixel span, radians. */
static inline real camera_panorama_area(const CameraParams* camera)
{
    return REAL(4.0) * REAL_PI * REAL_PI * (real)camera->pixel_x * (real)camera->pixel_y;
}

/* The connection of the point at this way from the eye, of a density per steradian. */
static inline CameraConnection camera_panorama_connection(const CameraParams* camera, real3 way, real2 film,
                                                          real pdf_w)
{
    const real square = vector_dot(way, way);
    if (!(square > REAL(0.0)))
        return camera_connection_none();
    CameraConnection connection;
    connection.film = film;
    connection.lens = vector_from(camera->eye);
    connection.pdf_a = pdf_w / square;
    return connection;
}

#endif
