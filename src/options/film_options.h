// SPDX-License-Identifier: Apache-2.0
// The picture as the kernels compute it.
#pragma once

#include "options/names.h"

#include <glm/vec2.hpp>
#include <optional>

namespace clrt {

enum class Filter { BOX, TENT, GAUSSIAN };

template <>
inline constexpr Named<Filter> NAMES<Filter>[] = {
    {Filter::BOX, "box"}, {Filter::TENT, "tent"}, {Filter::GAUSSIAN, "gaussian"}};

/// A window of the picture in pixels; x1, y1 excluded.
struct Crop {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};

struct FilmOptions {
    glm::ivec2 size{800, 600}; ///< pixels
    std::optional<Crop> crop;
    Filter filter = Filter::BOX;
    std::optional<double> filter_radius; ///< pixels; box 0.5, tent 1, gaussian 1.5
};

} // namespace clrt
