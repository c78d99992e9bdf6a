// SPDX-License-Identifier: Apache-2.0
// A cell's distribution of directions: bins of equal probability in the square of an octahedral map
// (Engelhardt and Dachsbacher 2008). Within a bin all places are equally likely.
#ifndef CLRT_PATH_GUIDE_BINS_H
#define CLRT_PATH_GUIDE_BINS_H

#include "numerics/vector.h"
#include "shared/guide_types.h"

/* A bin: its number, and its rectangle in units of 2^-16 of the square. */
typedef struct {
    uint number;
    uint low_x, high_x, low_y, high_y;
} GuideBin;

/* The octahedron's point |x| + |y| + |z| = 1 in a direction. */
static inline real3 bins_point(real3 direction)
{
    return direction / (fabs(direction.x) + fabs(direction.y) + fabs(direction.z));
}

/* Folds the lower half of the octahedron over the upper one, or unfolds it. */
static inline real2 bins_fold(real2 p)
{
    return (real2)(copysign(REAL(1.0) - fabs(p.y), p.x), copysign(REAL(1.0) - fabs(p.x), p.y));
}

/* Where a point of the octahedron lies in the square [0, 1]^2. */
static inline real2 bins_square(real3 point)
{
    const real2 p = point.z < REAL(0.0) ? bins_fold((real2)(point.x, point.y)) : (real2)(point.x, point.y);
    return fma(p, (real2)(REAL(0.5)), (real2)(REAL(0.5)));
}

/* The octahedron's point at a place of the square. */
static inline real3 bins_octahedron(real2 place)
{
    const real2 p = fma(place, (real2)(REAL(2.0)), (real2)(REAL(-1.0)));
    const real z = REAL(1.0) - fabs(p.x) - fabs(p.y);
    const real2 unfolded = z < REAL(0.0) ? bins_fold(p) : p;
    return vector_make(unfolded.x, unfolded.y, z);
}

/* The split of an inner node of a subtree. */
static inline uint bins_split(global const GuideCell* cell, uint subtree, uint node)
{
    const uint at = subtree * GUIDE_SUBTREE_LEAVES + node;
    return (cell->splits[at >> 1] >> (16u * (at & 1u))) & 0xffffu;
}

/* The tree of bins is gone down without branches: which child comes next is chance. In a subtree a node's
   children are 2 node + 1 and 2 node + 2. */

/* The bin at a place of the square, in units of 2^-16. */
static inline GuideBin bins_find(global const GuideCell* cell, uint x, uint y)
{
    GuideBin bin = {0u, 0u, GUIDE_SIDE, 0u, GUIDE_SIDE};
    for (uint subtree = 0u; subtree < 2u; ++subtree) {
        const uint at = subtree * (bin.number + 1u);
        uint node = 0u;
        for (uint level = 0u; level < GUIDE_SUBTREE_LEVELS; level += 2u) {
            const uint at_x = bins_split(cell, at, node);
            const bool is_right = x >= at_x;
            bin.low_x = is_right ? at_x : bin.low_x;
            bin.high_x = is_right ? bin.high_x : at_x;
            node = 2u * node + (is_right ? 2u : 1u);
            const uint at_y = bins_split(cell, at, node);
            const bool is_above = y >= at_y;
            bin.low_y = is_above ? at_y : bin.low_y;
            bin.high_y = is_above ? bin.high_y : at_y;
            node = 2u * node + (is_above ? 2u : 1u);
        }
        bin.number = bin.number * GUIDE_SUBTREE_LEAVES + node - (GUIDE_SUBTREE_LEAVES - 1u);
    }
    return bin;
}

/* Bin `number`. */
static inline GuideBin bins_take(global const GuideCell* cell, uint number)
{
    GuideBin bin = {number, 0u, GUIDE_SIDE, 0u, GUIDE_SIDE};
    for (uint subtree = 0u; subtree < 2u; ++subtree) {
        const uint at = subtree * (number / GUIDE_SUBTREE_LEAVES + 1u);
        /* The bits of the number say which way it goes, the highest first. */
        const uint leaf = subtree == 0u ? number / GUIDE_SUBTREE_LEAVES : number % GUIDE_SUBTREE_LEAVES;
        for (uint level = 0u; level < GUIDE_SUBTREE_LEVELS; level += 2u) {
            const uint at_x =
                bins_split(cell, at, (1u << level) - 1u + (leaf >> (GUIDE_SUBTREE_LEVELS - level)));
            const bool is_right = ((leaf >> (GUIDE_SUBTREE_LEVELS - 1u - level)) & 1u) != 0u;
            bin.low_x = is_right ? at_x : bin.low_x;
            bin.high_x = is_right ? bin.high_x : at_x;
            const uint at_y =
                bins_split(cell, at, (2u << level) - 1u + (leaf >> (GUIDE_SUBTREE_LEVELS - 1u - level)));
            const bool is_above = ((leaf >> (GUIDE_SUBTREE_LEVELS - 2u - level)) & 1u) != 0u;
            bin.low_y = is_above ? at_y : bin.low_y;
            bin.high_y = is_above ? bin.high_y : at_y;
        }
    }
    return bin;
}

/* The place in a bin that a pair of numbers in (0, 1) chooses. */
static inline real2 bin_place(const GuideBin* bin, real2 u)
{
    const real2 low = (real2)((real)bin->low_x, (real)bin->low_y);
    const real2 size = (real2)((real)(bin->high_x - bin->low_x), (real)(bin->high_y - bin->low_y));
    return fma(u, size, low) * (REAL(1.0) / (real)GUIDE_SIDE);
}

/* Area of the square [-1, 1]^2 in units of a bin's, over 4 and over the number of bins. */
#define BINS_DENSITY ((real)GUIDE_SIDE * (real)GUIDE_SIDE / (REAL(4.0) * (real)GUIDE_BINS))

/* Density per steradian of a bin's directions, at one with the point `point` of the octahedron: the square
   [-1, 1]^2 is the octahedron's projection along z, so dw = dx dy / |point|^3. */
static inline real bin_pdf_w(const GuideBin* bin, real3 point)
{
    const real area = (real)(bin->high_x - bin->low_x) * (real)(bin->high_y - bin->low_y);
    const real square = vector_dot(point, point);
    return BINS_DENSITY * square * real_sqrt(square) / area;
}

#endif
