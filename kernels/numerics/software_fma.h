// SPDX-License-Identifier: Apache-2.0
// fma from sums and products of floats, for drivers that would put hundreds of integer operations in the
// place of each (src/device/driver_quirks.cpp): no branch, some 70 operations.
#ifndef CLRT_NUMERICS_SOFTWARE_FMA_H
#define CLRT_NUMERICS_SOFTWARE_FMA_H

#pragma OPENCL FP_CONTRACT OFF

#define SOFTWARE_FMA_SPLIT 4097.0f /* 2^12 + 1: halves of 12 bits (Dekker 1971) */
#define SOFTWARE_FMA_LARGE 0x1p110f /* beyond, splitting may overflow */
/* Product and summand below which the product's error may underflow. */
#define SOFTWARE_FMA_SMALL_PRODUCT 0x1p-70f
#define SOFTWARE_FMA_SMALL_SUMMAND 0x1p-40f

/* a b + c, rounded once: the product's error by Dekker's splitting, and the sum of all parts by rounding to
   odd (Boldo and Melquiond 2008). Results below the smallest normal number may differ by their last bit;
   those of an infinite c and a product beyond all floats are NaN. */
static inline float __attribute__((overloadable)) software_fma(float a, float b, float c)
{
    /* Bring product and summand to where nothing is lost. */
    const float product = a * b;
    const bool is_first_larger = fabs(a) > fabs(b);
    const float larger = is_first_larger ? a : b, smaller = is_first_larger ? b : a;
    const float largest = fmax(fmax(fabs(larger), fabs(product)), fabs(c));
    const bool is_large = largest > SOFTWARE_FMA_LARGE;
    const bool is_small =
        !is_large && fabs(product) < SOFTWARE_FMA_SMALL_PRODUCT && fabs(c) < SOFTWARE_FMA_SMALL_SUMMAND;
    const float x = is_large ? larger * 0x1p-64f : larger, y = is_small ? smaller * 0x1p80f : smaller;
    const float z = c * (is_large ? 0x1p-64f : is_small ? 0x1p80f : 1.0f);

    /* p + e is the product. */
    const float p = x * y;
    const float x_split = x * SOFTWARE_FMA_SPLIT, x_high = x_split - (x_split - x), x_low = x - x_high;
    const float y_split = y * SOFTWARE_FMA_SPLIT, y_high = y_split - (y_split - y), y_low = y - y_high;
    const float e = ((x_high * y_high - p) + x_high * y_low + x_low * y_high) + x_low * y_low;

    /* Add the smallest parts last, rounded to odd. */
    const float u = z + e, u_part = u - z, u_rest = (z - (u - u_part)) + (e - u_part);
    const float t = p + u, t_part = t - p, t_rest = (p - (t - t_part)) + (u - t_part);
    const float w = t_rest + u_rest, w_part = w - t_rest;
    const float w_rest = (t_rest - (w - w_part)) + (u_rest - w_part);
    const int bits = as_int(w), towards_rest = (w_rest > 0.0f) == (w > 0.0f) ? 1 : -1;
    const float odd = as_float(w_rest != 0.0f && (bits & 1) == 0 ? bits + towards_rest : bits);
    const float sum = (t + odd) * (is_large ? 0x1p64f : is_small ? 0x1p-80f : 1.0f);
    /* Zeros keep their sign, infinities and NaN come through. */
    return product == 0.0f || c == 0.0f ? product + c : (sum != sum ? p + z : sum);
}

static inline float2 __attribute__((overloadable)) software_fma(float2 a, float2 b, float2 c)
{
    return (float2)(software_fma(a.x, b.x, c.x), software_fma(a.y, b.y, c.y));
}

static inline float3 __attribute__((overloadable)) software_fma(float3 a, float3 b, float3 c)
{
    return (float3)(software_fma(a.xy, b.xy, c.xy), software_fma(a.z, b.z, c.z));
}

static inline float4 __attribute__((overloadable)) software_fma(float4 a, float4 b, float4 c)
{
    return (float4)(software_fma(a.lo, b.lo, c.lo), software_fma(a.hi, b.hi, c.hi));
}

static inline float8 __attribute__((overloadable)) software_fma(float8 a, float8 b, float8 c)
{
    return (float8)(software_fma(a.lo, b.lo, c.lo), software_fma(a.hi, b.hi, c.hi));
}

#endif
