// SPDX-License-Identifier: Apache-2.0
// Pictures for the page, as files that browsers show and that cost no compression: BMP.
#pragma once

#include "options/output_options.h"
#include "view/snapshot.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Pixels that a page gets at most. Of larger pictures it gets every second, third, ... pixel of every
/// second, third, ... row, which is more than a screen has.
constexpr size_t MOST_PAGE_PIXELS = size_t(1) << 24;

/// The picture as its PNG would show it, without alpha.
std::string page_picture(const Snapshot& snapshot, double exposure_ev, Tonemap tonemap,
                         size_t most_pixels = MOST_PAGE_PIXELS);

/// How errors become colours: evenly on a logarithmic scale.
struct ErrorScale {
    double low = 0, high = 1;         ///< what the first and the last colour mean, relative
    std::vector<std::string> colours; ///< "#rrggbb", at equal distances
};

/// From a tenth of the picture's error to ten times it. None where there is no error map.
std::optional<ErrorScale> error_scale(const Snapshot& snapshot);

/// The error map; black where there is none.
std::string page_error_map(const Snapshot& snapshot, size_t most_pixels = MOST_PAGE_PIXELS);

} // namespace clrt
