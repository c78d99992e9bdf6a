// SPDX-License-Identifier: Apache-2.0
#include "scene/normalise.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace clrt {

double Bounds::radius() const {
    return 0.5 * glm::length(high - low);
}

Normalisation fit_normalisation(const Bounds& bounds) {
    Normalisation frame;
    frame.centre = bounds.centre();
    const double radius = bounds.radius();
    if (radius > 0) {
        int exponent = 0;
        std::frexp(radius, &exponent); // radius = m 2^exponent, m in [1/2, 1)
        frame.scale = std::ldexp(1.0, 1 - exponent);
    }
    return frame;
}

glm::dvec3 position_origin(const Normalisation& frame) {
    glm::dvec3 origin(0);
    bool is_far = false;
    for (int c = 0; c < 3; ++c) {
        const double units = frame.centre[c] * frame.scale;
        is_far |= std::fabs(units) > FAR_SCENE;
        origin[c] = std::nearbyint(units) / frame.scale;
    }
    return is_far ? origin : glm::dvec3(0);
}

} // namespace clrt
