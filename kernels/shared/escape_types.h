// SPDX-License-Identifier: Apache-2.0
// Ways out of a scene (integrators/escapes.cl).
#ifndef CLRT_SHARED_ESCAPE_TYPES_H
#define CLRT_SHARED_ESCAPE_TYPES_H

#include "types.h"

SHARED_BEGIN

/* The last segment of a path that has left the scene behind its first surface. */
typedef struct {
    vec4 origin;    /* w: surfaces that the path has met, negative where the last sees much of the sky; 0: it
                       has left at once, or not at all */
    vec4 direction; /* w: luminance of the sky there */
} Escape;
ASSERT_SIZE(Escape, 32);

/* Segments after which a path that is still within is given up. */
#define ESCAPE_SEGMENTS 7

/* Ways that are tried from a surface from which a path has left, and how many of them, leaving, too, show
   that it sees much of the sky. */
#define ESCAPE_VIEWS 4u
#define ESCAPE_OPEN_VIEWS 2u

SHARED_END

#endif
