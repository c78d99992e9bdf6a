// SPDX-License-Identifier: Apache-2.0
// What path guiding keeps (kernels/path/guide.h): for each cell of space a distribution of directions, and
// the sums that it is learnt from.
#ifndef CLRT_SHARED_GUIDE_TYPES_H
#define CLRT_SHARED_GUIDE_TYPES_H

#include "types.h"

SHARED_BEGIN

/* Cells are the leaves of six trees over space, one for each side that a surface can face. */
#define GUIDE_SIDES 6
#define GUIDE_CELLS 16384 /* at most */

/* The trees halve the cube that holds the scene across x, y and z, again and again. On the device they are
   octrees in an array of links: GUIDE_LEAF and a cell, or where the eight links of a node's children stand, the
   low half along x before the high one, then likewise y and z. A grid at its beginning tells where to start:
   x runs first, then y, z and the sides. */
#define GUIDE_LEAF 0x80000000u
#define GUIDE_GRID_BITS 4 /* places along each axis, as a power of two */
#define GUIDE_GRID 16
#define GUIDE_GRID_PLACES (GUIDE_SIDES * GUIDE_GRID * GUIDE_GRID * GUIDE_GRID)
#define GUIDE_CHILDREN 8
#define GUIDE_LINKS (GUIDE_GRID_PLACES + GUIDE_CHILDREN * GUIDE_CELLS)

/* No cell is smaller than 2^-GUIDE_AXIS_BITS of the cube's side. */
#define GUIDE_AXIS_BITS 16

/* Bins of directions: rectangles of the octahedral map's square, all with the same probability. They are the
   leaves of a complete binary tree that halves the probability at every level, across x and y by turns; so
   directions are told apart where there is much light. */
#define GUIDE_LEVELS 8
#define GUIDE_BINS 256

/* Coordinates in the square are multiples of 2^-16: the square's side in them. */
#define GUIDE_SIDE 65536u

/* The tree is cut into subtrees of GUIDE_SUBTREE_LEVELS levels, one on top and one below each of its leaves: a
   descent reads two cache lines, and what is known of the cell is in the first. */
#define GUIDE_SUBTREE_LEVELS 4
#define GUIDE_SUBTREE_LEAVES 16
#define GUIDE_SUBTREES (1 + GUIDE_SUBTREE_LEAVES)

typedef struct {
    float share;    /* probability of sampling a direction here instead of by the BSDF */
    float radiance; /* that a path finds behind a vertex, the mean; 0 where too little is known; more where
                       light paths teach */
    float light;    /* what power counts that light paths bring (guide_learn_light): times the area of a side
                       of the cube */
    u32 unused[5];
    /* Splits of the inner nodes of each subtree, its root first and that one's children next, two in a word:
       what is below belongs to the first child. */
    u32 splits[GUIDE_SUBTREES * GUIDE_SUBTREE_LEAVES / 2];
} GuideCell;
ASSERT_SIZE(GuideCell, 576);

/* Sums of a cell, 64 bits each: of the bins, and the number of vertices, whether they found light or not. */
#define GUIDE_SUM_VERTICES GUIDE_BINS
#define GUIDE_SUMS (GUIDE_BINS + 1)

/* Sum of a bin: the number of records of light in the upper bits, and below them their sum in quanta of the
   film (src/film/film.h). A record counts as at most 2^GUIDE_RECORD_BITS quanta: outliers would rule a bin. */
#define GUIDE_SUM_BITS 44
#define GUIDE_RECORD_BITS 30

/* Gains (kernels/path/guide_gain.h) are summed in these units for each tile of 8 x 8 pixels, 64 bits each.
   One counts as at most GUIDE_LARGEST_GAIN: 2^23 of them fit a sum. */
#define GUIDE_GAIN_UNITS 1048576
#define GUIDE_LARGEST_GAIN 1048576

SHARED_END

#endif
