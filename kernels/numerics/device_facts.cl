// SPDX-License-Identifier: Apache-2.0
// Entry point that shows how a device computes: results of the operations that all kernels consist of, for
// the host to compare with its own. Where they are the same, so is the picture.
#include "real_functions.h"
#include "shared/fact_types.h"

/* The rules that hold; the numbers come from outside, so that no compiler decides: NaN, infinity, 0, -0, 1,
   2.75. */
static inline uint facts_rules(global const float* numbers)
{
    const float not_a_number = numbers[0], infinite = numbers[1], zero = numbers[2], minus = numbers[3],
                one = numbers[4], fraction = numbers[5];
    uint rules = 0u;
    const bool compares = not_a_number == not_a_number || not_a_number < one || not_a_number >= one;
    const bool prefers_numbers = fmin(not_a_number, one) == one && fmax(one, not_a_number) == one;
    if (!compares && prefers_numbers && real_is_nan(not_a_number))
        rules |= FACT_RULE_NAN;
    if (one / zero == infinite && real_is_nan(infinite - infinite) && !real_is_finite(infinite))
        rules |= FACT_RULE_INFINITE;
    const bool keeps = as_uint(minus * one) == 0x80000000u && as_uint(real_sqrt(minus)) == 0x80000000u;
    if (keeps && one / minus == -infinite && as_uint(zero + minus) == 0u && copysign(one, minus) == -one)
        rules |= FACT_RULE_ZERO;
    const uint odd = 16777216u + (uint)one;
    const bool to_even = (float)odd == 16777216.0f && (float)(odd + 2u) == 16777220.0f;
    if (to_even && (int)fraction == 2 && (int)-fraction == -2 && convert_long(floor(-fraction)) == -3)
        rules |= FACT_RULE_CONVERSION;
    return rules;
}

/* The operations as vectors of eight. */
static inline void facts_eight(uint i, float8 a, float8 b, float8 c, float8 squares, global float* results)
{
    vstore8(a / b, i, results + FACT_DIVISION_8 * FACT_COUNT);
    vstore8(real_sqrt(squares), i, results + FACT_ROOT_8 * FACT_COUNT);
    vstore8(fma(a, b, c), i, results + FACT_FMA_8 * FACT_COUNT);
    vstore8(a * b + c, i, results + FACT_PRODUCT_SUM * FACT_COUNT);
    vstore8(a * b - c * b, i, results + FACT_PRODUCT_DIFFERENCE * FACT_COUNT);
    vstore8(a * 1.0e-38f * 1.0e-4f, i, results + FACT_SUBNORMAL * FACT_COUNT);
}

/* The operations one by one, and the functions. `u` in [0, 1]. */
static inline void facts_one(float a, float b, float c, float square, float u, global float* result)
{
    result[FACT_DIVISION * FACT_COUNT] = a / b;
    result[FACT_ROOT * FACT_COUNT] = real_sqrt(square);
    result[FACT_FMA * FACT_COUNT] = fma(a, b, c);
    result[FACT_EXP * FACT_COUNT] = real_exp(fma(u, 190.0f, -103.0f));
    result[FACT_LOG * FACT_COUNT] = real_log(square);
    result[FACT_POW * FACT_COUNT] = real_pow(u, fabs(c));
    result[FACT_ATAN2 * FACT_COUNT] = real_atan2(a, b);
    result[FACT_ACOS * FACT_COUNT] = real_acos(fma(u, 2.0f, -1.0f));
    const real2 sc = real_sin_cos_turn(u);
    result[FACT_SIN_TURN * FACT_COUNT] = sc.x;
    result[FACT_COS_TURN * FACT_COUNT] = sc.y;
}

CLRT_KERNEL void device_facts(global const float* restrict a, global const float* restrict b,
                              global const float* restrict c, global const float* restrict squares,
                              global const float* restrict units, global const float* restrict numbers,
                              global float* restrict results, global uint* restrict rules)
{
    const uint i = (uint)get_global_id(0);
    facts_eight(i, vload8(i, a), vload8(i, b), vload8(i, c), vload8(i, squares), results);
    for (uint k = 8u * i; k < 8u * i + 8u; ++k) {
        facts_one(a[k], b[k], c[k], squares[k], units[k], results + k);
        real sum = REAL(0.0);
        for (uint term = 0u; term < FACT_SUM_TERMS; ++term)
            sum += c[(k + term) % FACT_COUNT];
        results[FACT_SUM * FACT_COUNT + k] = sum;
    }
    if (i == 0u)
        *rules = facts_rules(numbers);
}
