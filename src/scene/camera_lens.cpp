// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_lens.h"

#include "error.h"
#include "scene/vectors.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {
namespace {

/// Depth of a point: its distance from the eye along the axis.
double depth_of(const glm::dvec3& point, const Camera& camera) {
    return glm::dot(point - camera.eye, glm::normalize(camera.at - camera.eye));
}

double focus_depth(const CameraOptions& options, const Camera& camera) {
    if (options.focus)
        return *options.focus;
    const double depth = depth_of(options.focus_point.value_or(camera.at), camera);
    if (!(depth > 0))
        throw UsageError(
            fmt::format("--focus: expected a point before the camera, found {}, which lies {:.6g} "
                        "behind it",
                        triple(*options.focus_point), -depth));
    return depth;
}

} // namespace

void set_lens(const CameraOptions& options, Camera& camera, NoticeList& notices) {
    camera.aperture = options.aperture.value_or(0);
    if (options.fstop && options.focal_length)
        camera.aperture = *options.focal_length / *options.fstop;
    if (!(camera.aperture > 0))
        return;
    camera.focus = focus_depth(options, camera);
    camera.blades = options.blades;
    if (!options.focus && !options.focus_point)
        notices.add(fmt::format("camera: --focus {}", camera.focus));
}

} // namespace clrt
