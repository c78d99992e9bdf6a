// SPDX-License-Identifier: Apache-2.0
// Entry points of the denoising filter: models at a grid of pixels, then colours from the models around each
// pixel.
#include "denoise/regression.h"

/* Fits a model a work-item: item (i, j) at pixel (DENOISE_STRIDE i, DENOISE_STRIDE j). */
CLRT_KERNEL void denoise_fit(const uint width, const uint height, const float noise, const uint quarter,
                             global const float* restrict rows, global const float4* restrict places,
                             global const float4* restrict guide, global float* restrict models)
{
    const uint columns = (width + DENOISE_STRIDE - 1) / DENOISE_STRIDE;
    const uint i = (uint)get_global_id(0);
    const uint j = (uint)get_global_id(1);
    if (i >= columns || DENOISE_STRIDE * j >= height)
        return;
    const DenoiseInput input = {width, height, rows, places, guide, noise};
    denoise_fit_model(&input, DENOISE_STRIDE * i, DENOISE_STRIDE * j, quarter,
                      models + (size_t)DENOISE_MODEL * ((size_t)j * columns + i));
}

/* Writes the colours of a pixel a work-item, as the models around it tell. */
CLRT_KERNEL void denoise_apply(const uint width, const uint height, const float noise, const uint quarter,
                               global const float* restrict rows, global const float4* restrict places,
                               global const float4* restrict guide, global const float* restrict models,
                               global float4* restrict colours)
{
    const uint x = (uint)get_global_id(0);
    const uint y = (uint)get_global_id(1);
    if (x >= width || y >= height)
        return;
    const DenoiseInput input = {width, height, rows, places, guide, noise};
    const uint columns = (width + DENOISE_STRIDE - 1) / DENOISE_STRIDE;
    const uint lines = (height + DENOISE_STRIDE - 1) / DENOISE_STRIDE;
    const uint i = x / DENOISE_STRIDE;
    const uint j = y / DENOISE_STRIDE;
    const uint q = y * width + x;
    global const float* own = rows + (size_t)DENOISE_ROW * q + DENOISE_COLOURS + 3u * quarter;
    real3 sum = DENOISE_OWN_WEIGHT * (real3)(own[0], own[1], own[2]);
    real weights = DENOISE_OWN_WEIGHT;
    for (uint v = j > 0u ? j - 1u : 0u; v <= min(j + 1u, lines - 1u); ++v)
        for (uint u = i > 0u ? i - 1u : 0u; u <= min(i + 1u, columns - 1u); ++u) {
            const DenoiseRow row = denoise_row(&input, DENOISE_STRIDE * (v * width + u), q);
            global const float* model = models + (size_t)DENOISE_MODEL * ((size_t)v * columns + u);
            const real3 colour = (real3)(denoise_predict(model, &row),
                                         denoise_predict(model + DENOISE_UNKNOWNS, &row),
                                         denoise_predict(model + 2 * DENOISE_UNKNOWNS, &row));
            sum += row.weight * colour;
            weights += row.weight;
        }
    /* Beside what is bright, a model can go below 0. */
    const real3 colour = fmax(sum / weights, (real3)(REAL(0.0)));
    colours[q] = (float4)((float)colour.x, (float)colour.y, (float)colour.z, 0.0f);
}
