// SPDX-License-Identifier: Apache-2.0
// Types that C++ and OpenCL C lay out alike. Everything in kernels/shared is compiled by both sides.
// Members of shared structs are vec4, vec2, float, i32 and u32 only: a three-component vector takes 16 bytes
// in OpenCL C and 12 in C++, and the size of bool, enum and size_t is the compiler's choice.
#ifndef CLRT_SHARED_TYPES_H
#define CLRT_SHARED_TYPES_H

#ifndef __cplusplus

typedef float4 vec4;
typedef float2 vec2;
typedef uint u32;
typedef int i32;
#define SHARED_BEGIN
#define SHARED_END
#define ASSERT_SIZE(type, bytes) typedef char assert_size_##type[(sizeof(type) == (bytes)) ? 1 : -1]

#else

#include <cstdint>

#define SHARED_BEGIN namespace clrt {
#define SHARED_END }
#define ASSERT_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), "size differs from OpenCL C")

namespace clrt {

using u32 = std::uint32_t;
using i32 = std::int32_t;

/// Four floats aligned like OpenCL C's float4.
struct alignas(16) vec4 {
    float x, y, z, w;
};

/// Two floats aligned like OpenCL C's float2.
struct alignas(8) vec2 {
    float x, y;
};

} // namespace clrt

#endif

#define NO_INDEX 0xffffffffu /* "none" wherever an index is optional */

#endif
