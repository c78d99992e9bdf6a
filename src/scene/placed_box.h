// SPDX-License-Identifier: Apache-2.0
// Where the instances of a prototype are, as boxes in the normalised frame.
#pragma once

#include "scene/normalise.h"
#include "scene/scene.h"

#include <array>
#include <functional>

namespace clrt {

/// A point of an instance's prototype in the normalised frame.
glm::dvec3 placed(const Instance& instance, const glm::dvec3& p);

/// A box in a prototype's frame, which instances place.
struct PlacedBox {
    Bounds bounds; ///< low above high: it is empty

    bool is_empty() const { return bounds.low.x > bounds.high.x; }
    /// Its corners where an instance places them.
    std::array<glm::dvec3, 8> corners_in(const Instance& instance) const;
    /// A lower bound of the squared distance from a point to what an instance places.
    double squared_distance_in(const Instance& instance, const glm::dvec3& p) const;
};

/// The box around those triangles of a prototype that are asked for.
PlacedBox box_of_prototype(const Scene& scene, const Prototype& prototype,
                           const std::function<bool(const Triangle&)>& asks);

} // namespace clrt
