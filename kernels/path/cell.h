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

/* The place of a coordinate in the grid. */
static inline uint cell_place(real x, real scale)
{
    return (uint)clamp(fma(x, scale, REAL(0.5) * (real)GUIDE_GRID), REAL(0.0), (real)(GUIDE_GRID - 1));
}

/* The cell of a surface point with normal n in a scene within [-extent, extent]^3. */
static inline uint cell_at(global const GuideNode* nodes, real extent, real3 position, real3 n)
{
    const real scale = REAL(0.5) * (real)GUIDE_GRID / extent;
    uint place = cell_side(n) * GUIDE_GRID + cell_place(position.z, scale);
    place = place * GUIDE_GRID + cell_place(position.y, scale);
    place = place * GUIDE_GRID + cell_place(position.x, scale);
    const float along[3] = {(float)position.x, (float)position.y, (float)position.z};
    GuideNode node = nodes[place];
    while (!(node.link & GUIDE_LEAF))
        node = nodes[GUIDE_GRID_PLACES + (node.link >> 2) + (along[node.link & 3u] < node.split ? 0u : 1u)];
    return node.link & ~GUIDE_LEAF;
}

#endif
