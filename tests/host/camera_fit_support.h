// SPDX-License-Identifier: Apache-2.0
// Scenes of points to which a camera is fitted.
#pragma once

#include "scene/camera_fit.h"
#include "scene_support.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <string>
#include <vector>

namespace clrt {

/// A camera that was fitted, and what was said of it.
struct Fitted {
    Camera camera;
    std::vector<std::string> notices;
};

/// Points of a scene, three by three its triangles, in world units.
using Points = std::vector<glm::dvec3>;

/// The box of points.
inline Bounds bounds_of(const Points& points) {
    Bounds box{points.front(), points.front()};
    for (const glm::dvec3& p : points)
        box = {glm::min(box.low, p), glm::max(box.high, p)};
    return box;
}

/// A scene of triangles, normalised.
inline Scene scene_of(const Points& points) {
    Scene scene;
    scene.normalisation = fit_normalisation(bounds_of(points));
    for (const glm::dvec3& world : points) {
        const glm::dvec3 p = to_normalised(scene.normalisation, world);
        scene.positions.push_back({float(p.x), float(p.y), float(p.z), 0});
        for (int axis = 0; axis < 3; ++axis)
            scene.extent = std::max(scene.extent, float(std::fabs(p[axis])));
    }
    for (u32 i = 0; i + 2 < u32(points.size()); i += 3) {
        Triangle triangle{};
        triangle.v0 = i;
        triangle.v1 = i + 1;
        triangle.v2 = i + 2;
        scene.triangles.push_back(triangle);
    }
    return scene;
}

/// The camera that options leave for such a scene.
inline Fitted fit_points(const CameraOptions& options, glm::ivec2 size, const Points& points) {
    NoticeList notices;
    const Camera camera = fit_camera(options, size, scene_of(points), bounds_of(points), notices);
    return {camera, notices.lines()};
}

/// A box of 12 triangles; faces whose bit is set in `faces` (order +Z -Z +X -X +Y -Y), fronts inwards or
/// outwards.
inline Points box_points(const Bounds& box, unsigned faces = 0x3f, bool inwards = false) {
    const auto corner = [&](int i) {
        return glm::dvec3((i & 1 ? box.high : box.low).x, (i & 2 ? box.high : box.low).y,
                          (i & 4 ? box.high : box.low).z);
    };
    const int outward[6][4] = {{4, 5, 7, 6}, {1, 0, 2, 3}, {5, 1, 3, 7},
                               {0, 4, 6, 2}, {6, 7, 3, 2}, {0, 1, 5, 4}};
    Points points;
    for (int f = 0; f < 6; ++f)
        if (faces >> f & 1)
            for (const int i : {0, 1, 2, 0, 2, 3})
                points.push_back(corner(outward[f][inwards ? (4 - i) % 4 : i]));
    return points;
}

} // namespace clrt
