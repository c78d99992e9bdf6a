// SPDX-License-Identifier: Apache-2.0
#include "scene/clear_eye.h"

#include "scene/normalise.h"
#include "scene/triangle_corners.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

/// Roundoff of single precision.
constexpr double EYE_ROUNDOFF = 0x1p-24;
/// A plane's side is chosen by the view's axis where their cosine is this large: most of the picture is
/// there.
constexpr double FACED = 0.5;
/// Each step clears one plane and may come nearer to another: as often as surface_inset.
constexpr int CLEARING_STEPS = 6;

/// A plane that the eye lies on.
struct EyePlane {
    size_t triangle;
    glm::dvec3 point, normal; ///< of length 1, towards the side that the eye is to be on
    double clearance;
};

double largest_part(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

/// u (4 M + 24 E) of a triangle in this box: kernels/geometry/surface.h, surface_offset_bound.
double clearance_of(const Bounds& box) {
    return EYE_ROUNDOFF * (4 * largest_part(glm::max(glm::abs(box.low), glm::abs(box.high))) +
                           24 * largest_part(box.high - box.low));
}

/// True if a point of the triangle's plane is inside its edges or at most `margin` beyond them.
bool is_inside(const TriangleCorners& c, const glm::dvec3& normal, const glm::dvec3& p, double margin) {
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 inward = glm::cross(normal, c.p[(i + 1) % 3] - c.p[i]);
        if (glm::dot(p - c.p[i], inward) < -margin * glm::length(inward))
            return false;
    }
    return true;
}

/// 1 or -1: the side of a plane on which the eye is, `distance` being rounded; by the view where that is
/// nothing but rounding.
double side_of_eye(const Camera& camera, const glm::dvec3& normal, double distance, double rounding) {
    if (std::fabs(distance) > rounding)
        return std::copysign(1, distance);
    const double along = glm::dot(glm::normalize(camera.at - camera.eye), normal),
                 upward = glm::dot(glm::normalize(camera.up), normal);
    const double side = std::fabs(along) < FACED && std::fabs(upward) >= FACED ? upward : along;
    return side < 0 ? -1 : 1;
}

std::vector<EyePlane> planes_at(const Scene& scene, const glm::dvec3& eye) {
    const double rounding = 4 * EYE_ROUNDOFF * std::max(largest_part(glm::abs(eye)), 1.);
    using Planes = std::vector<EyePlane>;
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, scene.triangles.size(), TRIANGLE_GRAIN), Planes(),
        [&](const tbb::blocked_range<size_t>& range, Planes planes) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const TriangleCorners c = corners_of(scene.positions, scene.triangles[i]);
                const Bounds box{glm::min(c.p[0], glm::min(c.p[1], c.p[2])),
                                 glm::max(c.p[0], glm::max(c.p[1], c.p[2]))};
                const double bound = clearance_of(box);
                if (largest_part(glm::max(box.low - eye, eye - box.high)) > bound)
                    continue;
                const glm::dvec3 across = glm::cross(c.p[1] - c.p[0], c.p[2] - c.p[0]);
                const double area = glm::length(across);
                if (!(area > 0))
                    continue;
                const glm::dvec3 normal = across / area;
                const double distance = glm::dot(eye - c.p[0], normal);
                if (std::fabs(distance) >= bound || !is_inside(c, normal, eye, bound))
                    continue;
                const double side = side_of_eye(scene.camera, normal, distance, rounding);
                planes.push_back({i, c.p[0], normal * side, bound});
            }
            return planes;
        },
        [](Planes a, const Planes& b) {
            a.insert(a.end(), b.begin(), b.end());
            return a;
        });
}

} // namespace

void clear_eye(Scene& scene, NoticeList& notices) {
    if (scene.camera.end)
        return;
    const glm::dvec3 start = to_dvec3(to_vec4(to_normalised(scene.normalisation, scene.camera.eye)));
    const std::vector<EyePlane> planes = planes_at(scene, start);
    if (planes.empty())
        return;
    glm::dvec3 eye = start;
    for (int step = 0; step < CLEARING_STEPS; ++step)
        for (const EyePlane& plane : planes)
            eye += plane.normal * std::max(plane.clearance - glm::dot(eye - plane.point, plane.normal), 0.);
    const glm::dvec3 move = (eye - start) / scene.normalisation.scale;
    const u32 material = scene.triangles[planes.front().triangle].material;
    notices.add(fmt::format("camera: the eye lies on '{}', and is moved off it by {:.2g}",
                            scene.material_names[material], glm::length(move)));
    scene.camera.eye += move;
    scene.camera.at += move;
}

} // namespace clrt
