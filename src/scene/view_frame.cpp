// SPDX-License-Identifier: Apache-2.0
#include "scene/view_frame.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace clrt {
namespace {

/// Sine of the angle below which up and look are parallel.
constexpr double PARALLEL = 1e-6;
/// To the right, above and in front: three sides show, the front most.
constexpr glm::dvec3 THREE_QUARTER_VIEW(0.5, 0.35, 1);

} // namespace

glm::dmat3 up_frame(const glm::dvec3& up) {
    const glm::dvec3 to = glm::normalize(up);
    const double cosine = to.y;
    if (cosine == -1)
        return {{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}};
    // Rodrigues' formula about DEFAULT_UP x to = (to.z, 0, -to.x): columns are the images of the axes.
    const double k = 1 / (1 + cosine);
    return {
        {1 - k * to.x * to.x, -to.x, -k * to.x * to.z}, to, {-k * to.x * to.z, -to.z, 1 - k * to.z * to.z}};
}

glm::dvec3 direction_to_eye(const std::optional<View>& view) {
    if (!view)
        return glm::normalize(THREE_QUARTER_VIEW);
    switch (*view) {
    case View::FRONT:
        return {0, 0, 1};
    case View::BACK:
        return {0, 0, -1};
    case View::LEFT:
        return {-1, 0, 0};
    case View::RIGHT:
        return {1, 0, 0};
    case View::TOP:
        return {0, 1, 0};
    case View::BOTTOM:
        return {0, -1, 0};
    case View::ISO:
        break;
    }
    return glm::normalize(glm::dvec3(1));
}

bool is_along(const glm::dvec3& look, const glm::dvec3& up) {
    return glm::length(glm::cross(glm::normalize(look), glm::normalize(up))) < PARALLEL;
}

glm::dvec3 up_beside(const glm::dvec3& look, const glm::dmat3& frame) {
    const glm::dvec3 local = look * frame; // times the transpose
    if (std::fabs(local.y) > std::max(std::fabs(local.x), std::fabs(local.z)))
        return frame[2] * (local.y < 0 ? -1. : 1.);
    return frame[1];
}

PictureAxes picture_axes(const glm::dvec3& look, const glm::dvec3& up) {
    PictureAxes axes;
    axes.look = glm::normalize(look);
    axes.right = glm::normalize(glm::cross(axes.look, glm::normalize(up)));
    axes.up = glm::cross(axes.right, axes.look);
    return axes;
}

} // namespace clrt
