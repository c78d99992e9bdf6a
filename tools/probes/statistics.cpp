// SPDX-License-Identifier: Apache-2.0
// Incomplete gamma and beta functions after Press et al., Numerical Recipes (3rd ed.), sections 6.2 and 6.4.
#include "probes/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace clrt {

namespace {

constexpr double INFINITE = std::numeric_limits<double>::infinity();
/// Relative size at which series and fractions have converged, and a stand-in for zero denominators.
constexpr double CONVERGED = 1e-15;
constexpr double TINY = 1e-300;
/// Needed are about 5 sqrt(a); this serves a million degrees of freedom.
constexpr int MOST_TERMS = 20000;

/// Cells that expect fewer are pooled: below it the statistic is not distributed as chi-squared (Cochran
/// 1954).
constexpr double LEAST_EXPECTED = 5;

struct Cell {
    double observed = 0, expected = 0;
};

/// P(a, x) by its series, for x < a + 1.
double gamma_series(double a, double x) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < MOST_TERMS && term > sum * CONVERGED; ++n) {
        term *= x / (a + n);
        sum += term;
    }
    return sum * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// Wrong use of a statistic fails the test in every build, unlike assert.
void require(bool condition, const char* message) {
    if (!condition)
        throw std::invalid_argument(message);
}

struct Term {
    double numerator, denominator;
};

/// Evaluates the continued fraction 1 / (first + n_1 / (d_1 + n_2 / (d_2 + ...))) by Lentz's method.
template <class TermAt>
double continued_fraction(double first, TermAt term) {
    double c = 1 / TINY, d = 1 / (std::abs(first) < TINY ? TINY : first), value = d;
    for (int n = 1; n < MOST_TERMS; ++n) {
        const auto [numerator, denominator] = term(n);
        d = denominator + numerator * d;
        d = 1 / (std::abs(d) < TINY ? TINY : d);
        c = denominator + numerator / c;
        c = std::abs(c) < TINY ? TINY : c;
        value *= c * d;
        if (std::abs(c * d - 1) < CONVERGED)
            break;
    }
    return value;
}

/// Q(a, x) by its continued fraction, for x >= a + 1.
double gamma_fraction(double a, double x) {
    const double fraction = continued_fraction(x + 1 - a, [&](int n) {
        return Term{-n * (n - a), x + 2 * n + 1 - a};
    });
    return fraction * std::exp(a * std::log(x) - x - std::lgamma(a));
}

/// The continued fraction of the incomplete beta function, for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
    return continued_fraction(1, [&](int n) {
        const int m = n / 2;
        const double numerator = n % 2 ? -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))
                                       : m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
        return Term{numerator, 1};
    });
}

/// The regularised incomplete beta function I_x(a, b).
double incomplete_beta(double a, double b, double x) {
    if (x <= 0 || x >= 1)
        return x <= 0 ? 0 : 1;
    const double front =
        std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
    return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a
                                     : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

} // namespace

Moments moments_of(const std::vector<double>& values) {
    Moments result;
    double squares = 0;
    for (const double value : values) {
        result.count += 1;
        const double step = value - result.mean;
        result.mean += step / result.count;
        squares += step * (value - result.mean);
    }
    result.variance = result.count > 1 ? squares / (result.count - 1) : 0;
    return result;
}

double normal_p_value(double z) {
    return std::erfc(std::abs(z) / std::sqrt(2.0));
}

double z_of_mean(const Moments& sample, double expected) {
    const double difference = sample.mean - expected;
    if (sample.variance_of_mean() > 0)
        return difference / std::sqrt(sample.variance_of_mean());
    return difference == 0 ? 0 : std::copysign(INFINITE, difference);
}

double chi_squared_p_value(double statistic, double degrees) {
    require(degrees > 0 && statistic >= 0, "chi_squared_p_value: expected degrees > 0 and statistic >= 0");
    const double a = degrees / 2, x = statistic / 2;
    if (x == 0)
        return 1;
    return x < a + 1 ? 1 - gamma_series(a, x) : gamma_fraction(a, x);
}

ChiSquared chi_squared_test(const std::vector<double>& observed, const std::vector<double>& expected) {
    require(observed.size() == expected.size(), "chi_squared_test: expected as many cells as observed");
    std::vector<size_t> order(expected.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::sort(order.begin(), order.end(), [&](size_t i, size_t j) { return expected[i] < expected[j]; });

    // Collect small cells until they expect enough; what is left over joins the last cell.
    std::vector<Cell> cells;
    Cell pool;
    for (const size_t i : order) {
        if (expected[i] <= 0 && observed[i] > 0)
            return {INFINITE, 1, 0};
        pool.observed += observed[i];
        pool.expected += expected[i];
        if (pool.expected >= LEAST_EXPECTED) {
            cells.push_back(pool);
            pool = {};
        }
    }
    if (!cells.empty()) {
        cells.back().observed += pool.observed;
        cells.back().expected += pool.expected;
    }

    ChiSquared result;
    for (const Cell& cell : cells)
        result.statistic += (cell.observed - cell.expected) * (cell.observed - cell.expected) / cell.expected;
    result.degrees = cells.empty() ? 0 : static_cast<double>(cells.size() - 1);
    if (result.degrees > 0)
        result.p_value = chi_squared_p_value(result.statistic, result.degrees);
    return result;
}

Welch welch_test(const Moments& a, const Moments& b) {
    require(a.count > 1 && b.count > 1, "welch_test: expected two values or more in each sample");
    const double va = a.variance_of_mean(), vb = b.variance_of_mean(), sum = va + vb;
    if (sum == 0)
        return a.mean == b.mean ? Welch{0, a.count + b.count - 2, 1}
                                : Welch{INFINITE, a.count + b.count - 2, 0};
    Welch result;
    result.t = (a.mean - b.mean) / std::sqrt(sum);
    // Welch-Satterthwaite.
    result.degrees = sum * sum / (va * va / (a.count - 1) + vb * vb / (b.count - 1));
    result.p_value =
        incomplete_beta(result.degrees / 2, 0.5, result.degrees / (result.degrees + result.t * result.t));
    return result;
}

namespace {

template <class Float, class Wide>
double ulp_distance_of(Float value, Wide reference) {
    if (std::isnan(value) || std::isnan(reference))
        return std::isnan(value) && std::isnan(reference) ? 0 : INFINITE;
    if (std::isinf(value) || std::isinf(reference))
        return static_cast<Wide>(value) == reference ? 0 : INFINITE;
    const int smallest = std::numeric_limits<Float>::min_exponent - 1;
    const int exponent = reference == 0 ? smallest : std::max(std::ilogb(reference), smallest);
    const Wide ulp = std::scalbn(Wide{1}, exponent - (std::numeric_limits<Float>::digits - 1));
    return static_cast<double>(std::abs(static_cast<Wide>(value) - reference) / ulp);
}

} // namespace

double ulp_distance(float value, double reference) {
    return ulp_distance_of(value, reference);
}

double ulp_distance(double value, long double reference) {
    return ulp_distance_of(value, reference);
}

} // namespace clrt
