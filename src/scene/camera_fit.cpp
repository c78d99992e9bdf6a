// SPDX-License-Identifier: Apache-2.0
#include "scene/camera_fit.h"

#include "error.h"
#include "scene/box_cover.h"
#include "scene/camera_lens.h"
#include "scene/camera_motion.h"
#include "scene/camera_params.h"
#include "scene/framing.h"
#include "scene/room_view.h"
#include "scene/vectors.h"
#include "scene/view_frame.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace clrt {
namespace {

constexpr double DEFAULT_FOV_DEGREES = 40;
/// In a room, where 40 show one wall: that of a wide lens (24 mm of film across 36 mm: 58).
constexpr double ROOM_FOV_DEGREES = 60;
constexpr double RESOLVED_PITCH =
    2.4e-7; // radians between rays of single precision that differ, four units of roundoff

/// A fisheye shows a half of all directions, or as much as its corners allow.
constexpr double FISHEYE_FOV_DEGREES = 180;

double default_fov(Projection projection, glm::ivec2 size) {
    return projection == PROJECTION_FISHEYE ? std::min(FISHEYE_FOV_DEGREES, widest_fisheye_fov(size))
                                            : DEFAULT_FOV_DEGREES;
}

ViewTangents view_tangents(double fov_degrees, glm::ivec2 size) {
    const double vertical = std::tan(glm::radians(fov_degrees) / 2);
    return {vertical, vertical * size.x / size.y};
}

/// Eye and point to look at, in the normalised frame.
struct EyeAndAt {
    glm::dvec3 eye, at;
    std::optional<double> fov_degrees; ///< another than the default
    std::optional<double> film_height; ///< in parallel projection, where it is not that of the angle of view
};

/// What is asked for, in the normalised frame.
struct Wish {
    std::optional<glm::dvec3> at;
    std::optional<View> view;
    glm::dvec3 up; ///< unit
    Projection projection;
    ViewTangents tangents;      ///< of the angle of view as given, or of the default
    ViewTangents room_tangents; ///< as given, or of the default in a room
};

/// From a direction, so that the scene fills the picture.
EyeAndAt view_from(const Scene& scene, const Wish& wish, const glm::dvec3& to_eye, const Framed& framed) {
    const glm::dvec3 look = -to_eye;
    const glm::dvec3 up = is_along(look, wish.up) ? up_beside(look, up_frame(wish.up)) : wish.up;
    const PictureAxes axes = picture_axes(look, up);
    EyeAndAt view;
    if (wish.projection == PROJECTION_ORTHOGRAPHIC) {
        const double aspect = wish.tangents.horizontal / wish.tangents.vertical;
        const ParallelFilm film = framing_film(scene, framed, wish.up, axes, aspect, wish.at);
        view.eye = film.eye;
        view.film_height = film.height;
    } else
        view.eye = framing_eye(scene, framed, wish.up, axes, wish.tangents, wish.at);
    view.at = wish.at.value_or(view.eye + look * glm::dot(framed.centre - view.eye, look));
    return view;
}

EyeAndAt fitted_view(const Scene& scene, const Wish& wish) {
    const auto from_outside = [&] {
        return view_from(scene, wish, up_frame(wish.up) * direction_to_eye(wish.view),
                         find_framed(scene, wish.up));
    };
    if (wish.view || wish.at)
        return from_outside();
    // Into a room: through its open side, or from within.
    const std::optional<VoxelGrid> grid = VoxelGrid::make(scene);
    const std::optional<BoxFace> open = open_side(measure_box_cover(scene.positions, scene.triangles));
    if (grid && open && is_open(*grid, *open)) {
        glm::dvec3 to_eye(0);
        to_eye[open->axis] = open->sign;
        return view_from(scene, wish, to_eye, frame_all(scene, wish.up));
    }
    const auto inside =
        grid ? find_room_view(*grid, !scene.emitters.empty(), wish.up, wish.room_tangents) : std::nullopt;
    if (inside)
        return {inside->eye, inside->at, ROOM_FOV_DEGREES, std::nullopt};
    return from_outside();
}

void check_vector(const std::optional<glm::dvec3>& v, const char* option) {
    if (v && !is_finite(*v))
        throw UsageError(fmt::format("{}: expected three finite numbers, found {}", option, triple(*v)));
}

void check_vectors(const CameraOptions& options) {
    check_vector(options.eye, "--eye");
    check_vector(options.at, "--at");
    check_vector(options.up, "--up");
    if (options.up && *options.up == glm::dvec3(0))
        throw UsageError("--up: expected a direction, found 0,0,0");
}

/// Eye and at in world units: those of the options, the others fitted.
void complete(const CameraOptions& options, glm::ivec2 size, const Scene& scene, const Bounds& bounds,
              Camera& camera) {
    if (options.eye) {
        camera.eye = *options.eye;
        camera.at = options.at.value_or(bounds.centre());
        if (!options.at && camera.eye == camera.at)
            camera.at -= up_frame(camera.up)[2] * (bounds.radius() > 0 ? bounds.radius() : 1.);
        return;
    }
    const Normalisation& frame = scene.normalisation;
    // A panorama stands where a perspective camera would.
    const bool has_angle = !is_panorama(camera.projection);
    const bool is_wide = !has_angle || (!options.fov_degrees && !options.focal_length);
    const double fov = has_angle ? camera.fov_degrees : DEFAULT_FOV_DEGREES;
    Wish wish{std::nullopt,
              options.view,
              glm::normalize(camera.up),
              camera.projection,
              view_tangents(fov, size),
              view_tangents(is_wide ? ROOM_FOV_DEGREES : fov, size)};
    if (options.at)
        wish.at = to_normalised(frame, *options.at);
    const EyeAndAt fitted = fitted_view(scene, wish);
    camera.eye = fitted.eye / frame.scale + frame.centre;
    camera.at = options.at ? *options.at : fitted.at / frame.scale + frame.centre;
    if (is_wide && has_angle)
        camera.fov_degrees = fitted.fov_degrees.value_or(camera.fov_degrees);
    if (fitted.film_height)
        camera.ortho_height = *fitted.film_height / frame.scale;
}

/// Of parallel rays: as given, as fitted, or what the angle of view shows at `at`.
double ortho_height(const CameraOptions& options, const Camera& camera) {
    if (options.ortho_height || camera.ortho_height > 0)
        return options.ortho_height.value_or(camera.ortho_height);
    Camera pinhole = camera;
    pinhole.projection = PROJECTION_PERSPECTIVE;
    return shown_height(pinhole, glm::distance(camera.at, camera.eye));
}

/// The camera as options to copy.
std::string camera_text(const Camera& camera) {
    const std::string place = fmt::format("camera: --eye {} --at {} --up {}", triple(camera.eye),
                                          triple(camera.at), triple(camera.up));
    if (camera.projection == PROJECTION_ORTHOGRAPHIC)
        return place + fmt::format(" --projection {} --ortho-height {}", name_of(camera.projection),
                                   camera.ortho_height);
    if (camera.projection == PROJECTION_EQUIRECTANGULAR)
        return place + fmt::format(" --projection {}", name_of(camera.projection));
    if (camera.projection == PROJECTION_FISHEYE)
        return place +
               fmt::format(" --projection {} --fov {}", name_of(camera.projection), camera.fov_degrees);
    return place + fmt::format(" --fov {}", camera.fov_degrees);
}

void note_narrow_view(const Camera& camera, glm::ivec2 size, NoticeList& notices) {
    const double pitch = 2 * std::tan(glm::radians(camera.fov_degrees) / 2) / size.y;
    if (pitch < RESOLVED_PITCH)
        notices.add(fmt::format(
            "camera: --fov {} puts pixels {:.1e} radians apart, rays of single precision differ from "
            "{:.1e} on: neighbours show the same",
            camera.fov_degrees, pitch, RESOLVED_PITCH));
}

} // namespace

double field_of_view(const CameraOptions& options, glm::ivec2 size) {
    if (options.focal_length.has_value() != options.film_width.has_value())
        throw UsageError(
            "--focal-length and --film-width: expected both, found one; they give the angle of view "
            "together");
    const bool is_fisheye = options.projection == PROJECTION_FISHEYE;
    double fov = options.fov_degrees.value_or(default_fov(options.projection, size));
    if (options.focal_length) {
        const double focal = *options.focal_length, film = *options.film_width;
        if (!(std::isfinite(focal) && focal > 0 && std::isfinite(film) && film > 0))
            throw UsageError(fmt::format(
                "--focal-length, --film-width: expected lengths above 0, found {} and {}", focal, film));
        fov = glm::degrees(2 * std::atan(film * size.y / (2.0 * size.x * focal)));
    }
    if (is_fisheye && !(fov > 0 && fov <= widest_fisheye_fov(size)))
        throw UsageError(fmt::format("--fov: expected an angle between 0 and {:.6g} degrees, found {}",
                                     widest_fisheye_fov(size), fov));
    if (!is_fisheye && !(fov > 0 && fov < 180))
        throw UsageError(fmt::format("--fov: expected an angle between 0 and 180 degrees, found {}", fov));
    return fov;
}

Camera fit_camera(const CameraOptions& options, glm::ivec2 size, const Scene& scene, const Bounds& bounds,
                  NoticeList& notices) {
    check_vectors(options);
    Camera camera;
    camera.projection = options.projection;
    camera.fov_degrees = field_of_view(options, size);
    camera.up = options.up.value_or(DEFAULT_UP);
    complete(options, size, scene, bounds, camera);
    if (camera.eye == camera.at)
        throw UsageError(
            fmt::format("--eye and --at: expected two different points, found {} twice", triple(camera.eye)));

    const glm::dvec3 look = camera.at - camera.eye;
    if (is_along(look, camera.up)) {
        const glm::dvec3 up = up_beside(look, up_frame(camera.up));
        if (!options.view)
            notices.add(fmt::format("camera: --up {} points along the view, {} is taken instead",
                                    triple(camera.up), triple(up)));
        camera.up = up;
    }
    const bool is_parallel = camera.projection == PROJECTION_ORTHOGRAPHIC;
    if (is_parallel)
        camera.ortho_height = ortho_height(options, camera);
    else if (camera.projection == PROJECTION_PERSPECTIVE)
        note_narrow_view(camera, size, notices);
    if (!options.eye || !options.at || (is_parallel && !options.ortho_height))
        notices.add(camera_text(camera));
    camera.shift = options.shift.value_or(glm::dvec2(0));
    set_lens(options, camera, notices);
    set_motion(options, camera);
    return camera;
}

} // namespace clrt
