// SPDX-License-Identifier: Apache-2.0
// What no error bar shows.
#pragma once

#include "paths/blind_spots.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Light that only hits find (HitPaths).
struct HitLight {
    std::string paths;   ///< as an expression
    double radiance = 0; ///< the largest that one sample of the picture brings by such a path
};

/// What the scene and the integrator leave out of a picture: however many samples it has, or until it has
/// enough.
struct BiasSources {
    std::optional<double> cut_radiance; ///< where paths were cut: what bounds the light of one by its weight
                                        ///< (render/cut_paths.h)
    std::vector<BlindSpot> blind_spots;
    std::optional<HitLight> hits; ///< (render/unmet_light.h); none: there is no such light
};

} // namespace clrt
