// SPDX-License-Identifier: Apache-2.0
#include "film/f_distribution.h"

#include <cmath>

namespace clrt {

namespace {

constexpr double TINY = 1e-300;     ///< instead of a denominator of 0 (Lentz)
constexpr double PRECISION = 1e-15; ///< of the continued fraction
constexpr int MOST_TERMS = 100000;  ///< it takes some roots of the larger parameter
constexpr double LARGEST_LOG = 60;  ///< quantiles lie within e^-60 .. e^60 from one degree of freedom on
constexpr double LOG_PRECISION = 1e-10;

/// A number that may divide.
double nonzero(double x) {
    return std::abs(x) < TINY ? TINY : x;
}

/// The continued fraction of the incomplete beta function (DLMF 8.17.22) by Lentz's method.
double beta_fraction(double a, double b, double x) {
    double c = 1, d = 1 / nonzero(1 - (a + b) * x / (a + 1)), value = d;
    for (int m = 1; m < MOST_TERMS; ++m) {
        const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        d = 1 / nonzero(1 + even * d);
        c = nonzero(1 + even / c);
        value *= d * c;
        const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / nonzero(1 + odd * d);
        c = nonzero(1 + odd / c);
        value *= d * c;
        if (std::abs(d * c - 1) < PRECISION)
            break;
    }
    return value;
}

/// The regularised incomplete beta function I_x(a, b); `rest` is 1 - x.
double incomplete_beta(double a, double b, double x, double rest) {
    const double factor =
        std::exp(a * std::log(x) + b * std::log(rest) + std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b));
    // The fraction converges fast on this side of the mean only.
    return x < (a + 1) / (a + b + 2) ? factor * beta_fraction(a, b, x) / a
                                     : 1 - factor * beta_fraction(b, a, rest) / b;
}

} // namespace

double f_probability(double value, double degrees_above, double degrees_below) {
    if (!(value > 0))
        return 0;
    const double ratio = degrees_above / degrees_below * value;
    return incomplete_beta(0.5 * degrees_above, 0.5 * degrees_below, ratio / (1 + ratio), 1 / (1 + ratio));
}

double f_quantile(double probability, double degrees_above, double degrees_below) {
    double low = -LARGEST_LOG, high = LARGEST_LOG;
    while (high - low > LOG_PRECISION) {
        const double middle = 0.5 * (low + high);
        const bool is_below = f_probability(std::exp(middle), degrees_above, degrees_below) < probability;
        (is_below ? low : high) = middle;
    }
    return std::exp(0.5 * (low + high));
}

} // namespace clrt
