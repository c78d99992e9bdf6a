// SPDX-License-Identifier: Apache-2.0
// Figures of a case that compares the mean of a random quantity.
#pragma once

#include "probes/statistics.h"
#include "stability/stability_case.h"

#include <cmath>
#include <fmt/format.h>
#include <string>
#include <vector>

namespace clrt {

/// A mean against its expected value, in standard errors and with a bound on them: a sample that is noisy
/// enough agrees with anything.
class MeanFigure {
public:
    /// Standard errors that a right mean may be off: a chance of 2e-9 a comparison.
    static constexpr double LARGEST_Z = 6;

    /// `sharpness`: the standard error that the quick tier may have, relative to the expected value; six of
    /// them are what a wrong value must be off to be seen. The other tiers have it too.
    MeanFigure(CaseRun& run, const std::string& name, double sharpness)
        : z_(run.figure("|z| of " + name, LARGEST_Z)),
          error_(run.figure("relative standard error of " + name, sharpness)) {}

    /// Compares values of a build.
    template <class Describe>
    void see(Build build, const std::vector<double>& values, double expected, const Describe& describe) {
        const Moments moments = moments_of(values);
        const auto text = [&] {
            return fmt::format("{}mean {}, expected {}", describe(), moments.mean, expected);
        };
        z_[build].see(std::abs(z_of_mean(moments, expected)), text);
        error_[build].see(std::sqrt(moments.variance_of_mean()) / expected, text);
    }
    void see(Build build, const std::vector<double>& values, double expected) {
        see(build, values, expected, [] { return ""; });
    }

private:
    Figure& z_;
    Figure& error_;
};

} // namespace clrt
