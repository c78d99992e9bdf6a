// SPDX-License-Identifier: Apache-2.0
#include "scene/file_camera.h"

#include "error.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

/// How many names an error lists.
constexpr size_t MOST_LISTED = 10;

std::string label(const std::vector<FileCamera>& cameras, size_t i) {
    return fmt::format("{} {}", i + 1, clrt::quoted(cameras[i].name));
}

[[noreturn]] void reject_camera(const std::vector<FileCamera>& cameras, const std::string& wanted) {
    std::string known = cameras.empty() ? "a scene with cameras" : "one of";
    for (size_t i = 0; i < std::min(cameras.size(), MOST_LISTED); ++i)
        known += (i ? ", " : " ") + label(cameras, i);
    if (cameras.size() > MOST_LISTED)
        known += fmt::format(" and {} more", cameras.size() - MOST_LISTED);
    throw UsageError(fmt::format("option --camera: expected {}, found {}", known, clrt::quoted(wanted)));
}

/// By name, else by number.
size_t find_camera(const std::vector<FileCamera>& cameras, const std::string& wanted) {
    if (wanted.empty())
        return 0;
    for (size_t i = 0; i < cameras.size(); ++i)
        if (cameras[i].name == wanted)
            return i;
    for (size_t i = 0; i < cameras.size(); ++i)
        if (std::to_string(i + 1) == wanted)
            return i;
    reject_camera(cameras, wanted);
}

/// A point ahead, at the depth of the scene's middle: what is in focus, and what a turntable goes around.
glm::dvec3 point_ahead(const Camera& camera, const Bounds& bounds) {
    const glm::dvec3 look = glm::normalize(camera.at - camera.eye);
    const double depth = glm::dot(bounds.centre() - camera.eye, look);
    return camera.eye + look * (depth > 0 ? depth : 1);
}

/// What is asked for stays: an angle of view, or another projection.
void take_projection(const Camera& camera, CameraOptions& options) {
    const bool is_asked_for = options.fov_degrees || options.focal_length || options.ortho_height ||
                              options.projection != PROJECTION_PERSPECTIVE;
    if (is_asked_for)
        return;
    options.projection = camera.projection;
    if (camera.projection == PROJECTION_ORTHOGRAPHIC)
        options.ortho_height = camera.ortho_height;
    else
        options.fov_degrees = camera.fov_degrees;
}

/// Where the camera is at time 1; it looks as far ahead as at time 0. An up that is asked for stays.
void take_motion(const Camera& start, const Camera& end, CameraOptions& options) {
    const bool stands_still = start.eye == end.eye && start.at == end.at && start.up == end.up;
    if (stands_still || options.end_eye || options.end_at || options.end_up)
        return;
    const double depth = glm::distance(*options.eye, *options.at);
    options.end_eye = end.eye;
    options.end_at = end.eye + depth * glm::normalize(end.at - end.eye);
    if (!options.up)
        options.end_up = end.up;
}

glm::ivec2 size_of_aspect(double aspect, glm::ivec2 most) {
    const double width = std::min(double(most.x), most.y * aspect);
    return glm::ivec2(std::max(1, int(std::lround(width))), std::max(1, int(std::lround(width / aspect))));
}

} // namespace

std::optional<glm::ivec2> take_file_camera(const std::vector<FileCamera>& cameras,
                                           const std::vector<FileCamera>& end_cameras, const Bounds& bounds,
                                           SceneRequest& request, NoticeList& notices) {
    CameraOptions& options = request.camera;
    if (cameras.empty() && !options.file_camera.empty())
        reject_camera(cameras, options.file_camera);
    if (cameras.empty() || options.eye || options.at || options.view)
        return std::nullopt;
    const size_t chosen = find_camera(cameras, options.file_camera);
    const FileCamera& file = cameras[chosen];
    options.eye = file.camera.eye;
    options.at = point_ahead(file.camera, bounds);
    if (!end_cameras.empty())
        take_motion(file.camera, end_cameras[chosen].camera, options);
    options.up = options.up.value_or(file.camera.up);
    take_projection(file.camera, options);
    notices.add(fmt::format(
        "camera: {} of the file{}", label(cameras, chosen),
        cameras.size() > 1 ? fmt::format(", which has {}: --camera chooses", cameras.size()) : ""));
    if (request.is_size_given || !file.aspect)
        return std::nullopt;
    request.size = size_of_aspect(*file.aspect, request.size);
    return request.size;
}

} // namespace clrt
