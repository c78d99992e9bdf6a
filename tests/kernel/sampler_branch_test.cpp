// SPDX-License-Identifier: Apache-2.0
// sampler_branch: the random numbers of rays that a sample branches into.
#include "probes/kernel_probe.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

namespace clrt {

TEST(SamplerBranch, BranchesOfASampleAreSamplesThatFollowEachOther) {
    // So those of the first 2^m samples, 2^n branches each, are a net of 2^(m + n) points.
    constexpr u32 SAMPLES = 64;
    KernelProbe probe(test_device(), {"numerics/sampler.h"});
    const std::string whole = "const Sampler s = sampler_make(9u, 77u, 1u, a); out = ";
    const std::string branch = "const Sampler s0 = sampler_make(9u, 77u, 1u, a); "
                               "const Sampler s = sampler_branch(&s0, b, c); out = ";
    const std::string x = "sampler_pair_words(&s, 5u, SAMPLE_LIGHT).x;",
                      word = "sampler_word(&s, 5u, SAMPLE_LIGHT_ALIAS);";
    probe.add<u32(u32)>("x", whole + x);
    probe.add<u32(u32)>("word", whole + word);
    // a: sample, b: branches, c: which
    probe.add<u32(u32, u32, u32)>("branch_x", branch + x);
    probe.add<u32(u32, u32, u32)>("branch_word", branch + word);
    for (const u32 count : {1u, 3u, 8u}) {
        std::vector<u32> sample, counts, which, index;
        for (u32 i = 0; i < SAMPLES * count; ++i) {
            sample.push_back(i / count);
            counts.push_back(count);
            which.push_back(i % count);
            index.push_back(i);
        }
        EXPECT_EQ(probe.run<u32>("branch_x", sample, counts, which), probe.run<u32>("x", index)) << count;
        EXPECT_EQ(probe.run<u32>("branch_word", sample, counts, which), probe.run<u32>("word", index))
            << count;
    }
}

} // namespace clrt
