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

/// Lengths of film_dx and film_dy in the normalised frame; in panoramas turns.
glm::dvec2 pixel_size(const Camera& camera, const Normalisation& frame, glm::ivec2 size) {
    switch (camera.projection) {
    case PROJECTION_EQUIRECTANGULAR:
        return {1.0 / size.x, 0.5 / size.y};
    case PROJECTION_FISHEYE:
        return glm::dvec2(camera.fov_degrees / 360 / size.y);
    default:
        return glm::dvec2(shown_height(camera, 1) * (is_parallel(camera) ? frame.scale : 1) / size.y);
    }
}

void set_lens(const Camera& camera, const Normalisation& frame, CameraParams& params) {
    params.lens_radius = float(0.5 * camera.aperture * frame.scale);
    params.inverse_focus = float(1 / (camera.focus * frame.scale));
    params.blades = u32(camera.blades);
}

void set_motion(const Camera& camera, const Normalisation& frame, CameraParams& params) {
    if (!camera.end)
        return;
    const CameraPose& end = *camera.end;
    params.moves = 1;
    params.eye_move = to_vec4((end.eye - camera.eye) * frame.scale);
    const glm::dvec3 way = camera.at - camera.eye;
    params.way = to_vec4(way * frame.scale);
    params.way_move = to_vec4((end.at - end.eye - way) * frame.scale);
    params.up = to_vec4(camera.up);
    params.up_move = to_vec4(end.up - camera.up);
}

/// (sin, cos) of an angle in turns.
glm::dvec2 sin_cos(double turns) {
    return {std::sin(2 * PI * turns), std::cos(2 * PI * turns)};
}

/// Parts of a panorama's ray to the right, down and along the axis.
glm::dvec3 panorama_direction(const CameraParams& camera, const glm::dvec2& film) {
    if (camera.projection == PROJECTION_EQUIRECTANGULAR) {
        const glm::dvec2 longitude = sin_cos(film.x * double(camera.pixel_x)),
                         latitude = sin_cos(film.y * double(camera.pixel_y));
        return {latitude.y * longitude.x, latitude.x, latitude.y * longitude.y};
    }
    const double radius = glm::length(film);
    const glm::dvec2 angle = sin_cos(radius * double(camera.pixel_x));
    const glm::dvec2 outward = radius > 0 ? film * (angle.x / radius) : glm::dvec2(0);
    return {outward, angle.y};
}

} // namespace

double widest_fisheye_fov(glm::ivec2 size) {
    return 360 * size.y / std::hypot(double(size.x), double(size.y));
}

double shown_height(const Camera& camera, double distance) {
    switch (camera.projection) {
    case PROJECTION_ORTHOGRAPHIC:
        return camera.ortho_height;
    case PROJECTION_EQUIRECTANGULAR:
        return PI * distance;
    case PROJECTION_FISHEYE:
        return camera.fov_degrees * (PI / 180) * distance;
    default:
        return 2 * std::tan(0.5 * camera.fov_degrees * (PI / 180)) * distance;
    }
}

CameraParams make_camera_params(const Camera& camera, const Normalisation& frame, glm::ivec2 size) {
    const PictureAxes axes = picture_axes(camera.at - camera.eye, camera.up);
    const glm::dvec2 pixel = pixel_size(camera, frame, size);
    const glm::dvec2 length = is_panorama(camera.projection) ? glm::dvec2(1) : pixel;
    CameraParams params{};
    params.eye = to_vec4(to_normalised(frame, camera.eye));
    params.film_dx = to_vec4(axes.right * length.x);
    params.film_dy = to_vec4(axes.up * -length.y);
    params.look = to_vec4(axes.look);
    params.pixel_x = float(pixel.x);
    params.pixel_y = float(pixel.y);
    params.shift_x = float(camera.shift.x * size.x);
    params.shift_y = float(-camera.shift.y * size.y);
    params.projection = u32(camera.projection);
    set_lens(camera, frame, params);
    set_motion(camera, frame, params);
    return params;
}

FilmRay film_ray(const CameraParams& camera, const glm::dvec2& position) {
    const glm::dvec2 film = position + glm::dvec2(camera.shift_x, camera.shift_y);
    const glm::dvec3 eye = to_dvec3(camera.eye), look = to_dvec3(camera.look),
                     right = to_dvec3(camera.film_dx), down = to_dvec3(camera.film_dy);
    if (is_panorama(Projection(camera.projection))) {
        const glm::dvec3 parts = panorama_direction(camera, film);
        return {eye, right * parts.x + down * parts.y + look * parts.z};
    }
    const glm::dvec3 offset = right * film.x + down * film.y;
    return camera.projection == PROJECTION_ORTHOGRAPHIC ? FilmRay{eye + offset, look}
                                                        : FilmRay{eye, look + offset};
}

} // namespace clrt
