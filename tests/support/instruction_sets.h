// SPDX-License-Identifier: Apache-2.0
// Other instruction sets of x86 than the widest one of this processor, for tests that run kernels in them.
#pragma once

#include <string>
#include <vector>

namespace clrt {

/// An instruction set as PoCL knows it.
struct InstructionSet {
    std::string name;

    /// The variable and its value that make PoCL compile for it, and link its functions for it. Of use where
    /// PoCL is built for any x86 processor, as Debian's packages are; other drivers do not look at it.
    static constexpr const char* VARIABLE = "POCL_KERNELLIB_NAME";
};

/// Those that this processor has: the oldest one of 64 bits, 256-bit vectors with fma, 512-bit vectors.
inline std::vector<InstructionSet> instruction_sets() {
    std::vector<InstructionSet> sets;
#ifdef __x86_64__
    sets.push_back({"sse2"});
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        sets.push_back({"avx2"});
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw"))
        sets.push_back({"avx512"});
#endif
    return sets;
}

} // namespace clrt
