// SPDX-License-Identifier: Apache-2.0
// What no error bar shows.
#pragma once

#include "paths/blind_spots.h"

#include <optional>
#include <vector>

namespace clrt {

/// What the scene and the integrator leave out of a picture, however many samples it has.
struct BiasSources {
    std::optional<double> cut_radiance; ///< where paths were cut: what bounds the light of one by its weight
                                        ///< (render/cut_paths.h)
    std::vector<BlindSpot> blind_spots;
};

} // namespace clrt
