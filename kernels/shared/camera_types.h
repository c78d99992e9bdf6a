// SPDX-License-Identifier: Apache-2.0
// Cameras: a row each, and what kernels know of the one that takes the picture.
#ifndef CLRT_SHARED_CAMERA_TYPES_H
#define CLRT_SHARED_CAMERA_TYPES_H

#include "types.h"

SHARED_BEGIN

/* Every projection: its constant and its name, by which --projection, the file kernels/camera/camera_NAME.h
   and the functions camera_NAME_* there are called. src/scene/camera_params.cpp makes its film vectors. */
#define PROJECTION_ROWS(ROW)      \
    ROW(PERSPECTIVE, perspective) \
    ROW(ORTHOGRAPHIC, orthographic)

enum Projection {
#define PROJECTION_CONSTANT(constant, name) PROJECTION_##constant,
    PROJECTION_ROWS(PROJECTION_CONSTANT)
#undef PROJECTION_CONSTANT
    PROJECTION_COUNT
};

/* The camera in the normalised frame. Film positions count pixels right of and below the picture's centre. */
typedef struct {
    vec4 eye;       /* xyz: where the ray through the picture's centre starts; w: 0, as of the others */
    vec4 film_dx;   /* xyz: what a pixel to the right adds to a ray's direction, to its origin if parallel */
    vec4 film_dy;   /* xyz: the same of a pixel downwards; film_dx x film_dy points along look */
    vec4 look;      /* xyz: unit direction of the ray through the picture's centre */
    u32 projection; /* PROJECTION_* */
    u32 unused0, unused1, unused2;
} CameraParams;
ASSERT_SIZE(CameraParams, 80);

SHARED_END

#endif
