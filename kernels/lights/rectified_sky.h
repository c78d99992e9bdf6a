// SPDX-License-Identifier: Apache-2.0
// What of the sky is seen through a rectangle, exactly as much as a rectified map resolves: Bitterli, Novak
// and Jarosz 2015, "Portal-Masked Environment Map Sampling". A rectified map is seen along an axis, with the
// directions a U + b V + axis at (m(a), m(b)), m(a) = a / (1 + |a|), so that a rectangle across the axis with
// edges along U and V is one in the map from wherever it is seen. Sums over the map's texels are integers
// (src/scene/rectified_sky.h), whose differences are exact; texels are found by sums in floats, whose
// roundings move up to 2^-23 of what a window shows from a texel to its neighbour.
#ifndef CLRT_LIGHTS_RECTIFIED_SKY_H
#define CLRT_LIGHTS_RECTIFIED_SKY_H

#include "geometry/scene.h"
#include "numerics/real_functions.h"

/* All columns of a window together. */
#define RECTIFIED_ALL_COLUMNS 0xffffffffu

/* Slopes beyond are those of a plane's horizon. */
#define RECTIFIED_STEEPEST REAL(1e7)

/* A rectangle in a rectified map, in texels from the first one that it touches. */
typedef struct {
    global const uint* sums; /* at the lower corner of the first texel */
    uint first_x, first_y;   /* that texel */
    uint last_x, last_y;     /* the last one, from the first */
    real2 low, high;
} RectifiedWindow;

/* Map coordinates in [0, RECTIFIED_SIZE] of slopes. */
static inline real4 rectified_sky_coordinates(real4 a)
{
    const real4 steepness = fmin(fabs(a), (real4)(RECTIFIED_STEEPEST));
    return fma(copysign(steepness / (REAL(1.0) + steepness), a), REAL(0.5), REAL(0.5)) * (real)RECTIFIED_SIZE;
}

static inline real rectified_sky_slope(real coordinate)
{
    const real m = fma(coordinate, REAL(2.0) / (real)RECTIFIED_SIZE, REAL(-1.0));
    return m / fmax(REAL(1.0) - fabs(m), REAL(1.0) / RECTIFIED_STEEPEST);
}

/* The window between slopes. `map`: the sums of a whole map. */
static inline RectifiedWindow rectified_sky_window(global const uint* map, real2 low, real2 high)
{
    const real4 rounded = rectified_sky_coordinates((real4)(low, high));
    const real4 edges = (real4)(rounded.xy, fmax(rounded.zw, rounded.xy));
    const uint4 texels = min(convert_uint4(edges), (uint4)(RECTIFIED_SIZE - 1u));
    RectifiedWindow window;
    window.first_x = texels.x;
    window.first_y = texels.y;
    window.last_x = texels.z - texels.x;
    window.last_y = texels.w - texels.y;
    window.low = edges.xy - (real2)((real)texels.x, (real)texels.y);
    window.high = edges.zw - (real2)((real)texels.x, (real)texels.y);
    window.sums = map + window.first_y * (RECTIFIED_SIZE + 1u) + window.first_x;
    return window;
}

/* Sums of the columns below one, of all rows of the map below the first row of a window, the second, the last
   and the one behind it. */
static inline uint4 rectified_sky_column(const RectifiedWindow* window, uint column)
{
    global const uint* first = window->sums + column;
    global const uint* last = first + window->last_y * (RECTIFIED_SIZE + 1u);
    return (uint4)(first[0], first[RECTIFIED_SIZE + 1u], last[0], last[RECTIFIED_SIZE + 1u]);
}

/* How much is seen of the first row, of those between, and of the last one. */
static inline real3 rectified_sky_rows(const RectifiedWindow* window)
{
    const real last = (real)window->last_y;
    return window->last_y == 0u ? (real3)(window->high.y - window->low.y, REAL(0.0), REAL(0.0))
                                : (real3)(REAL(1.0) - window->low.y, REAL(1.0), window->high.y - last);
}

/* What is seen of the columns between two. */
static inline real rectified_sky_between(uint4 from, uint4 to, real3 rows)
{
    const uint4 sums = to - from;
    return (real)(sums.y - sums.x) * rows.x + (real)(sums.z - sums.y) * rows.y +
           (real)(sums.w - sums.z) * rows.z;
}

/* What is seen of the columns below `count` or, of one column, of the rows below it in full. */
static inline real rectified_sky_sum(const RectifiedWindow* window, uint column, uint count)
{
    if (column == RECTIFIED_ALL_COLUMNS)
        return rectified_sky_between(rectified_sky_column(window, 0u), rectified_sky_column(window, count),
                                     rectified_sky_rows(window));
    global const uint* low = window->sums + column;
    global const uint* high = low + count * (RECTIFIED_SIZE + 1u);
    return (real)((high[1] - high[0]) - (low[1] - low[0]));
}

/* A row of texels of which [low, high] is seen, from somewhere in the first to somewhere in the last. */
typedef struct {
    uint column; /* whose rows they are; RECTIFIED_ALL_COLUMNS: columns */
    uint last;
    real low, high;
    real end_of_first, begin_of_last, end_of_last; /* sums in full */
} RectifiedRow;

static inline RectifiedRow rectified_sky_row(const RectifiedWindow* window, uint column, uint last, real low,
                                             real high)
{
    RectifiedRow row = {column, last, low, high, REAL(0.0), REAL(0.0), REAL(0.0)};
    row.end_of_first = rectified_sky_sum(window, column, 1u);
    row.begin_of_last = last == 0u ? REAL(0.0) : rectified_sky_sum(window, column, last);
    row.end_of_last = last == 0u ? row.end_of_first : rectified_sky_sum(window, column, last + 1u);
    return row;
}

/* What is seen of the first texel, and of all but the last. */
static inline real rectified_sky_first(const RectifiedRow* row)
{
    return row->end_of_first * ((row->last == 0u ? row->high : REAL(1.0)) - row->low);
}

static inline real rectified_sky_but_last(const RectifiedRow* row)
{
    return rectified_sky_first(row) + (row->begin_of_last - row->end_of_first);
}

/* What is seen of all. */
static inline real rectified_sky_seen(const RectifiedRow* row)
{
    return row->last == 0u ? rectified_sky_first(row)
                           : rectified_sky_but_last(row) + (row->end_of_last - row->begin_of_last) *
                                                               (row->high - (real)row->last);
}

/* The columns of a window. */
static inline RectifiedRow rectified_sky_columns(const RectifiedWindow* window)
{
    return rectified_sky_row(window, RECTIFIED_ALL_COLUMNS, window->last_x, window->low.x, window->high.x);
}

/* What is seen through a window, in units of the sums. */
static inline real rectified_sky_total(const RectifiedWindow* window)
{
    const real3 rows = rectified_sky_rows(window);
    const uint4 begin = rectified_sky_column(window, 0u), second = rectified_sky_column(window, 1u);
    const real first = rectified_sky_between(begin, second, rows);
    if (window->last_x == 0u)
        return first * (window->high.x - window->low.x);
    const uint4 last = rectified_sky_column(window, window->last_x);
    const uint4 end = rectified_sky_column(window, window->last_x + 1u);
    return first * (REAL(1.0) - window->low.x) + rectified_sky_between(second, last, rows) +
           rectified_sky_between(last, end, rows) * (window->high.x - (real)window->last_x);
}

/* Chooses a texel of a row with the probability of what is seen of it, and a place in it evenly. */
static inline real rectified_sky_choose(const RectifiedWindow* window, const RectifiedRow* row, real u,
                                        uint* texel)
{
    *texel = 0u;
    const real first = rectified_sky_first(row), but_last = rectified_sky_but_last(row);
    if (row->last == 0u)
        return fma(u, row->high - row->low, row->low);
    const real at = u * rectified_sky_seen(row);
    if (at < first)
        return fmin(row->low + at / row->end_of_first, REAL(1.0));
    if (at >= but_last) {
        *texel = row->last;
        return fmin((real)row->last + (at - but_last) / (row->end_of_last - row->begin_of_last), row->high);
    }
    const real target = at - first + row->end_of_first;
    uint low = 1u, high = row->last;
    real below = row->end_of_first, above = row->begin_of_last;
    for (bool halves = false; high - low > 1u; halves = !halves) {
        /* As if the sums grew evenly, which most do, and halfway in turns. */
        const real part = halves ? REAL(0.5) : (target - below) / (above - below);
        const uint middle = clamp(low + (uint)(part * (real)(high - low)), low + 1u, high - 1u);
        const real sum = rectified_sky_sum(window, row->column, middle);
        const bool is_above = sum > target;
        high = is_above ? middle : high;
        above = is_above ? sum : above;
        low = is_above ? low : middle;
        below = is_above ? below : sum;
    }
    *texel = low;
    return (real)low + clamp((target - below) / (above - below), REAL(0.0), REAL(1.0));
}

/* Density per steradian, times what is seen through the window, of the direction with these slopes, of which
   the texel is known. */
static inline real rectified_sky_density(const RectifiedWindow* window, uint x, uint y, real2 slopes)
{
    global const uint* low = window->sums + y * (RECTIFIED_SIZE + 1u) + x;
    global const uint* high = low + (RECTIFIED_SIZE + 1u);
    const uint value = (high[1] - high[0]) - (low[1] - low[0]);
    const real2 wide = REAL(1.0) + fabs(slopes);
    const real square = fma(slopes.x, slopes.x, fma(slopes.y, slopes.y, REAL(1.0)));
    const real stretch = REAL(0.5) * (real)RECTIFIED_SIZE / (wide.x * wide.y);
    return (real)value * stretch * stretch * square * real_sqrt(square);
}

/* Samples slopes through the window by what is seen there; u in (0, 1)^2. `density`: as above. */
static inline real2 rectified_sky_sample(const RectifiedWindow* window, real2 u, real* density)
{
    uint x, y;
    const RectifiedRow columns = rectified_sky_columns(window);
    const real across = rectified_sky_choose(window, &columns, u.x, &x);
    const RectifiedRow column =
        rectified_sky_row(window, x, window->last_y, window->low.y, window->high.y);
    const real up = rectified_sky_choose(window, &column, u.y, &y);
    const real2 slopes = (real2)(rectified_sky_slope((real)window->first_x + across),
                                 rectified_sky_slope((real)window->first_y + up));
    *density = rectified_sky_density(window, x, y, slopes);
    return slopes;
}

/* The same density of slopes within the window. */
static inline real rectified_sky_density_at(const RectifiedWindow* window, real2 slopes)
{
    const real4 place = rectified_sky_coordinates((real4)(slopes, slopes));
    const uint x = clamp((uint)place.x, window->first_x, window->first_x + window->last_x) - window->first_x;
    const uint y = clamp((uint)place.y, window->first_y, window->first_y + window->last_y) - window->first_y;
    return rectified_sky_density(window, x, y, slopes);
}

#endif
