// SPDX-License-Identifier: Apache-2.0
#include "bench/measure.h"

#include "seconds.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace clrt {

namespace {

/// The value below which a share of the sorted values lies, interpolated.
double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * double(sorted.size() - 1);
    const size_t below = size_t(std::floor(place));
    const size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - double(below)) * (sorted[above] - sorted[below]);
}

} // namespace

Cost measure(const std::function<void()>& action) {
    const auto wall = std::chrono::steady_clock::now();
    const double cpu = processor_seconds();
    action();
    return {std::chrono::duration<double>(std::chrono::steady_clock::now() - wall).count(),
            processor_seconds() - cpu};
}

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.5), quantile(values, 0.25), quantile(values, 0.75)};
}

} // namespace clrt
