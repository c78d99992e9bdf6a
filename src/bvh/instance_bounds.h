// SPDX-License-Identifier: Apache-2.0
// The boxes of instances in the world.
#pragma once

#include "bvh/box.h"
#include "kernels/shared/scene_types.h"

#include <vector>

namespace clrt {

/// What a prototype's instances may cover: boxes around parts of its corners, some tens. Placed one by one
/// they enclose an instance more closely than the box of all would.
class PrototypeHull {
public:
    /// Around the corners of triangles, which must be finite.
    PrototypeHull(const std::vector<vec4>& positions, const std::vector<Triangle>& triangles);

    /// Encloses the corners of an instance as kernels/geometry/instance.h rounds them.
    Box placed(const Instance& instance) const;

private:
    struct Part {
        float centre[3], half[3];
    };
    std::vector<Part> parts_;
    float largest_[3] = {0, 0, 0}; // |coordinate|
};

} // namespace clrt
