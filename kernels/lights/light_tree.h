// SPDX-License-Identifier: Apache-2.0
// Choosing a light by what it may send to a vertex (Conty Estevez and Kulla 2018). A light's probability is
// the width of an interval: the root has 2^63 numbers, every node of the tree cuts its interval by the
// importances of its children, and a random number chooses the light in whose interval it lies. So the
// probabilities add up to 1 to the last bit, and a number is spent on no level: what is left of it chooses
// the point on the light. All of it is float and integer arithmetic, the double kernels' too.
#ifndef CLRT_LIGHTS_LIGHT_TREE_H
#define CLRT_LIGHTS_LIGHT_TREE_H

#include "geometry/scene.h"

/* Whence lights are looked at. */
typedef struct {
    real3 position;
    real3 normal; /* all light that counts comes from above its horizon; 0: light from anywhere counts */
} LightView;

/* An interval of a light or of several. */
typedef struct {
    ulong low, width;
    uint link;      /* to the node below, or to a leaf: LIGHT_LINK_* */
    bool is_narrow; /* as seen from the vertex: what is below is told apart by power alone */
} LightInterval;

#define LIGHT_TREE_WIDTH (1ul << 63)

/* Lights in a sphere that looks smaller than this (squared sine of half its angle) are much alike to the
   vertex: telling them apart gains nothing. Measured: with 0.05 the efficiency is the same. */
#define LIGHT_NARROW_SIZE 0.3f

/* Cosines count as larger by this, so that no rounding puts a light behind a horizon that it shines over. */
#define LIGHT_COS_MARGIN 1.52587890625e-5f

/* Nearer than this (squared, in the normalised frame) all lights count as equally near. */
#define LIGHT_NEAREST_SQUARED 1e-16f

/* What is dealt of LIGHT_SHARES in proportion. Rounding makes at most 14 more of it: 7 children that get 1
   for nothing, and errors of 2^-24 in the sum (3), the quotient and the product. */
#define LIGHT_SHARES_DEALT ((float)(LIGHT_SHARES - 24))

/* Bounds of what the lights below the children send to the vertex if nothing is in between, but for one
   factor: power times the cosines at the vertex and at the light over the squared distance, or over the
   squared radius of their sphere where that is more. Of cosines, those of the centre and of the cone's axis,
   plus the sine of half the sphere's angle and, at the light, the chord of the cone's half angle, at most 1.
   No cosine of a point and normal below is larger, so a child is 0 only if none of its lights can add
   anything. */
static inline float8 light_importances(global const LightNode* node, const LightView* view)
{
    const float3 p = convert_float3(view->position);
    const float3 n = convert_float3(view->normal);
    const float8 dx = vload8(0, node->x) - p.x, dy = vload8(0, node->y) - p.y, dz = vload8(0, node->z) - p.z;
    const float8 square = fmax(fma(dx, dx, fma(dy, dy, dz * dz)), LIGHT_NEAREST_SQUARED);
    const float8 distance = real_sqrt(square);
    const float8 radius = vload8(0, node->radius);
    const float8 intensity = vload8(0, node->power) / (square * fmax(square, radius * radius));
    const float8 margin = fma(distance, LIGHT_COS_MARGIN, radius);
    /* Cosines times the distance. */
    const bool is_open = n.x == 0.0f && n.y == 0.0f && n.z == 0.0f;
    const float8 above = is_open ? distance : fma(dx, n.x, fma(dy, n.y, dz * n.z));
    const float8 received = fmin(fmax(above + margin, 0.0f), distance);
    const float8 behind =
        fma(dx, vload8(0, node->axis_x), fma(dy, vload8(0, node->axis_y), dz * vload8(0, node->axis_z)));
    const int8 both_sides = as_int8(vload8(0, node->link) << 1u);
    const float8 ahead = select(-behind, fabs(behind), both_sides);
    const float8 spread = fma(distance, vload8(0, node->chord), margin);
    const float8 emitted = fmin(fmax(ahead + spread, 0.0f), distance);
    return intensity * (received * emitted);
}

/* Sums of the lanes up to each. */
static inline int8 light_sums(int8 x)
{
    x += (int8)(0, x.s012, x.s3456);
    x += (int8)(0, 0, x.s01, x.s2345);
    return x + (int8)((int4)(0), x.s0123);
}

/* Shares of a node's children in proportion to their importances, summed up to each. A child with any has at
   least 1. 0 where none has, or where the vertex is none. */
static inline int8 light_divide(global const LightNode* node, const LightView* view)
{
    const float8 importances = light_importances(node, view);
    const float4 halves = importances.lo + importances.hi;
    const float sum = (halves.x + halves.y) + (halves.z + halves.w);
    if (!(sum > 0.0f))
        return (int8)(0);
    const int8 shares = convert_int8(importances / sum * LIGHT_SHARES_DEALT);
    return light_sums(select((int8)(0), max(shares, 1), importances > 0.0f));
}

/* How an interval is cut. */
typedef struct {
    ulong width;
    int ends[LIGHT_NODE_WIDTH]; /* of the children's shares; the last one's is that of all */
} LightCut;

/* Cuts an interval by importance, or by power where the vertex does not tell its lights apart. */
static inline LightCut light_cut(global const LightNode* node, const LightView* view,
                                 const LightInterval* interval)
{
    LightCut cut;
    cut.width = interval->width;
    vstore8(interval->is_narrow ? vload8(0, node->end) : light_divide(node, view), 0, cut.ends);
    return cut;
}

static inline bool light_cut_is_dark(const LightCut* cut)
{
    return cut->ends[LIGHT_NODE_WIDTH - 1] == 0;
}

/* Where in the interval a share ends. What rounding leaves is the last child's that has any. */
static inline ulong light_cut_at(const LightCut* cut, int end)
{
    if (end == cut->ends[LIGHT_NODE_WIDTH - 1])
        return cut->width;
    const ulong high = cut->width >> LIGHT_SHARE_BITS, low = cut->width & (LIGHT_SHARES - 1);
    return high * (ulong)end + (low * (ulong)end >> LIGHT_SHARE_BITS);
}

static inline ulong light_cut_begin(const LightCut* cut, uint child)
{
    return child == 0u ? 0ul : light_cut_at(cut, cut->ends[child - 1u]);
}

/* The child in whose part of the interval a number lies that is `rest` above its beginning. */
static inline uint light_cut_child(const LightCut* cut, ulong rest)
{
    /* It, or next to it: floats are good to 2^-22. All ends are looked at, where to stop nobody predicts. */
    const float share = (float)rest / (float)cut->width * (float)LIGHT_SHARES;
    const int within = min((int)share, cut->ends[LIGHT_NODE_WIDTH - 1] - 1);
    uint child = 0u;
    for (uint i = 0u; i < LIGHT_NODE_WIDTH; ++i)
        child += cut->ends[i] <= within ? 1u : 0u;
    while (rest < light_cut_begin(cut, child))
        --child;
    while (rest >= light_cut_at(cut, cut->ends[child]))
        ++child;
    return child;
}

/* Whether a child's lights look much alike to the vertex. */
static inline bool light_is_narrow(global const LightNode* node, uint child, const LightView* view)
{
    const float3 p = convert_float3(view->position);
    const float3 d = (float3)(node->x[child], node->y[child], node->z[child]) - p;
    const float radius = node->radius[child];
    return radius * radius < LIGHT_NARROW_SIZE * (d.x * d.x + d.y * d.y + d.z * d.z);
}

/* Goes from an interval to that of one of its children. */
static inline void light_enter(global const LightNode* node, const LightView* view, const LightCut* cut,
                               uint child, LightInterval* interval)
{
    const ulong begin = light_cut_begin(cut, child);
    interval->low += begin;
    interval->width = light_cut_at(cut, cut->ends[child]) - begin;
    interval->link = node->link[child];
    interval->is_narrow = interval->is_narrow || light_is_narrow(node, child, view);
}

static inline LightInterval light_tree_root(void)
{
    const LightInterval root = {0ul, LIGHT_TREE_WIDTH, 0u, false};
    return root;
}

/* The part of a leaf's interval that belongs to the lights before the one that ends at `end`. */
static inline ulong light_leaf_width(ulong width, uint end)
{
    return end == LIGHT_LEAF_END ? width : mul_hi(width, (ulong)end << 32);
}

/* The light that a number below LIGHT_TREE_WIDTH chooses, and its interval; the width is 0 where no light can
   add anything. */
static CLRT_NOINLINE LightInterval light_tree_choose(const Scene* scene, const LightView* view, ulong number)
{
    LightInterval interval = light_tree_root();
    while (!(interval.link & LIGHT_LINK_LEAF)) {
        global const LightNode* node = scene->light_nodes + (interval.link & LIGHT_LINK_INDEX);
        const LightCut cut = light_cut(node, view, &interval);
        if (light_cut_is_dark(&cut)) {
            interval.width = 0ul;
            return interval;
        }
        light_enter(node, view, &cut, light_cut_child(&cut, number - interval.low), &interval);
    }
    /* Within the leaf, by fixed shares. */
    const ulong rest = number - interval.low;
    uint light = interval.link & LIGHT_LINK_INDEX;
    ulong begin = 0ul;
    ulong end = light_leaf_width(interval.width, scene->light_places[light].end);
    while (rest >= end) {
        begin = end;
        end = light_leaf_width(interval.width, scene->light_places[++light].end);
    }
    interval.low += begin;
    interval.width = end - begin;
    interval.link = light;
    return interval;
}

/* The width of a light's interval, as light_tree_choose cuts it. */
static CLRT_NOINLINE ulong light_tree_width(const Scene* scene, const LightView* view, uint light)
{
    global const LightPlace* place = scene->light_places + light;
    if (place->end == 0u) /* it is not in the tree */
        return 0ul;
    ulong trail = (ulong)place->trail_high << 32 | place->trail_low;
    LightInterval interval = light_tree_root();
    while (!(interval.link & LIGHT_LINK_LEAF)) {
        global const LightNode* node = scene->light_nodes + (interval.link & LIGHT_LINK_INDEX);
        const LightCut cut = light_cut(node, view, &interval);
        if (light_cut_is_dark(&cut))
            return 0ul;
        light_enter(node, view, &cut, (uint)trail & (LIGHT_NODE_WIDTH - 1u), &interval);
        trail >>= LIGHT_TRAIL_BITS;
    }
    const bool is_first = light == (interval.link & LIGHT_LINK_INDEX);
    const ulong begin = is_first ? 0ul : light_leaf_width(interval.width, (place - 1)->end);
    return light_leaf_width(interval.width, place->end) - begin;
}

/* The probability that an interval stands for. */
static inline real light_tree_probability(ulong width)
{
    return (real)width * REAL(1.0842021724855044e-19); /* 2^-63 */
}

/* The word that is left of a number after it chose an interval of this width and lies `rest` above its
   beginning. */
static inline uint light_tree_rest(ulong rest, ulong width)
{
    const ulong shift = clz(width);
    return (uint)min((rest << shift) / ((width << shift) >> 32), 0xfffffffful);
}

#endif
