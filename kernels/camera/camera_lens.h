// SPDX-License-Identifier: Apache-2.0
// The thin lens: every point of it sees what the pinhole at its middle sees in the plane in focus, which is
// parallel to the film (Potmesil and Chakravarty 1981; Cook, Porter and Carpenter 1984). In units of the film
// at depth 1 a point s of the lens moves a ray's origin by s and its film position by -s / focus.
#ifndef CLRT_CAMERA_CAMERA_LENS_H
#define CLRT_CAMERA_CAMERA_LENS_H

#include "numerics/warp.h"
#include "shared/camera_types.h"
#include "shared/effects.h"

static inline bool camera_has_lens(const CameraParams* camera)
{
    return HAS(EFFECT_DEPTH_OF_FIELD) && camera->lens_radius > 0.0f;
}

/* Uniform point of the regular polygon whose corners lie on the unit circle, one of them at the top: a number
   chooses a triangle around the middle, what is left of it and the other the point. */
static inline real2 camera_lens_polygon(uint blades, real2 u)
{
    const real place = u.x * (real)blades;
    const uint blade = min((uint)place, blades - 1u);
    const real2 weights = warp_triangle((real2)(place - (real)blade, u.y));
    const real2 first = real_sin_cos_turn((real)blade / (real)blades);
    const real2 second = real_sin_cos_turn((real)(blade + 1u) / (real)blades);
    const real2 point = weights.x * first + weights.y * second;
    return (real2)(point.x, -point.y);
}

/* The point of the lens that a pair of numbers chooses, on the unit lens: right and down. */
static inline real2 camera_lens_unit(const CameraParams* camera, real2 lens)
{
    return camera->blades == 0u ? warp_disc(lens) : camera_lens_polygon(camera->blades, lens);
}

/* The same in film units at depth 1; camera_has_lens. */
static inline real2 camera_lens_film(const CameraParams* camera, real2 lens)
{
    const real2 pixel = (real2)((real)camera->pixel_x, (real)camera->pixel_y);
    return camera_lens_unit(camera, lens) * (real)camera->lens_radius / pixel;
}

/* Area of the lens; 1 where there is none, so that densities per area say that nothing is chosen. */
static inline real camera_lens_area(const CameraParams* camera)
{
    if (!camera_has_lens(camera))
        return REAL(1.0);
    const real square = (real)camera->lens_radius * (real)camera->lens_radius;
    if (camera->blades == 0u)
        return REAL_PI * square;
    const real count = (real)camera->blades;
    return REAL(0.5) * count * real_sin_cos_turn(REAL(1.0) / count).x * square;
}

#endif
