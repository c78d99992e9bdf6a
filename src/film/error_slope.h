// SPDX-License-Identifier: Apache-2.0
// How fast a picture's error falls.
#pragma once

#include "film/film_error.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace clrt {

/// How the error falls: d log(error) / d log(samples), -0.5 for independent samples.
struct ErrorSlope {
    double slope = 0;
    double reach = 0; ///< half the length of its 95 % interval, by the jackknife over replicates
    std::uint64_t first_samples = 0, last_samples = 0;
};

/// The line of least squares through a render's errors. None under four octaves of samples, five errors or
/// four replicates, or where an error is 0.
std::optional<ErrorSlope> error_slope(const std::vector<SquaredError>& history);

/// The same through as few as two errors.
std::optional<ErrorSlope> fit_error_slope(const std::vector<SquaredError>& history);

} // namespace clrt
