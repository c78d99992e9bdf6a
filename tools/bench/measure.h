// SPDX-License-Identifier: Apache-2.0
// Clocks, and what many measurements say.
#pragma once

#include <functional>
#include <vector>

namespace clrt {

/// What an action took.
struct Cost {
    double wall = 0; ///< seconds
    double cpu = 0;  ///< seconds of all threads of the process together; a loaded machine changes it little

    Cost& operator+=(const Cost& other) {
        wall += other.wall;
        cpu += other.cpu;
        return *this;
    }
};

/// Runs an action and measures it.
Cost measure(const std::function<void()>& action);

/// The middle of some values and how far they scatter.
struct Spread {
    double median = 0;
    double low = 0, high = 0; ///< quartiles, interpolated
};

/// `values` is not empty.
Spread spread_of(std::vector<double> values);

} // namespace clrt
