// SPDX-License-Identifier: Apache-2.0
// Floats of 16 bits as buffers hold them.
#ifndef CLRT_NUMERICS_HALVES_H
#define CLRT_NUMERICS_HALVES_H

#include "real.h"

/* Three halves that are not negative, by integers: devices may lose small ones otherwise. */
static inline float3 halves_decode(uint3 halves)
{
    const float3 normal = as_float3((halves + (uint3)(112u << 10)) << (uint3)(13u));
    const float3 small = convert_float3(halves) * 0x1p-24f;
    return select(normal, small, halves < (uint3)(1u << 10));
}

/* The halves of a number in an array of three each. */
static inline real3 halves_load(size_t i, global const ushort* halves)
{
    return convert_real3(halves_decode(convert_uint3(vload3(i, halves))));
}

#endif
