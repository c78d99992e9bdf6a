// SPDX-License-Identifier: Apache-2.0
// Cells of space: surface points that see about the same light share what paths have learnt there. A cell is
// a leaf of one of six trees over space, one for each side that a surface can face. The host divides cells in
// which many paths have found light (src/guide/guide.h).
#ifndef CLRT_PATH_CELL_H
#define CLRT_PATH_CELL_H

#include "numerics/vector.h"
#include "shared/guide_types.h"

/* The side of the cube that a normal faces: 0 to 5. */
static inline uint cell_side(real3 n)
{
    const real3 a = fabs(n);
    const uint axis = a.x >= a.y && a.x >= a.z ? 0u : (a.y >= a.z ? 1u : 2u);
    const real along = axis == 0u ? n.x : (axis == 1u ? n.y : n.z);
    return 2u * axis + (along < REAL(0.0) ? 1u : 0u);
}

/* A coordinate in units of 2^-GUIDE_AXIS_BITS of the cube's side. */
static inline uint cell_coordinate(real x, real scale)
{
    const real side = (real)(1u << GUIDE_AXIS_BITS);
    return (uint)clamp(fma(x, scale, REAL(0.5) * side), REAL(0.0), side - REAL(1.0));
}

/* The cell of a surface point with normal n in a scene within [-extent, extent]^3. */
static inline uint cell_at(global const uint* links, real extent, real3 position, real3 n)
{
    const real scale = REAL(0.5) * (real)(1u << GUIDE_AXIS_BITS) / extent;
    const uint x = cell_coordinate(position.x, scale);
    const uint y = cell_coordinate(position.y, scale);
    const uint z = cell_coordinate(position.z, scale);
    uint bit = GUIDE_AXIS_BITS - GUIDE_GRID_BITS;
    const uint row = (cell_side(n) * GUIDE_GRID + (z >> bit)) * GUIDE_GRID + (y >> bit);
    uint link = links[row * GUIDE_GRID + (x >> bit)];
    while (!(link & GUIDE_LEAF)) {
        --bit;
        link = links[link + ((x >> bit) & 1u) + 2u * ((y >> bit) & 1u) + 4u * ((z >> bit) & 1u)];
    }
    return link & ~GUIDE_LEAF;
}

#endif
