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

} // namespace clrt
