// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_params.h"

#include "scene/normalise.h"
#include "scene/vectors.h"
#include "scene/view_frame.h"

#include <cmath>
#include <glm/geometric.hpp>

namespace clrt {
namespace {

bool is_parallel(const Camera& camera) {
    return camera.projection == PROJECTION_ORTHOGRAPHIC;
}

} // namespace

double shown_height(const Camera& camera, double distance) {
    return is_parallel(camera) ? camera.ortho_height
                               : 2 * std::tan(0.5 * camera.fov_degrees * (PI / 180)) * distance;
}

CameraParams make_camera_params(const Camera& camera, const Normalisation& frame, glm::ivec2 size) {
    const PictureAxes axes = picture_axes(camera.at - camera.eye, camera.up);
    const double pixel = shown_height(camera, 1) * (is_parallel(camera) ? frame.scale : 1) / size.y;
    CameraParams params{};
    params.eye = to_vec4(to_normalised(frame, camera.eye));
    params.film_dx = to_vec4(axes.right * pixel);
    params.film_dy = to_vec4(axes.up * -pixel);
    params.look = to_vec4(axes.look);
    params.projection = u32(camera.projection);
    return params;
}

FilmRay film_ray(const CameraParams& camera, const glm::dvec2& film) {
    const glm::dvec3 offset = to_dvec3(camera.film_dx) * film.x + to_dvec3(camera.film_dy) * film.y;
    const glm::dvec3 eye = to_dvec3(camera.eye), look = to_dvec3(camera.look);
    return camera.projection == PROJECTION_ORTHOGRAPHIC ? FilmRay{eye + offset, look}
                                                        : FilmRay{eye, look + offset};
}

} // namespace clrt
