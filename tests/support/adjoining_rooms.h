// SPDX-License-Identifier: Apache-2.0
// A scene whose light is hard to find for paths from the eye.
#pragma once

#include "support/render_scene.h"

namespace clrt {

/// Two rooms and a slit between them: a lamp in the one that the camera does not see, and of its walls
/// neither what it shines at. A picture of 32 x 24.
inline void add_adjoining_rooms(TestScene& scene) {
    scene.build.material("white", "Kd 0.75 0.75 0.75").material("lamp", "Kd 0 0 0\nKe 40 36 30");
    scene.build.material("gloss", "Kd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 20\nillum 2");
    scene.build.use("white");
    scene.build.box({-3, 0, -2}, {3, 2.5, 2}, Facing::INWARD);
    scene.build.polygon({{0, 0, -2}, {0, 0, 1.7}, {0, 2.5, 1.7}, {0, 2.5, -2}});
    scene.build.use("gloss").icosphere({1.6, 0.5, 0}, 0.5, 2, Facing::OUTWARD, Shading::SMOOTH);
    scene.build.use("lamp").polygon({{-2, 2.4, -1.2}, {-1.5, 2.4, -1.2}, {-1.5, 2.4, -0.7}, {-2, 2.4, -0.7}});
    scene.look({2.8, 1.6, 1.6}, {1, 0.9, -0.8}, 60);
    scene.options.film.size = {32, 24};
    scene.options.effects.all = false; // many samples: the small program is the fast one
}

} // namespace clrt
