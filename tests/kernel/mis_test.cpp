// SPDX-License-Identifier: Apache-2.0
// path/mis.h: the power heuristic over all densities that a float can hold.
#include "support/kernel_probe.h"
#include "support/random_inputs.h"

#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"path/mis.h"});
        made.add<float(float, float)>("weight", "mis_weight(a, b)");
        return made;
    }();
    return instance;
}

struct Pairs {
    std::vector<float> a, b;
};

/// All pairs of densities from 1e-38 to 1e38.
Pairs grid() {
    Pairs pairs;
    for (double x = -38; x <= 38; x += 0.5)
        for (double y = -38; y <= 38; y += 0.5) {
            pairs.a.push_back(float(std::pow(10, x)));
            pairs.b.push_back(float(std::pow(10, y)));
        }
    Random random(1);
    for (int i = 0; i < 100000; ++i) {
        pairs.a.push_back(float(random.between(0.5, 2)));
        pairs.b.push_back(float(random.between(0.5, 2)));
    }
    return pairs;
}

} // namespace

TEST(Mis, TheWeightsOfBothTechniquesSumToOne) {
    const Pairs pairs = grid();
    const std::vector<float> ab = probe().run<float>("weight", pairs.a, pairs.b);
    const std::vector<float> ba = probe().run<float>("weight", pairs.b, pairs.a);
    for (size_t i = 0; i < ab.size(); ++i) {
        ASSERT_NEAR(double(ab[i]) + ba[i], 1, 4 * FLOAT_U) << pairs.a[i] << " " << pairs.b[i];
        ASSERT_TRUE(ab[i] >= 0 && ab[i] <= 1) << pairs.a[i] << " " << pairs.b[i];
    }
}

TEST(Mis, TheWeightIsThePowerHeuristic) {
    const Pairs pairs = grid();
    const std::vector<float> got = probe().run<float>("weight", pairs.a, pairs.b);
    for (size_t i = 0; i < got.size(); ++i) {
        const long double a2 = (long double)pairs.a[i] * pairs.a[i],
                          b2 = (long double)pairs.b[i] * pairs.b[i];
        ASSERT_NEAR(got[i], double(a2 / (a2 + b2)), 4 * FLOAT_U) << pairs.a[i] << " " << pairs.b[i];
    }
    EXPECT_EQ(probe().run<float>("weight", std::vector<float>{1}, std::vector<float>{1})[0], 0.5f);
}

TEST(Mis, WhatOnlyOneTechniqueFindsCountsFully) {
    const float inf = std::numeric_limits<float>::infinity();
    // A delta lobe (density 0 by convention) whatever the other density; no other technique; an overflow on
    // either side.
    EXPECT_EQ(probe().run<float>("weight", std::vector<float>{0, 0, 0, 0, 3, 1e-38f, inf, 2},
                                 std::vector<float>{0, 1, 1e38f, inf, 0, 0, 5, inf}),
              (std::vector<float>{1, 1, 1, 1, 1, 1, 1, 0}));
}
