// SPDX-License-Identifier: Apache-2.0
#include "app/camera_checks.h"

#include "output/standard_streams.h"
#include "scene/camera_params.h"

#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

using Fault = std::optional<std::string>;

bool is_given(const Options& options, const char* name) {
    return options.run.given.count(name) != 0;
}

bool is_in_file(const Options& options, const char* name) {
    const auto given = options.run.given.find(name);
    return given != options.run.given.end() && !given->second.empty();
}

Fault find_focal_fault(const Options& options) {
    if (options.camera.focal_length.has_value() == options.camera.film_width.has_value())
        return std::nullopt;
    const bool has_focal = options.camera.focal_length.has_value();
    return fmt::format("option {}: expected together with {}, found alone",
                       has_focal ? "--focal-length" : "--film-width",
                       has_focal ? "--film-width" : "--focal-length");
}

/// Each projection has its own option for the size of what it shows. Where only the command line asks for
/// another than perspective, what an options file says of the angle stands for that of the default.
Fault find_size_fault(const Options& options) {
    const CameraOptions& camera = options.camera;
    if (camera.ortho_height && camera.projection != PROJECTION_ORTHOGRAPHIC)
        return fmt::format(
            "option --ortho-height: expected --projection orthographic, found {}; --fov is its "
            "angle of view",
            name_of(camera.projection));
    if (camera.projection == PROJECTION_PERSPECTIVE)
        return std::nullopt;
    for (const char* const name : {"--fov", "--focal-length", "--film-width"}) {
        if (camera.projection == PROJECTION_FISHEYE && std::string(name) == "--fov")
            continue;
        if (!is_given(options, name) || (is_in_file(options, name) && !is_in_file(options, "--projection")))
            continue;
        if (camera.projection == PROJECTION_ORTHOGRAPHIC)
            return fmt::format(
                "option {}: expected --ortho-height with --projection orthographic, found an angle of view",
                name);
        return fmt::format("option {}: expected --projection perspective, found {}, {}", name,
                           name_of(camera.projection),
                           camera.projection == PROJECTION_FISHEYE ? "whose angle of view is --fov"
                                                                   : "which shows all directions");
    }
    return std::nullopt;
}

Fault find_angle_fault(const Options& options) {
    const CameraOptions& camera = options.camera;
    if (!camera.fov_degrees)
        return std::nullopt;
    const double fov = *camera.fov_degrees;
    if (camera.projection == PROJECTION_FISHEYE) {
        const double most = widest_fisheye_fov(options.film.size);
        if (fov > most)
            return fmt::format("option --fov: expected at most {:.6g} degrees with --projection fisheye and "
                               "--size {}x{}, whose corners then look straight back, found {}",
                               most, options.film.size.x, options.film.size.y, fov);
    } else if (fov >= 180)
        return fmt::format("option --fov: expected an angle in degrees below 180, found '{}'; --projection "
                           "fisheye shows more",
                           fov);
    return std::nullopt;
}

Fault find_shift_fault(const Options& options) {
    const Projection projection = options.camera.projection;
    if (options.camera.shift && is_panorama(projection))
        return fmt::format(
            "option --shift: expected --projection perspective or orthographic, found {}; --at "
            "turns the camera",
            name_of(projection));
    return std::nullopt;
}

Fault find_lens_fault(const Options& options) {
    const CameraOptions& camera = options.camera;
    const bool has_lens = camera.aperture || camera.fstop;
    if (has_lens && is_panorama(camera.projection))
        return fmt::format(
            "option {}: expected --projection perspective or orthographic, found {}, which has "
            "no lens",
            camera.aperture ? "--aperture" : "--fstop", name_of(camera.projection));
    if (camera.fstop && !camera.focal_length)
        return "option --fstop: expected together with --focal-length and --film-width in scene units, whose "
               "Nth part is the lens's diameter, found alone; --aperture gives the diameter itself";
    for (const char* const name : {"--focus", "--blades"})
        if (is_given(options, name) && !has_lens)
            return fmt::format("option {}: expected together with --aperture or --fstop, found alone", name);
    return std::nullopt;
}

Fault find_shutter_fault(const Options& options) {
    const CameraOptions& camera = options.camera;
    if (camera.shutter && !camera.end_eye && !camera.end_at && !camera.end_up && !end_option(options.scene))
        return "option --shutter: expected together with what moves, --end, --animation-time T,T2, "
               "--end-eye, "
               "--end-at or --end-up, found alone";
    if (options.scene.end_time && !options.scene.end_path.empty())
        return "options --end and --animation-time T,T2: expected one scene at time 1, found two";
    if (options.scene.end_time && is_standard_input(options.scene.path))
        return "option --animation-time T,T2: expected the name of a file, which is read twice, found '-'";
    if (is_given(options, "--animation") && !options.scene.gltf.time)
        return "option --animation: expected together with --animation-time, found alone";
    if (camera.frames && camera.end_up)
        return "options --frames and --end-up: expected one of them, found both; a turn keeps its axis";
    return std::nullopt;
}

} // namespace

Fault find_camera_fault(const Options& options) {
    for (const auto& find : {find_focal_fault, find_size_fault, find_angle_fault, find_shift_fault,
                             find_lens_fault, find_shutter_fault})
        if (Fault fault = find(options))
            return fault;
    if (options.camera.eye && options.camera.eye == options.camera.at)
        return "options --eye and --at: expected two different points, found the same";
    return std::nullopt;
}

} // namespace clrt
