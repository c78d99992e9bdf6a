// SPDX-License-Identifier: Apache-2.0
// Statistics for tests: p-values, sample moments, distances in units in the last place.
// A p-value is the probability of a result at least this extreme if the hypothesis holds. Tests have fixed
// seeds and fail below SMALLEST_P, so that a right code passes and a wrong one does not hide.
#pragma once

#include <cstddef>
#include <vector>

namespace clrt {

/// Below this p-value a test fails. With the thousand or so p-values of the suite, a sound build has a chance
/// of about one in a thousand to need another seed, once, when a test is written.
constexpr double SMALLEST_P = 1e-6;

/// Number, mean and unbiased variance of values.
struct Moments {
    double count = 0, mean = 0, variance = 0;

    /// Variance of the mean of independent values.
    double variance_of_mean() const { return count > 0 ? variance / count : 0; }
};

/// Moments by Welford's method.
Moments moments_of(const std::vector<double>& values);

/// Two-sided p-value of a standard normal z.
double normal_p_value(double z);

/// z of a sample mean against its expected value: (mean - expected) / standard error. Infinite for a sample
/// without spread that misses the value, 0 for one that hits it.
double z_of_mean(const Moments& sample, double expected);

/// p-value of a chi-squared statistic: Q(degrees / 2, statistic / 2), the upper regularised incomplete gamma
/// function.
double chi_squared_p_value(double statistic, double degrees);

/// Result of a goodness-of-fit test.
struct ChiSquared {
    double statistic = 0, degrees = 0, p_value = 1;
};

/// Pearson's test of observed counts against expected counts (of the same total, not normalised here). Cells
/// that expect fewer than five are pooled, smallest first; a count where none is expected at all gives p = 0.
ChiSquared chi_squared_test(const std::vector<double>& observed, const std::vector<double>& expected);

/// Result of Welch's test.
struct Welch {
    double t = 0, degrees = 0, p_value = 1;
};

/// Welch's test (1947) that two samples of unequal variance have the same mean, two-sided. Each needs two
/// values.
Welch welch_test(const Moments& a, const Moments& b);

/// |value - reference| in units in the last place of a float at the reference (at least those of the smallest
/// normal float, so that results around zero can be judged). Infinite if exactly one is NaN, 0 if both are.
double ulp_distance(float value, double reference);

/// The same in units of a double.
double ulp_distance(double value, long double reference);

} // namespace clrt
