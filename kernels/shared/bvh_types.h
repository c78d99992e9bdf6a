// SPDX-License-Identifier: Apache-2.0
// Node layouts of the bounding volume hierarchy. All are trees over the same triangles; a layout is chosen
// with -DBVH_LAYOUT when a kernel is compiled.
#ifndef CLRT_SHARED_BVH_TYPES_H
#define CLRT_SHARED_BVH_TYPES_H

#include "types.h"

#define BVH_LAYOUT_BVH8 8 /* eight children a node, tested with float8: for CPU devices */
#define BVH_LAYOUT_BVH2 2 /* pairs of children in 64 bytes (Aila and Laine 2009): for GPUs */
#define BVH_LAYOUT_CWBVH 80 /* eight quantised children in 80 bytes (Ylitie et al. 2017): for GPUs */

#define BVH_LEAF_BIT 0x80000000u

/* Where meshes are shared there is a tree over each, in the frame of its prototype, and one over the scene,
   whose leaves hold triangles or a single instance. The trees lie in the same arrays one after the other, the
   scene's first; the roots say where those of the prototypes begin. bvh8: the child word of an instance
   is its index with this bit and BVH_LEAF_BIT; bvh2: with this bit alone. cwbvh: a leaf triangle whose word
   BVH_INSTANCE_WORD is not 0 is that instance. */
#define BVH_INSTANCE_BIT 0x40000000u
#define BVH_INSTANCE_WORD 7

#define BVH_MAX_DEPTH 64 /* levels of the binary tree; the builder guarantees it, stacks are sized by it */

/* An empty child has lower = +BVH_EMPTY, upper = -BVH_EMPTY: no ray enters it. Products with the clamped
   reciprocal direction (at most 1e18) stay finite. */
#define BVH_EMPTY 1e18f

/* bvh8 node: 64 words.
   Words 0..47: planes in the order lower x, upper x, lower y, upper y, lower z, upper z, eight floats each.
   Words 48..55: children: a node's index, or BVH_LEAF_BIT | index of a triangle block. Empty: BVH_LEAF_BIT.
   Words 56..63: unused, 0 (keeps a node at four cache lines). */
#define BVH8_WIDTH 8
#define BVH8_NODE_WORDS 64
#define BVH8_CHILD_WORD 48

/* bvh8 leaf: one block of up to eight triangles, 80 words.
   Words 0..71: [axis x,y,z][corner 0,1,2][lane], words 72..79: triangle index by lane.
   Unused lanes hold zeros (a degenerate triangle, never hit) and NO_INDEX. */
#define BVH8_BLOCK_WORDS 80
#define BVH8_BLOCK_ID_WORD 72

/* bvh2 node: 16 words: lower x, upper x, lower y, upper y of child 0; the same of child 1; lower z, upper z
   of child 0, of child 1; child 0, child 1 as in bvh8 but a leaf's low 31 bits index the leaf triangles;
   triangle count of child 0, of child 1 (0 for an inner or an empty child). */
#define BVH2_NODE_WORDS 16
#define BVH2_CHILD_WORD 12
#define BVH2_COUNT_WORD 14
#define BVH2_LEAF_TRIANGLES 4 /* most triangles a leaf holds */

/* Leaf triangle of bvh2 and cwbvh: 12 words: corner 0 xyz, triangle index; corner 1 xyz, 0; corner 2 xyz,
   0. An instance of cwbvh: zeros but for BVH_INSTANCE_WORD. */
#define LEAF_TRIANGLE_WORDS 12

/* Where triangles move while the shutter is open, leaves have a second array: at the places of the corners,
   how far each goes (floats). */

/* cwbvh node: 20 words, in parts of which bytes stand in the order of memory.
   Words 0..2: origin of the node's lattice (floats).
   Word 3: by byte, exponents of the lattice's steps along x, y, z plus CWBVH_EXPONENT_BIAS; a mask of the
   slots that hold inner nodes.
   Words 4, 5: index of the first child that is an inner node, the others follow by ascending slot; of the
   first leaf triangle of this node.
   Words 6, 7: a byte a slot. Inner node: CWBVH_INNER_META | slot. Leaf of n triangles: 2^n - 1 in the upper
   three bits, the place of the first, counted from the node's first, in the lower five. Empty: 0.
   Words 8..19: planes as multiples of the step from the origin, a byte a slot: lower x, lower y, lower z,
   upper x, upper y, upper z. */
#define CWBVH_NODE_WORDS 20
#define CWBVH_EXPONENT_WORD 3
#define CWBVH_CHILD_WORD 4
#define CWBVH_TRIANGLE_WORD 5
#define CWBVH_META_WORD 6
#define CWBVH_LOWER_WORD 8
#define CWBVH_UPPER_WORD 14
#define CWBVH_EXPONENT_BIAS 127    /* a float's: the byte moved up by 23 bits is the step */
#define CWBVH_SMALLEST_EXPONENT -60 /* its product with a reciprocal direction below 2^60 is normal */
#define CWBVH_INNER_META 0x38u     /* one bit of three as for a leaf of one triangle, and place 24 */
#define CWBVH_COUNT_SHIFT 5
#define CWBVH_LEAF_TRIANGLES 3 /* most triangles a leaf holds: 24 in all have a bit of a word */

/* Levels of wide nodes; the collapse guarantees it. BVH_MAX_DEPTH - 1 levels of inner binary nodes, three by
   three. */
#define CWBVH_MAX_LEVELS ((BVH_MAX_DEPTH + 1) / 3)

#endif
