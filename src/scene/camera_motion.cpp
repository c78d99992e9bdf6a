// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_motion.h"

#include "error.h"
#include "scene/vectors.h"
#include "scene/view_frame.h"

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace clrt {
namespace {

/// Places on the way at which the view is examined, both ends among them.
constexpr int PLACES = 1025;
/// A way of sight that is shorter than this share of the longest has lost its direction.
constexpr double LEAST_WAY = 1e-6;

CameraPose pose_of(const Camera& camera) {
    return {camera.eye, camera.at, camera.up};
}

bool are_same(const CameraPose& a, const CameraPose& b) {
    return a.eye == b.eye && a.at == b.at && a.up == b.up;
}

/// a + t (b - a) in each part; b itself at the end.
CameraPose mix(const CameraPose& a, const CameraPose& b, double t) {
    if (t == 1)
        return b;
    return {glm::mix(a.eye, b.eye, t), glm::mix(a.at, b.at, t), glm::mix(a.up, b.up, t)};
}

void check_way(const CameraPose& open, const CameraPose& close) {
    const double longest = std::max(glm::distance(open.eye, open.at), glm::distance(close.eye, close.at));
    for (int i = 0; i < PLACES; ++i) {
        const CameraPose pose = mix(open, close, double(i) / (PLACES - 1));
        const glm::dvec3 look = pose.at - pose.eye;
        if (!(glm::length(look) > LEAST_WAY * longest))
            throw UsageError(
                fmt::format("--end-eye and --end-at: expected a camera that never meets what it looks "
                            "at, found both at {} on the way",
                            triple(pose.eye)));
        if (!(glm::length(pose.up) > 0) || is_along(look, pose.up))
            throw UsageError(
                fmt::format("--end-eye, --end-at and --end-up: expected a camera that never looks "
                            "along its up vector, found it so at {} on the way",
                            triple(pose.eye)));
    }
}

} // namespace

glm::dvec2 shutter_times(const CameraOptions& options) {
    return options.shutter.value_or(glm::dvec2(0, 1));
}

void set_motion(const CameraOptions& options, Camera& camera) {
    const CameraPose start = pose_of(camera);
    const CameraPose end = {options.end_eye.value_or(start.eye), options.end_at.value_or(start.at),
                            options.end_up.value_or(start.up)};
    if (!is_finite(end.eye) || !is_finite(end.at) || !is_finite(end.up))
        throw UsageError("--end-eye, --end-at, --end-up: expected finite numbers");
    if (are_same(start, end))
        return;
    const glm::dvec2 times = shutter_times(options);
    const CameraPose open = mix(start, end, times.x), close = mix(start, end, times.y);
    check_way(open, close);
    camera.eye = open.eye;
    camera.at = open.at;
    camera.up = open.up;
    if (!are_same(open, close))
        camera.end = close;
}

} // namespace clrt
