// SPDX-License-Identifier: Apache-2.0
// What every camera tells of its rays, for paths that are followed from the lights.
#ifndef CLRT_CAMERA_CAMERA_CONNECTION_H
#define CLRT_CAMERA_CAMERA_CONNECTION_H

#include "numerics/vector.h"
#include "shared/camera_types.h"

/* Densities of a ray, of film positions one a pixel: over the rays through one pixel, pdf_a pdf_w
   integrates to 1. Where a camera leaves no choice the density is 1: at the point of a pinhole, in the
   direction of parallel rays. */
typedef struct {
    real pdf_a; /* of where it starts, per unit of area across it */
    real pdf_w; /* of its direction, per steradian */
} CameraPdf;

/* How a point of the scene is connected to the camera. */
typedef struct {
    real2 film; /* position, pixels right of and below the picture's centre; may be outside the picture */
    real3 lens; /* where the ray from there to the point starts */
    real pdf_a; /* film positions, one a pixel, per area across the ray at the point; 0: it is not seen */
} CameraConnection;

/* The connection of a point that no ray of the camera leads to. */
static inline CameraConnection camera_connection_none(void)
{
    CameraConnection none;
    none.film = (real2)(REAL(0.0));
    none.lens = (real3)(REAL(0.0));
    none.pdf_a = REAL(0.0);
    return none;
}

/* Area of a pixel, times the unit vector along look: of the film where its positions are look + x film_dx
   + y film_dy. */
static inline real3 camera_pixel_area(const CameraParams* camera)
{
    return vector_cross(vector_from(camera->film_dx), vector_from(camera->film_dy));
}

/* x film_dx + y film_dy. */
static inline real3 camera_film_offset(const CameraParams* camera, real2 film)
{
    return fma((real3)(film.x), vector_from(camera->film_dx), film.y * vector_from(camera->film_dy));
}

/* The position of the film whose offset x film_dx + y film_dy, with any part along look, is `way`; exact
   for film vectors at any angle. */
static inline real2 camera_film_position(const CameraParams* camera, real3 way)
{
    const real3 look = vector_from(camera->look);
    const real volume = vector_dot(look, camera_pixel_area(camera));
    return (real2)(vector_dot(way, vector_cross(vector_from(camera->film_dy), look)),
                   vector_dot(way, vector_cross(look, vector_from(camera->film_dx)))) / volume;
}

#endif
