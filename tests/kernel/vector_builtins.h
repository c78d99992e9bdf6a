// SPDX-License-Identifier: Apache-2.0
// Builtin functions of OpenCL C with bodies, as CPU drivers link them: to clang alone they are calls, and no
// loop that calls becomes one of vectors.
#ifndef CLRT_TESTS_VECTOR_BUILTINS_H
#define CLRT_TESTS_VECTOR_BUILTINS_H

#include <fmt/format.h>
#include <regex>
#include <string>

namespace clrt {

/// Kernel source to put before all other. Of the functions that light sampling needs, scalars have bodies,
/// vectors stay calls.
inline std::string vector_builtins() {
    std::string text = "#define BODY static inline __attribute__((overloadable, always_inline))\n";
    const auto add = [&](const std::string& name, int arguments, const std::string& scalar) {
        std::string names;
        for (int i = 0; i < arguments; ++i)
            names += fmt::format("{}{}", i ? ", " : "", char('a' + i));
        const auto body = [&](const std::string& type, const std::string& called) {
            const std::string typed = std::regex_replace(names, std::regex("[a-c]"), type + " $&");
            text += fmt::format("BODY {0} body_{1}({2}) {{ return {3}({4}); }}\n", type, name, typed, called,
                                names);
        };
        for (const char* type : {"float2", "float3", "float4", "float8"})
            body(type, name);
        body("float", scalar);
        text += fmt::format("#define {0} body_{0}\n", name);
    };
    add("fma", 3, "__builtin_fmaf");
    for (const char* name : {"fmax", "fmin", "copysign"})
        add(name, 2, fmt::format("__builtin_{}f", name));
    for (const char* name : {"fabs", "floor", "sqrt"})
        add(name, 1, fmt::format("__builtin_{}f", name));
    return text + "BODY uint body_mul_hi(uint a, uint b) { return (uint)(((ulong)a * b) >> 32); }\n"
                  "BODY ulong body_mul_hi(ulong a, ulong b) { return mul_hi(a, b); }\n"
                  "#define mul_hi body_mul_hi\n"
                  "BODY int body_max(int a, int b) { return a > b ? a : b; }\n"
                  "BODY int8 body_max(int8 a, int b) { return max(a, b); }\n"
                  "BODY float3 body_max(float3 a, float3 b) { return max(a, b); }\n"
                  "BODY float body_max(float a, float b) { return a > b ? a : b; }\n"
                  "BODY uint body_max(uint a, uint b) { return a > b ? a : b; }\n"
                  "#define max body_max\n"
                  "BODY int body_min(int a, int b) { return a < b ? a : b; }\n"
                  "BODY uint body_min(uint a, uint b) { return a < b ? a : b; }\n"
                  "BODY uint4 body_min(uint4 a, uint4 b) { return min(a, b); }\n"
                  "BODY ulong body_min(ulong a, ulong b) { return a < b ? a : b; }\n"
                  "BODY float body_min(float a, float b) { return a < b ? a : b; }\n"
                  "BODY float2 body_min(float2 a, float2 b) { return min(a, b); }\n"
                  "#define min body_min\n";
}

} // namespace clrt

#endif
