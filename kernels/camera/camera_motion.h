// SPDX-License-Identifier: Apache-2.0
// The camera that moves while the shutter is open: eye, point looked at and up vector run along straight
// lines.
#ifndef CLRT_CAMERA_CAMERA_MOTION_H
#define CLRT_CAMERA_CAMERA_MOTION_H

#include "numerics/vector.h"
#include "shared/camera_types.h"
#include "shared/effects.h"

static inline bool camera_moves(const CameraParams* camera)
{
    return HAS(EFFECT_MOTION_BLUR) && camera->moves != 0u;
}

/* A start and its move, at a time from 0 to 1. */
static inline real3 camera_moved(float4 start, float4 move, real time)
{
    return fma((real3)(time), vector_from(move), vector_from(start));
}

/* The camera at a time of the shutter's opening (ray_time): itself where it does not move. */
static inline CameraParams camera_at(const CameraParams* camera, real time)
{
    CameraParams now = *camera;
    if (!camera_moves(camera))
        return now;
    const real3 look = vector_normalize(camera_moved(camera->way, camera->way_move, time));
    const real3 right = vector_normalize(vector_cross(look, camera_moved(camera->up, camera->up_move, time)));
    const real3 down = vector_cross(look, right);
    const bool is_panorama = camera->projection >= PROJECTION_EQUIRECTANGULAR;
    const real width = is_panorama ? REAL(1.0) : (real)camera->pixel_x;
    const real height = is_panorama ? REAL(1.0) : (real)camera->pixel_y;
    now.eye = (float4)(convert_float3(camera_moved(camera->eye, camera->eye_move, time)), 0.0f);
    now.film_dx = (float4)(convert_float3(right * width), 0.0f);
    now.film_dy = (float4)(convert_float3(down * height), 0.0f);
    now.look = (float4)(convert_float3(look), 0.0f);
    return now;
}

#endif
