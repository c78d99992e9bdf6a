// SPDX-License-Identifier: Apache-2.0
// Standard errors between an estimate and a number.
#include "support/film_agrees.h"

#include <cmath>

namespace clrt {

testing::AssertionResult agrees(const Estimate& estimate, double expected, double sharpness,
                                double rounding) {
    const double difference = std::abs(estimate.mean - expected), scale = std::abs(expected);
    const bool sharp = estimate.error <= sharpness * scale;
    if (sharp && difference <= LARGEST_Z * estimate.error + rounding * scale)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << "expected " << expected << ", found " << estimate.mean << " +- "
                                       << estimate.error << " (z = " << difference / estimate.error << ")"
                                       << (sharp ? "" : ", too noisy for this comparison");
}

void expect_equal_means(const Film& a, const Film& b, const std::string& what) {
    for (int channel = 0; channel < 3; ++channel) {
        const Estimate of_a = film_estimate(a, channel), of_b = film_estimate(b, channel);
        EXPECT_NEAR(of_a.mean, of_b.mean, 5 * std::hypot(of_a.error, of_b.error))
            << what << ", channel " << channel;
    }
}

} // namespace clrt
