// SPDX-License-Identifier: Apache-2.0
// Kernels call no built-in function whose last bits OpenCL leaves to the device: such a call would give other
// pictures elsewhere. numerics/real.h and numerics/real_functions.h have the same functions with fixed bits.
#include "device/kernel_source.h"

#include <gtest/gtest.h>
#include <regex>
#include <set>
#include <sstream>

namespace clrt {

namespace {

/// Built-in functions of OpenCL C 1.2 (sections 6.12.2, 6.12.4, 6.12.5) with an error bound above half a unit
/// in the last place, or whose order of operations is free. The others are exact or correctly rounded: fma,
/// fmin, fmax, floor, ceil, trunc, rint, round, fabs, copysign, fmod, ldexp, frexp, min, max, clamp, sign,
/// step and conversions.
const char* const FREE_BUILTINS[] = {
    "acos",       "acosh",  "acospi",  "asin",      "asinh",         "asinpi",      "atan",
    "atan2",      "atanh",  "atanpi",  "atan2pi",   "cbrt",          "cos",         "cosh",
    "cospi",      "cross",  "degrees", "distance",  "dot",           "erf",         "erfc",
    "exp",        "exp10",  "exp2",    "expm1",     "fast_distance", "fast_length", "fast_normalize",
    "hypot",      "length", "lgamma",  "lgamma_r",  "log",           "log10",       "log1p",
    "log2",       "mad",    "mix",     "normalize", "pow",           "pown",        "powr",
    "radians",    "rootn",  "rsqrt",   "sin",       "sincos",        "sinh",        "sinpi",
    "smoothstep", "sqrt",   "tan",     "tanh",      "tanpi",         "tgamma"};

/// The files that give them fixed bits, and native ones to --precision fast.
bool may_call_builtins(const std::string& file) {
    return file == "numerics/real.h" || file == "numerics/real_functions.h";
}

/// The text without comments and preprocessor's line ends; lines keep their numbers.
std::string without_comments(const std::string& text) {
    std::string code;
    for (size_t i = 0; i < text.size();) {
        if (text.compare(i, 2, "//") == 0) {
            i = text.find('\n', i);
        } else if (text.compare(i, 2, "/*") == 0) {
            const size_t end = text.find("*/", i + 2);
            for (const char c : text.substr(i, end - i))
                if (c == '\n')
                    code += c;
            i = end + 2;
        } else {
            code += text[i++];
        }
    }
    return code;
}

/// "file:line: name" of every call that leaves bits to the device.
std::vector<std::string> free_calls(const std::string& file, const std::string& text) {
    const std::set<std::string> names(std::begin(FREE_BUILTINS), std::end(FREE_BUILTINS));
    const std::regex call(R"(\b([A-Za-z_]\w*)\s*\()");
    std::vector<std::string> found;
    std::istringstream lines(without_comments(text));
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number)
        for (std::sregex_iterator match(line.begin(), line.end(), call), end; match != end; ++match) {
            const std::string name = (*match)[1];
            if (names.count(name) || name.rfind("native_", 0) == 0 || name.rfind("half_", 0) == 0)
                found.push_back(file + ":" + std::to_string(number) + ": " + name);
        }
    return found;
}

} // namespace

TEST(KernelBuiltins, NoKernelLeavesItsBitsToTheDevice) {
    for (const auto& [file, text] : embedded_kernel_files())
        if (!may_call_builtins(file)) {
            EXPECT_EQ(free_calls(file, text), std::vector<std::string>{})
                << "use real_... of numerics/ instead";
        }
}

TEST(KernelBuiltins, CallsAreFoundAndCommentsAreNot) {
    const std::string text =
        "real a = sin(x); // cos(x)\n"
        "/* log(x)\n exp(x) */ real b = real_sqrt(native_exp (y)) + sample.distance(z);\n"
        "real half_width = c * (d); real e = vector_dot(f, g) + fma(h, i, j);\n";
    EXPECT_EQ(free_calls("f.h", text),
              (std::vector<std::string>{"f.h:1: sin", "f.h:3: native_exp", "f.h:3: distance"}));
}

TEST(KernelBuiltins, ContractionIsOffForAllKernels) {
    // Every kernel file includes real.h first, which turns it off; nothing turns it on again.
    const std::regex on(R"(FP_CONTRACT\s+(ON|DEFAULT))");
    for (const auto& [file, text] : embedded_kernel_files())
        EXPECT_FALSE(std::regex_search(text, on)) << file;
    EXPECT_NE(embedded_kernel_files().at("numerics/real.h").find("#pragma OPENCL FP_CONTRACT OFF"),
              std::string::npos);
}

} // namespace clrt
