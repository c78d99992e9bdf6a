// SPDX-License-Identifier: Apache-2.0
// A scene whose light nothing but hits finds.
#pragma once

#include "support/render_scene.h"

namespace clrt {

/// The floor of a basin under a sun of such a diameter, seen through its water. A picture of 32 x 24.
inline void add_sunlit_basin(TestScene& scene, double sun_degrees) {
    scene.build.material("floor", "Kd 0.7 0.6 0.5").use("floor").floor(1);
    scene.build.material("water", "Kd 0 0 0\nKs 1 1 1\nTf 1 1 1\nNi 1.33\nillum 7").use("water");
    scene.build.polygon({{-1, 0.5, 1}, {1, 0.5, 1}, {1, 0.6, -1}, {-1, 0.6, -1}});
    scene.look({0, 2.5, 1}, {0, 0, 0}, 25);
    scene.options.light.suns = {{{0.3, 1, 0.2}, {3, 3, 3}, sun_degrees}};
    scene.options.light.environment = glm::dvec3(0.05);
    scene.options.transport.integrator = Integrator::BDPT;
    scene.options.film.size = {32, 24};
    scene.options.effects.all = false; // as in adjoining_rooms.h
}

} // namespace clrt
