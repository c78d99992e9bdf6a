// SPDX-License-Identifier: Apache-2.0
// Local regression of a picture's colour on what is known about its pixels without noise: in a window around
// a pixel, colour is modelled as a linear function of place, albedo, normal and depth, by least squares in
// which pixels count that look alike (Moon, Carr and Yoon 2014; Bitterli et al. 2016, "Nonlinearly Weighted
// First-order Regression for Denoising Monte Carlo Renderings"). Whether they look alike is told by other
// samples than those that are filtered, so that a pixel's noise does not choose its own company (Rousselle,
// Knaus and Zwicker 2012).
#ifndef CLRT_DENOISE_REGRESSION_H
#define CLRT_DENOISE_REGRESSION_H

#include "numerics/real_functions.h"
#include "shared/denoise_types.h"

/* What a filter reads; a pixel is y width + x. */
typedef struct {
    uint width, height;
    global const float* rows;    /* DENOISE_ROW a pixel */
    global const float4* places; /* x, y, z: mean position; w: 1 over the distance to the next pixel's */
    global const float4* guide;  /* r, g, b: smoothed colour of the other quarter; w: its variance */
    real noise;                  /* standard deviations within which colours are alike, squared */
} DenoiseInput;

/* One observation: 1, place, albedo (three) and x and y of the normal; z of the normal, distance from the
   plane, both quarters' colours. All but 1 and the colours are differences from the model's pixel. */
typedef struct {
    real8 low, high;
    real weight;
} DenoiseRow;

/* Differences of features that halve a weight, roughly. The regression itself follows smaller ones. */
#define DENOISE_ALBEDO_WEIGHT REAL(4.0)
#define DENOISE_NORMAL_WEIGHT REAL(4.0)
#define DENOISE_PLANE_WEIGHT REAL(1.0)
#define DENOISE_SHARE_WEIGHT REAL(16.0)
/* Colours that differ by less than this part of their length are alike, squared. */
#define DENOISE_ALIKE REAL(1e-4)
/* Smaller weights than exp(-this) count as 0. */
#define DENOISE_FARTHEST REAL(9.0)
/* Windows are left after this many pixels' steps off the plane. */
#define DENOISE_LARGEST_PLANE REAL(2.0)
/* Added to the diagonal of the normal equations, times the sum of weights and times the diagonal: what
   differs by less than a hundredth tells nothing. */
#define DENOISE_RIDGE REAL(1e-4)
#define DENOISE_RELATIVE_RIDGE REAL(1e-3)
/* The weight of a pixel's own colour beside those of the models around it. */
#define DENOISE_OWN_WEIGHT REAL(1e-4)

static inline real denoise_square_sum(real3 v)
{
    const real3 squares = v * v;
    return squares.x + squares.y + squares.z;
}

/* How unlike two pixels' colours are, in units of their noise: of the lesser one's, so that what is bright
   and noisy does not spread to what is neither. */
static inline real denoise_colour_distance(const DenoiseInput* input, uint p, uint q)
{
    const float4 a = input->guide[p];
    const float4 b = input->guide[q];
    const real3 x = convert_real3(a.xyz);
    const real3 y = convert_real3(b.xyz);
    const real squares = denoise_square_sum(x) + denoise_square_sum(y);
    const real noise = fma(DENOISE_ALIKE, squares, REAL(2.0) * fmin((real)a.w, (real)b.w));
    const real excess = denoise_square_sum(x - y) - noise;
    return excess > REAL(0.0) ? excess / (input->noise * noise) : REAL(0.0);
}

/* Distance of q from the plane of p's surface, in pixels of p's size over the window's radius. */
static inline real denoise_plane_distance(const DenoiseInput* input, uint p, uint q, real3 normal)
{
    const float4 a = input->places[p];
    const float4 b = input->places[q];
    const real3 way = convert_real3(b.xyz) - convert_real3(a.xyz);
    const real3 products = way * normal;
    const real distance = (products.x + products.y + products.z) * (real)a.w / (real)DENOISE_RADIUS;
    return clamp(distance, -DENOISE_LARGEST_PLANE, DENOISE_LARGEST_PLANE);
}

/* Pixel q as an observation for a model at p. */
static inline DenoiseRow denoise_row(const DenoiseInput* input, uint p, uint q)
{
    const real8 p_low = convert_real8(vload8(2 * (size_t)p, input->rows));
    const real8 p_high = convert_real8(vload8(2 * (size_t)p + 1, input->rows));
    const real8 q_low = convert_real8(vload8(2 * (size_t)q, input->rows));
    const real8 q_high = convert_real8(vload8(2 * (size_t)q + 1, input->rows));
    DenoiseRow row;
    row.low = q_low - p_low;
    row.high = q_high;
    row.high.s0 -= p_high.s0;
    const real share = q_high.s1 - p_high.s1;
    const real plane = denoise_plane_distance(input, p, q, (real3)(p_low.s67, p_high.s0));
    const real distance =
        denoise_colour_distance(input, p, q) + DENOISE_ALBEDO_WEIGHT * denoise_square_sum(row.low.s345) +
        DENOISE_NORMAL_WEIGHT * denoise_square_sum((real3)(row.low.s67, row.high.s0)) +
        DENOISE_PLANE_WEIGHT * plane * plane + DENOISE_SHARE_WEIGHT * share * share;
    row.low.s0 = REAL(1.0);
    row.high.s1 = plane;
    row.weight = distance < DENOISE_FARTHEST ? real_exp(-distance) : REAL(0.0);
    return row;
}

/* Sums of weighted products of an observation's first DENOISE_UNKNOWNS numbers with all of them. */
typedef struct {
    real8 low[DENOISE_UNKNOWNS], high[DENOISE_UNKNOWNS];
} DenoiseSums;

static inline void denoise_sums_add(DenoiseSums* sums, const DenoiseRow* row)
{
    const real8 low = row->weight * row->low;
    const real8 high = row->weight * row->high;
#define DENOISE_ADD(i, factor)                              \
    sums->low[i] = fma((real8)(factor), low, sums->low[i]); \
    sums->high[i] = fma((real8)(factor), high, sums->high[i])
    sums->low[0] += low;
    sums->high[0] += high;
    DENOISE_ADD(1, row->low.s1);
    DENOISE_ADD(2, row->low.s2);
    DENOISE_ADD(3, row->low.s3);
    DENOISE_ADD(4, row->low.s4);
    DENOISE_ADD(5, row->low.s5);
    DENOISE_ADD(6, row->low.s6);
    DENOISE_ADD(7, row->low.s7);
    DENOISE_ADD(8, row->high.s0);
    DENOISE_ADD(9, row->high.s1);
#undef DENOISE_ADD
}

/* Solves the normal equations by Cholesky's factors L L^T; `matrix` holds 16 numbers a row, the right-hand
   sides from column DENOISE_UNKNOWNS on, of which three from `first` are solved for. The ridge keeps every
   pivot positive. */
static inline void denoise_solve(real* matrix, uint first, global float* model)
{
    const real ridge = DENOISE_RIDGE * matrix[0];
    for (uint i = 1; i < DENOISE_UNKNOWNS; ++i)
        matrix[17 * i] += fma(DENOISE_RELATIVE_RIDGE, matrix[17 * i], ridge);
    for (uint i = 0; i < DENOISE_UNKNOWNS; ++i) {
        real* row = matrix + 16 * i;
        for (uint j = 0; j < i; ++j) {
            real sum = row[j];
            for (uint k = 0; k < j; ++k)
                sum = fma(-row[k], matrix[16 * j + k], sum);
            row[j] = sum / matrix[17 * j];
        }
        real sum = row[i];
        for (uint k = 0; k < i; ++k)
            sum = fma(-row[k], row[k], sum);
        row[i] = real_root(fmax(sum, DENOISE_RIDGE * ridge));
    }
    for (uint c = 0; c < 3; ++c) {
        real x[DENOISE_UNKNOWNS];
        for (uint i = 0; i < DENOISE_UNKNOWNS; ++i) {
            real sum = matrix[16 * i + first + c];
            for (uint k = 0; k < i; ++k)
                sum = fma(-matrix[16 * i + k], x[k], sum);
            x[i] = sum / matrix[17 * i];
        }
        for (uint i = DENOISE_UNKNOWNS; i-- > 0;) {
            real sum = x[i];
            for (uint k = i + 1; k < DENOISE_UNKNOWNS; ++k)
                sum = fma(-matrix[16 * k + i], x[k], sum);
            x[i] = sum / matrix[17 * i];
            model[c * DENOISE_UNKNOWNS + i] = (float)x[i];
        }
    }
}

/* Fits the model at pixel (x, y) to a quarter's colours. */
static CLRT_NOINLINE void denoise_fit_model(const DenoiseInput* input, uint x, uint y, uint quarter,
                                            global float* model)
{
    DenoiseSums sums;
    for (uint i = 0; i < DENOISE_UNKNOWNS; ++i)
        sums.low[i] = sums.high[i] = (real8)(REAL(0.0));
    const uint left = x > DENOISE_RADIUS ? x - DENOISE_RADIUS : 0u;
    const uint right = min(x + DENOISE_RADIUS, input->width - 1u);
    const uint bottom = min(y + DENOISE_RADIUS, input->height - 1u);
    const uint p = y * input->width + x;
    for (uint v = y > DENOISE_RADIUS ? y - DENOISE_RADIUS : 0u; v <= bottom; ++v)
        for (uint u = left; u <= right; ++u) {
            const DenoiseRow row = denoise_row(input, p, v * input->width + u);
            if (row.weight > REAL(0.0))
                denoise_sums_add(&sums, &row);
        }
    real matrix[16 * DENOISE_UNKNOWNS];
    for (uint i = 0; i < DENOISE_UNKNOWNS; ++i) {
        vstore8(sums.low[i], 2 * i, matrix);
        vstore8(sums.high[i], 2 * i + 1, matrix);
    }
    denoise_solve(matrix, DENOISE_UNKNOWNS + 3u * quarter, model);
}

/* The colour that a model gives an observation. */
static inline real denoise_predict(global const float* unknowns, const DenoiseRow* row)
{
    const real8 products = convert_real8(vload8(0, unknowns)) * row->low;
    real sum = products.s0;
    sum += products.s1;
    sum += products.s2;
    sum += products.s3;
    sum += products.s4;
    sum += products.s5;
    sum += products.s6;
    sum += products.s7;
    sum = fma((real)unknowns[8], row->high.s0, sum);
    return fma((real)unknowns[9], row->high.s1, sum);
}

#endif
