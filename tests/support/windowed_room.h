// SPDX-License-Identifier: Apache-2.0
// A room that light enters through one window.
#pragma once

#include "support/render_scene.h"

namespace clrt {

/// The walls of a room from (-3, 0, -2) to (2, 2.5, 2) with a window of 1 x 1 around (2, 1.5, 0), in the
/// material in use.
inline void add_windowed_room(SceneBuilder& build) {
    for (const double y : {0.0, 2.5})
        build.polygon({{-3, y, -2}, {-3, y, 2}, {2, y, 2}, {2, y, -2}});
    for (const double z : {-2.0, 2.0})
        build.polygon({{-3, 0, z}, {2, 0, z}, {2, 2.5, z}, {-3, 2.5, z}});
    build.polygon({{-3, 0, -2}, {-3, 2.5, -2}, {-3, 2.5, 2}, {-3, 0, 2}});
    build.polygon({{2, 0, -2}, {2, 1, -2}, {2, 1, 2}, {2, 0, 2}});
    build.polygon({{2, 2, -2}, {2, 2.5, -2}, {2, 2.5, 2}, {2, 2, 2}});
    build.polygon({{2, 1, -2}, {2, 2, -2}, {2, 2, -0.5}, {2, 1, -0.5}});
    build.polygon({{2, 1, 0.5}, {2, 2, 0.5}, {2, 2, 2}, {2, 1, 2}});
}

} // namespace clrt
