// SPDX-License-Identifier: Apache-2.0
// Floats of 16 bits as buffers hold them.
#ifndef CLRT_NUMERICS_HALVES_H
#define CLRT_NUMERICS_HALVES_H

#include "real.h"

/* A half that is not negative, by integers: devices may lose small ones otherwise. */
static inline float binary16_decode(uint bits)
{
    const float normal = as_float((bits + (112u << 10)) << 13);
    const float small = (float)bits * 0x1p-24f;
    return bits < (1u << 10) ? small : normal;
}

/* Number i of an array of three halves each. */
static inline real3 halves_load(size_t i, global const ushort* halves)
{
    const uint3 bits = convert_uint3(vload3(i, halves));
    return (real3)((real)binary16_decode(bits.x), (real)binary16_decode(bits.y),
                   (real)binary16_decode(bits.z));
}

#endif
