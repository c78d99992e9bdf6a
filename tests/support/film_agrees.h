// SPDX-License-Identifier: Apache-2.0
// Whether a film agrees with a closed form.
#pragma once

#include "probes/film_estimate.h"

#include <gtest/gtest.h>
#include <string>

namespace clrt {

/// Whether an estimate is within LARGEST_Z standard errors, plus `rounding` of the expected value. The
/// standard error must not exceed `sharpness` of the expected value, so that the comparison can fail.
testing::AssertionResult agrees(const Estimate& estimate, double expected, double sharpness = 2e-3,
                                double rounding = RENDER_ROUNDING);

/// Expects the means of two films to be within five standard errors of each other in every channel.
void expect_equal_means(const Film& a, const Film& b, const std::string& what);

} // namespace clrt
