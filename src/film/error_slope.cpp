// SPDX-License-Identifier: Apache-2.0
#include "film/error_slope.h"

#include <cmath>

namespace clrt {

namespace {

constexpr size_t FEWEST_FOR_SLOPE = 5;   ///< errors
constexpr double OCTAVES_FOR_SLOPE = 16; ///< last over first samples: four octaves

/// 97.5 % quantile of Student's t for 1 to 63 degrees of freedom (Abramowitz and Stegun, table 26.10, by
/// their expansion 26.7.5 beyond 7).
double student_quantile(size_t degrees) {
    static const double SMALL[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365};
    if (degrees <= 7)
        return SMALL[degrees - 1];
    const double z = 1.959964, n = double(degrees);
    return z + (z * z * z + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

/// Half the length of the 95 % interval of a number that takes these values when one replicate is left out.
double jackknife_reach(const std::vector<double>& values) {
    const double n = double(values.size());
    double mean = 0, spread = 0;
    for (const double value : values)
        mean += value / n;
    for (const double value : values)
        spread += (value - mean) * (value - mean);
    return student_quantile(values.size() - 1) * std::sqrt(spread * (n - 1) / n);
}

/// Slope of the line of least squares.
double line_slope(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = double(x.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / n;
        mean_y += y[i] / n;
    }
    for (size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    return xy / xx;
}

} // namespace

std::optional<ErrorSlope> error_slope(const std::vector<SquaredError>& history) {
    if (history.size() < FEWEST_FOR_SLOPE ||
        double(history.back().samples) < OCTAVES_FOR_SLOPE * double(history.front().samples))
        return std::nullopt;
    return fit_error_slope(history);
}

std::optional<ErrorSlope> fit_error_slope(const std::vector<SquaredError>& history) {
    if (history.size() < 2)
        return std::nullopt;
    const size_t replicates = history.back().without.size();
    for (const SquaredError& error : history)
        if (error.without.size() != replicates || replicates == 0 || !(error.mean_squared > 0))
            return std::nullopt;
    // Fit the errors, then those that leave out one replicate: what they share by being nested is inside the
    // spread.
    std::vector<double> x, y, without;
    for (const SquaredError& error : history) {
        x.push_back(std::log(double(error.samples)));
        y.push_back(0.5 * std::log(error.mean_squared));
    }
    ErrorSlope result{line_slope(x, y), 0, history.front().samples, history.back().samples};
    for (size_t k = 0; k < replicates; ++k) {
        for (size_t i = 0; i < history.size(); ++i)
            y[i] = 0.5 * std::log(history[i].without[k]);
        without.push_back(line_slope(x, y));
    }
    result.reach = jackknife_reach(without);
    return result;
}

} // namespace clrt
