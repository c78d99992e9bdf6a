// SPDX-License-Identifier: Apache-2.0
// Cameras: a row each, and what kernels know of the one that takes the picture.
#ifndef CLRT_SHARED_CAMERA_TYPES_H
#define CLRT_SHARED_CAMERA_TYPES_H

#include "types.h"

SHARED_BEGIN

/* Every projection: its constant and its name, by which --projection, the file kernels/camera/camera_NAME.h
   and the functions camera_NAME_* there are called. src/scene/camera_params.cpp makes its film vectors. */
#define PROJECTION_ROWS(ROW)        \
    ROW(PERSPECTIVE, perspective)   \
    ROW(ORTHOGRAPHIC, orthographic) \
    ROW(EQUIRECTANGULAR, equirectangular) \
    ROW(FISHEYE, fisheye)

enum Projection {
#define PROJECTION_CONSTANT(constant, name) PROJECTION_##constant,
    PROJECTION_ROWS(PROJECTION_CONSTANT)
#undef PROJECTION_CONSTANT
    PROJECTION_COUNT
};

/* The camera in the normalised frame. Film positions count pixels right of and below the camera's axis;
   without a shift that is the picture's centre. */
typedef struct {
    vec4 eye;     /* xyz: where the ray along the axis starts; w: 0, as of the others */
    vec4 film_dx; /* xyz: what a pixel to the right adds to a ray's direction, to its origin if parallel; unit
                     vector to the right in a panorama */
    vec4 film_dy; /* xyz: the same of a pixel downwards; film_dx x film_dy points along look */
    vec4 look;    /* xyz: unit direction of the axis */

    /* What changes while the shutter is open, where `moves`: eye, way and up run along straight lines, and
       the axes above are those of its opening. */
    vec4 eye_move; /* xyz: from the shutter's opening to its closing */
    vec4 way;      /* xyz: from the eye to what it looks at */
    vec4 way_move;
    vec4 up;       /* xyz: that is up in the picture, not along the way */
    vec4 up_move;

    float pixel_x, pixel_y; /* length of film_dx and film_dy; in a panorama, turns a pixel */
    float shift_x, shift_y; /* of the picture's centre from the axis, pixels to the right and down */
    float lens_radius;      /* 0: a pinhole */
    float inverse_focus;    /* 1 over the depth of the plane in focus; 0: at infinity */
    u32 blades;             /* corners of the lens; 0: round */
    u32 moves;              /* 1 where the camera moves while the shutter is open */
    u32 projection;         /* PROJECTION_* */
    u32 unused0, unused1, unused2;
} CameraParams;
ASSERT_SIZE(CameraParams, 192);

SHARED_END

#endif
