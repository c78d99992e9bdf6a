// SPDX-License-Identifier: Apache-2.0
// Choosing a light by what it may send to a vertex (Conty Estevez and Kulla 2018). A light's probability is
// the width of an interval: the root has 2^63 numbers, every pair of the tree cuts its interval in two by the
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
    uint link;      /* to the pair below, or to a leaf: LIGHT_LINK_* */
    bool is_narrow; /* as seen from the vertex: what is below is told apart by power alone */
} LightInterval;

#define LIGHT_TREE_WIDTH (1ul << 63)

/* Lights in a sphere that looks smaller than this (squared sine of half its angle) are much alike to the
   vertex: telling them apart costs more than it gains. Measured: 0.02 is dearer, 1 noisier. */
#define LIGHT_NARROW_SIZE 0.3f

/* Cosines count as larger by this, so that no rounding puts a light behind a horizon that it shines over. */
#define LIGHT_COS_MARGIN 1.52587890625e-5f

/* Nearer than this (squared, in the normalised frame) all lights count as equally near. */
#define LIGHT_NEAREST_SQUARED 1e-16f

/* How an interval is cut in two. */
typedef struct {
    ulong first_width; /* more than all of it where neither child can add anything */
    int2 is_narrow;    /* as LightInterval's, of the children; not 0: true */
} LightCut;

/* Bounds of what the lights below a pair's children send to the vertex if nothing is in between, but for one
   factor: power times the cosines at the vertex and at the light over the squared distance, or over the
   squared radius of their sphere where that is more. Of cosines, those of the centre and of the nearest
   normal in the cone, plus the sine of half the sphere's angle, at most 1: that is 0 where the largest cosine
   of the sphere's points is, and only there, so a child is 0 only if none of its lights can add anything. */
static inline float2 light_importances(global const LightPair* pair, const LightView* view, int2* is_narrow)
{
    const float3 p = convert_float3(view->position);
    const float3 n = convert_float3(view->normal);
    const float2 dx = pair->x - p.x, dy = pair->y - p.y, dz = pair->z - p.z;
    const float2 square = fmax(dx * dx + dy * dy + dz * dz, LIGHT_NEAREST_SQUARED);
    const float2 distance = real_sqrt(square);
    const float2 radius = pair->radius;
    const float2 radius_squared = radius * radius;
    const float2 margin = fma(distance, LIGHT_COS_MARGIN, radius);
    /* Cosines times the distance. */
    const bool is_open = n.x == 0.0f && n.y == 0.0f && n.z == 0.0f;
    const float2 above = is_open ? distance : dx * n.x + dy * n.y + dz * n.z;
    const float2 received = fmin(fmax(above + margin, 0.0f), distance);
    const float2 ahead = -(dx * pair->axis_x + dy * pair->axis_y + dz * pair->axis_z);
    const int2 both_sides = (int2)(pair->first, pair->second) << 1;
    const float2 along = select(ahead, fabs(ahead), both_sides);
    const float2 across = real_sqrt(fmax(square - along * along, 0.0f));
    const float2 cos_spread = pair->cos_spread;
    const float2 sin_spread = real_sqrt(fmax(1.0f - cos_spread * cos_spread, 0.0f));
    const float2 turned = along * cos_spread + across * sin_spread;
    const float2 nearest = select(turned, distance, along >= cos_spread * distance);
    const float2 emitted = fmin(fmax(nearest + margin, 0.0f), distance);
    *is_narrow = radius_squared < LIGHT_NARROW_SIZE * square;
    return pair->power * (received * emitted) / (square * fmax(square, radius_squared));
}

/* Cuts an interval by importance. A child with any has at least 2^-24 of it. */
static inline LightCut light_cut_by_importance(global const LightPair* pair, const LightView* view,
                                               ulong width)
{
    LightCut cut;
    const float2 importances = light_importances(pair, view, &cut.is_narrow);
    const float sum = importances.x + importances.y;
    const ulong share = clamp((uint)(importances.x / sum * 16777216.0f), 1u, 16777215u);
    cut.first_width = mul_hi(width, share << 40);
    if (importances.x == 0.0f || importances.y == 0.0f)
        cut.first_width = importances.x == 0.0f ? 0ul : width;
    if (!(sum > 0.0f)) /* or not a number, where the vertex is none */
        cut.first_width = ~0ul;
    return cut;
}

/* Cuts an interval: by power where the vertex does not tell its lights apart. */
static inline LightCut light_cut(global const LightPair* pair, const LightView* view,
                                 const LightInterval* interval)
{
    if (!interval->is_narrow)
        return light_cut_by_importance(pair, view, interval->width);
    const LightCut cut = {mul_hi(interval->width, (ulong)pair->first_share << 40), (int2)(-1)};
    return cut;
}

/* Goes from an interval to that of one of its children. */
static inline void light_enter(global const LightPair* pair, const LightCut* cut, bool second,
                               LightInterval* interval)
{
    interval->low += second ? cut->first_width : 0ul;
    interval->width = second ? interval->width - cut->first_width : cut->first_width;
    interval->link = second ? pair->second : pair->first;
    interval->is_narrow = (second ? cut->is_narrow.y : cut->is_narrow.x) != 0;
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
        global const LightPair* pair = scene->light_pairs + (interval.link & LIGHT_LINK_INDEX);
        const LightCut cut = light_cut(pair, view, &interval);
        if (cut.first_width > interval.width) {
            interval.width = 0ul;
            return interval;
        }
        light_enter(pair, &cut, number - interval.low >= cut.first_width, &interval);
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
        global const LightPair* pair = scene->light_pairs + (interval.link & LIGHT_LINK_INDEX);
        const LightCut cut = light_cut(pair, view, &interval);
        if (cut.first_width > interval.width)
            return 0ul;
        light_enter(pair, &cut, (trail & 1ul) != 0ul, &interval);
        trail >>= 1;
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
