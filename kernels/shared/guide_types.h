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

/* A node of the trees. Their upper levels halve the scene's box across x, y and z by turns, so a grid tells
   where to start: its places hold copies of the nodes of that level, or of a leaf above. The nodes stand
   behind the places. */
typedef struct {
    u32 link;    /* of a leaf: GUIDE_LEAF and its cell; else 4 times its first child, the other one is next to
                    it, and the axis */
    float split; /* positions below it along the axis belong to the first child */
    u32 unused0, unused1;
} GuideNode;
ASSERT_SIZE(GuideNode, 16);
#define GUIDE_LEAF 0x80000000u
#define GUIDE_GRID 16 /* places along each axis; a power of two */
#define GUIDE_GRID_PLACES (GUIDE_SIDES * GUIDE_GRID * GUIDE_GRID * GUIDE_GRID)
#define GUIDE_NODES (GUIDE_GRID_PLACES + 2 * GUIDE_CELLS)

/* Bins of directions: rectangles of the octahedral map's square, all with the same probability. They are the
   leaves of a complete binary tree that halves the probability at every level, across x and y by turns; so
   directions are told apart where there is much light. */
#define GUIDE_LEVELS 8
#define GUIDE_BINS 256

/* Coordinates in the square are multiples of 2^-16: the square's side in them. */
#define GUIDE_SIDE 65536u

typedef struct {
    float share;                /* probability of sampling a direction here instead of by the BSDF */
    float radiance;             /* that a path finds behind a vertex, the mean; 0 where too little is known */
    u32 splits[GUIDE_BINS / 2]; /* of the inner nodes, the root first and its children next, two in a word: what
                                   is below belongs to the first child */
    u32 unused0, unused1;
} GuideCell;
ASSERT_SIZE(GuideCell, 528);

/* Sums of a cell, 64 bits each: of the bins, and the number of vertices, whether they found light or not. */
#define GUIDE_SUM_VERTICES GUIDE_BINS
#define GUIDE_SUMS (GUIDE_BINS + 1)

/* Sum of a bin: the number of records of light in the upper bits, and below them their sum in quanta of the
   film (src/film/film.h). A record counts as at most 2^GUIDE_RECORD_BITS quanta: outliers would rule a bin. */
#define GUIDE_SUM_BITS 44
#define GUIDE_RECORD_BITS 30

SHARED_END

#endif
