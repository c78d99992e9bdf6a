// SPDX-License-Identifier: Apache-2.0
// numerics/mis.h: where only one technique finds a direction. What two of them weigh is case L09 of the
// catalogue.
#include "probes/kernel_probe.h"
#include "support/test_device.h"

#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/mis.h"});
        made.add<float(float, float)>("weight", "mis_weight(a, b)");
        return made;
    }();
    return instance;
}

} // namespace

TEST(Mis, WhatOnlyOneTechniqueFindsCountsFully) {
    const float inf = std::numeric_limits<float>::infinity();
    // A delta lobe (density 0 by convention) whatever the other density; no other technique; an overflow on
    // either side.
    EXPECT_EQ(probe().run<float>("weight", std::vector<float>{0, 0, 0, 0, 3, 1e-38f, inf, 2, 1},
                                 std::vector<float>{0, 1, 1e38f, inf, 0, 0, 5, inf, 1}),
              (std::vector<float>{1, 1, 1, 1, 1, 1, 1, 0, 0.5f}));
}
