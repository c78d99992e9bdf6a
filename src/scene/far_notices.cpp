// SPDX-License-Identifier: Apache-2.0
#include "scene/far_notices.h"

#include "scene/camera_params.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <vector>

namespace clrt {

namespace {

/// Roundoff of single precision: a file whose steps are finer has more digits than floats.
constexpr double FLOAT_ROUNDOFF = 0x1p-24;

/// Of the scene's diameter: a sixteenth of a pixel in a picture of a thousand pixels.
constexpr double COARSE_STEP = 0x1p-14;

/// Multiples of a decimal step are off by their rounding and that of the step.
constexpr double ROUNDING = 0x1p-51;

/// Up to here steps are those of doubles themselves.
constexpr double DOUBLE_STEP = 0x1p-50;

bool is_multiple(double x, double step) {
    return std::fabs(x - std::nearbyint(x / step) * step) <= std::min(ROUNDING * std::fabs(x), step / 8);
}

/// Steps of writers: powers of ten (digits) and of two (floats) from `least` up to `most`, the coarsest
/// first.
std::vector<double> steps_between(double least, double most) {
    std::vector<double> steps;
    for (int e = int(std::floor(std::log10(least))); std::pow(10, e) <= most; ++e)
        steps.push_back(std::pow(10, e));
    for (int e = std::ilogb(least); std::ldexp(1, e) <= most; ++e)
        steps.push_back(std::ldexp(1, e));
    steps.erase(std::remove_if(steps.begin(), steps.end(), [least](double step) { return step < least; }),
                steps.end());
    std::sort(steps.rbegin(), steps.rend());
    return steps;
}

/// The coarsest step, not below `least`, of which all coordinates along an axis are multiples; 0 if none is.
double step_along(int axis, const Mesh& mesh, double least, double most) {
    std::vector<double> steps = steps_between(least, most);
    for (const MeshTriangle& triangle : mesh.triangles)
        for (const u32 v : triangle.v)
            while (!is_multiple(mesh.positions[v][axis], steps.front())) {
                steps.erase(steps.begin());
                if (steps.empty())
                    return 0;
            }
    return steps.front();
}

/// True if the sphere around the box is outside the cone around the picture, or the cylinder of parallel
/// rays.
bool is_out_of_view(const Camera& camera, const Bounds& bounds, glm::ivec2 size) {
    const glm::dvec3 way = bounds.centre() - camera.eye;
    const double distance = glm::length(way), radius = bounds.radius();
    if (distance <= radius)
        return false;
    if (camera.projection == PROJECTION_EQUIRECTANGULAR)
        return false;
    const double aspect = double(size.x) / size.y;
    const double half_diagonal =
        shown_height(camera, 1) *
        (std::hypot(1.0, aspect) / 2 + std::hypot(camera.shift.x * aspect, camera.shift.y));
    const glm::dvec3 look = glm::normalize(camera.at - camera.eye);
    const double cosine = glm::dot(look, way / distance);
    if (camera.projection == PROJECTION_ORTHOGRAPHIC)
        return glm::length(glm::cross(look, way)) > half_diagonal + radius || distance * cosine < -radius;
    const double half_angle =
        camera.projection == PROJECTION_FISHEYE ? half_diagonal : std::atan(half_diagonal);
    return std::acos(std::clamp(cosine, -1.0, 1.0)) > half_angle + std::asin(radius / distance);
}

} // namespace

void note_coarse_digits(const Mesh& mesh, const Bounds& bounds, const std::string& path,
                        NoticeList& notices) {
    const double diameter = 2 * bounds.radius(), least = COARSE_STEP * diameter;
    for (int axis = 0; axis < 3; ++axis) {
        const double most = std::max(std::fabs(bounds.low[axis]), std::fabs(bounds.high[axis]));
        // Near the origin steps are how a scene is modelled, and a wall in one plane has none.
        if (2 * FLOAT_ROUNDOFF * most < least || bounds.low[axis] == bounds.high[axis])
            continue;
        const double step = step_along(axis, mesh, least, most);
        if (step > 0 && (step >= FLOAT_ROUNDOFF * most || step <= DOUBLE_STEP * most))
            notices.add_line(fmt::format("{}: {} is written in steps of {:g} near {:g}, {:.1e} of the scene: "
                                         "export it with more digits, or near its own origin",
                                         path, "xyz"[axis], step, most, step / diameter));
    }
}

void note_relative_positions(const Normalisation& frame, NoticeList& notices) {
    const glm::dvec3 origin = position_origin(frame);
    if (origin == glm::dvec3(0))
        return;
    notices.add(fmt::format(
        "layer P counts from {} (metadata clrt.P.origin): floats would hold steps of {:g} there",
        triple(origin),
        2 * FLOAT_ROUNDOFF * std::max({std::fabs(origin.x), std::fabs(origin.y), std::fabs(origin.z)})));
}

void note_far_options(const Camera& camera, glm::ivec2 size, const std::vector<PointOptions>& points,
                      const Bounds& bounds, NoticeList& notices) {
    const glm::dvec3 centre = bounds.centre();
    const double radius = bounds.radius();
    if (!(radius > 0))
        return;
    const auto where = [&](const glm::dvec3& p) {
        return fmt::format(
            "{:g} from the scene, whose centre is {} and radius {:g} in the file's coordinates",
            glm::distance(p, centre), triple(centre), radius);
    };
    const double pixel = shown_height(camera, glm::distance(camera.eye, centre)) / size.y;
    if (2 * radius < pixel)
        notices.add(fmt::format("camera: --eye {} is {}: it covers less than a pixel", triple(camera.eye),
                                where(camera.eye)));
    else if (is_out_of_view(camera, bounds, size))
        notices.add(
            fmt::format("camera: --at {} is {}: it is out of view", triple(camera.at), where(camera.at)));
    for (const PointOptions& point : points)
        if (glm::distance(point.position, centre) > FAR_LIGHT * radius)
            notices.add(
                fmt::format("{} {} is {}", point.source, triple(point.position), where(point.position)));
}

} // namespace clrt
