// SPDX-License-Identifier: Apache-2.0
// The options of the group "Camera".
#include "app/option_rows.h"

#include <cmath>
#include <limits>

namespace clrt {

namespace {

glm::dvec3 direction(const OptionValue& v, const std::string& expected) {
    const glm::dvec3 d = parse_vector(v, expected);
    if (d == glm::dvec3(0))
        reject_value(v, expected);
    return d;
}

/// A direction or the name of an axis.
glm::dvec3 up_direction(const OptionValue& v) {
    const std::pair<const char*, glm::dvec3> axes[] = {{"x", {1, 0, 0}}, {"y", {0, 1, 0}}, {"z", {0, 0, 1}}};
    for (const auto& [name, axis] : axes)
        if (v.text == name)
            return axis;
    return direction(v, "x, y, z, or a direction x,y,z other than 0,0,0");
}

/// A distance, a point, or infinity.
void set_focus(CameraOptions& camera, const OptionValue& v) {
    const std::string expected = "a distance above 0, a point x,y,z, or inf";
    camera.focus.reset();
    camera.focus_point.reset();
    if (v.text == "inf")
        camera.focus = std::numeric_limits<double>::infinity();
    else if (v.text.find(',') != std::string::npos)
        camera.focus_point = parse_vector(v, expected);
    else
        camera.focus = parse_number(v, expected, positive);
}

int parse_blades(const OptionValue& v) {
    const std::string expected = "0, or a whole number from 3 to 64";
    const double n = parse_number(
        v, expected, [](double x) { return x == std::floor(x) && (x == 0 || (x >= 3 && x <= 64)); });
    return int(n);
}

glm::dvec2 parse_shutter(const OptionValue& v) {
    const std::string expected = "two times OPEN,CLOSE with 0 <= OPEN <= CLOSE <= 1";
    const std::vector<double> times = parse_numbers(v, 2, 2, expected);
    if (!(times[0] >= 0 && times[0] <= times[1] && times[1] <= 1))
        reject_value(v, expected);
    return {times[0], times[1]};
}

void set_animation_times(SceneOptions& scene, const OptionValue& v) {
    const std::string expected = "one time in seconds, or two, T,T2 with T <= T2";
    const std::vector<double> times = parse_numbers(v, 1, 2, expected);
    if (times.back() < times.front())
        reject_value(v, expected);
    scene.gltf.time = times.front();
    scene.end_time = times.size() == 2 ? std::optional(times.back()) : std::nullopt;
}

/// Where the picture is taken from and how it is projected.
std::vector<OptionSpec> view_options(const char* group) {
    return {
        {group, "", "--camera", "NAME|N",
         "which of the file's cameras takes the picture, by its name or its number from 1; it gives the "
         "picture's aspect too where --size is absent (default: the first; none with --eye, --at or --view)",
         [](Options& o, const OptionValue& v) {
             if (v.text.empty())
                 reject_value(v, "the name or the number of a camera");
             o.camera.file_camera = v.text;
         }},
        {group, "", "--eye", "X,Y,Z", "position, scene units (default: fitted to the scene)",
         [](Options& o, const OptionValue& v) { o.camera.eye = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--at", "X,Y,Z", "point to look at, scene units (default: fitted to the scene)",
         [](Options& o, const OptionValue& v) { o.camera.at = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--up", "x|y|z|X,Y,Z",
         "direction that is up in the scene and the picture (default y; z where the file surely has z up)",
         [](Options& o, const OptionValue& v) { o.camera.up = up_direction(v); }},
        {group, "", "--view", "NAME",
         "from where to look where --eye is not given: front, back, left, right, top, bottom or iso; with "
         "y up the front is +z, with z up -y (default: from the right, above and in front; into rooms)",
         [](Options& o, const OptionValue& v) { o.camera.view = parse_choice<View>(v); }},
        {group, "", "--projection", "NAME",
         "how rays leave the film: perspective (from the eye), orthographic (parallel, from the plane "
         "through the eye), equirectangular (all directions, as in lat-long maps) or fisheye (the angle "
         "grows with the distance from the middle; default perspective)",
         [](Options& o, const OptionValue& v) { o.camera.projection = parse_choice<Projection>(v); }},
        {group, "", "--ortho-height", "X",
         "orthographic: height of what the picture shows, scene units (default: fitted to the scene; with "
         "--eye, "
         "what perspective shows at --at)",
         [](Options& o, const OptionValue& v) {
             o.camera.ortho_height = parse_number(v, "a length above 0", positive);
         }},
        {group, "", "--fov", "DEG",
         "vertical angle of view, degrees (default 40; 60 from within a room; fisheye 180, or as much as its "
         "corners allow)",
         [](Options& o, const OptionValue& v) {
             o.camera.fov_degrees = parse_number(v, "an angle in degrees above 0 and below 360",
                                                 [](double degrees) { return degrees > 0 && degrees < 360; });
         }},
        {group, "", "--focal-length", "X", "of the lens, instead of --fov; any unit",
         [](Options& o, const OptionValue& v) {
             o.camera.focal_length = parse_number(v, "a length above 0", positive);
         }},
        {group, "", "--film-width", "X", "goes with --focal-length, in the same unit",
         [](Options& o, const OptionValue& v) {
             o.camera.film_width = parse_number(v, "a length above 0", positive);
         }},
        {group, "", "--shift", "X,Y",
         "moves the picture's middle from the camera's axis, to the right by X widths and up by Y heights: "
         "upright walls stay upright where the camera looks level (default 0,0)",
         [](Options& o, const OptionValue& v) {
             const std::vector<double> xy = parse_numbers(v, 2, 2, "a shift x,y");
             o.camera.shift = glm::dvec2(xy[0], xy[1]);
         }},
    };
}

/// Depth of field.
std::vector<OptionSpec> lens_options(const char* group) {
    return {
        {group, "", "--aperture", "D", "diameter of the lens, scene units; 0 is a pinhole (default 0)",
         [](Options& o, const OptionValue& v) {
             o.camera.aperture = parse_number(v, "a diameter from 0", [](double d) { return d >= 0; });
         }},
        {group, "", "--fstop", "N",
         "diameter of the lens as the Nth part of --focal-length, which is in scene units then",
         [](Options& o, const OptionValue& v) {
             o.camera.fstop = parse_number(v, "a number above 0", positive);
         }},
        {group, "", "--focus", "D|X,Y,Z|inf",
         "what is sharp: the plane across the camera's axis at this distance from the eye, or through this "
         "point (default: through --at)",
         [](Options& o, const OptionValue& v) { set_focus(o.camera, v); }},
        {group, "", "--blades", "N", "the lens has N corners, the first at the top; 0 is round (default 0)",
         [](Options& o, const OptionValue& v) { o.camera.blades = parse_blades(v); }},
    };
}

/// Motion while the shutter is open.
std::vector<OptionSpec> shutter_options(const char* group) {
    return {
        {group, "", "--end-eye", "X,Y,Z", "--eye at time 1: eye, at and up go straight there from time 0",
         [](Options& o, const OptionValue& v) { o.camera.end_eye = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--end-at", "X,Y,Z", "--at at time 1",
         [](Options& o, const OptionValue& v) { o.camera.end_at = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--end-up", "x|y|z|X,Y,Z", "--up at time 1",
         [](Options& o, const OptionValue& v) { o.camera.end_up = up_direction(v); }},
        {group, "", "--end", "FILE",
         "the scene at time 1: the same vertices and faces at other places; vertices go straight there",
         [](Options& o, const OptionValue& v) { o.scene.end_path = parse_path(v); }},
        {group, "", "--animation-time", "T[,T2]",
         "the moment of a glTF file's animations that is shown, seconds (default: the scene as it stands); "
         "with T2 its nodes, cameras among them, go straight to where they are then, at time 1",
         [](Options& o, const OptionValue& v) { set_animation_times(o.scene, v); }},
        {group, "", "--animation", "NAME|N",
         "which of the file's animations is played, by its name or its number from 1 (default: all together)",
         [](Options& o, const OptionValue& v) { o.scene.gltf.animation = v.text; }},
        {group, "", "--shutter", "OPEN,CLOSE",
         "the times between which the picture is taken, from 0 to 1 (default 0,1)",
         [](Options& o, const OptionValue& v) { o.camera.shutter = parse_shutter(v); }},
    };
}

} // namespace

std::vector<OptionSpec> camera_options() {
    const char* const group = "Camera";
    std::vector<OptionSpec> all;
    for (const auto& part : {view_options(group), lens_options(group), shutter_options(group)})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace clrt
