// SPDX-License-Identifier: Apache-2.0
// Which pixel a splat goes to: the pixel filter as seen from the film position. Pixels around it are chosen
// in proportion to the filter's value there, so that each gets what its own samples would weigh the position
// by.
#ifndef CLRT_CAMERA_CAMERA_SPLAT_H
#define CLRT_CAMERA_CAMERA_SPLAT_H

#include "camera.h"

/* A film position in the chosen pixel, and what the splat is multiplied by there. */
typedef struct {
    real2 film;
    real weight;
} CameraSplat;

/* The filter's value at an offset from a pixel's centre, but for a factor. */
static inline real camera_filter_eval(const RenderParams* params, real2 offset)
{
    const real radius = (real)params->filter_radius;
    const real2 share = fabs(offset) / radius;
    if (!HAS(EFFECT_FILTER) || params->filter == FILTER_BOX)
        return share.x < REAL(1.0) && share.y < REAL(1.0) ? REAL(1.0) : REAL(0.0);
    if (params->filter == FILTER_TENT)
        return fmax(REAL(1.0) - share.x, REAL(0.0)) * fmax(REAL(1.0) - share.y, REAL(0.0));
    const real square = share.x * share.x + share.y * share.y;
    const real scale = REAL(-0.5) / (CAMERA_GAUSSIAN_SHARE * CAMERA_GAUSSIAN_SHARE);
    return square < REAL(1.0) ? real_exp(scale * square) : REAL(0.0);
}

/* The integral of camera_filter_eval. */
static inline real camera_filter_integral(const RenderParams* params)
{
    const real square = (real)params->filter_radius * (real)params->filter_radius;
    if (!HAS(EFFECT_FILTER) || params->filter == FILTER_BOX)
        return REAL(4.0) * square;
    if (params->filter == FILTER_TENT)
        return square;
    const real scale = REAL(2.0) * CAMERA_GAUSSIAN_SHARE * CAMERA_GAUSSIAN_SHARE;
    return square * REAL_PI * scale * (REAL(1.0) - real_exp(REAL(-1.0) / scale));
}

/* The pixel to which a splat at a film position goes; `u` in (0, 1) chooses. A box of one pixel leaves no
   choice. */
static inline CameraSplat camera_splat(const RenderParams* params, real2 film, real u)
{
    CameraSplat splat = {film, REAL(1.0)};
    const real radius = (real)params->filter_radius;
    if ((!HAS(EFFECT_FILTER) || params->filter == FILTER_BOX) && radius == REAL(0.5))
        return splat;
    /* What falls beside the picture has no pixel, and may be so far away that a pixel's width is lost. */
    const real2 beside =
        fabs(film) - REAL(0.5) * (real2)((real)params->width, (real)params->height) - radius;
    if (!(beside.x < REAL(0.0) && beside.y < REAL(0.0)))
        return splat;
    /* Pixels' centres lie on whole numbers from that of the picture's first pixel. */
    const real2 first = (real2)(REAL(0.5)) - REAL(0.5) * (real2)((real)params->width, (real)params->height);
    const real2 lowest = ceil(film - first - radius) + first;
    const real2 highest = film + radius;
    real sum = REAL(0.0);
    for (real y = lowest.y; y <= highest.y; y += REAL(1.0))
        for (real x = lowest.x; x <= highest.x; x += REAL(1.0))
            sum += camera_filter_eval(params, film - (real2)(x, y));
    splat.weight = sum / camera_filter_integral(params);
    real left = u * sum;
    for (real y = lowest.y; y <= highest.y; y += REAL(1.0))
        for (real x = lowest.x; x <= highest.x; x += REAL(1.0)) {
            const real value = camera_filter_eval(params, film - (real2)(x, y));
            if (value > REAL(0.0) && left >= REAL(0.0))
                splat.film = (real2)(x, y);
            left -= value;
        }
    return splat;
}

#endif
