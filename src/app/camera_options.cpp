// SPDX-License-Identifier: Apache-2.0
// The options of the group "Camera".
#include "app/option_rows.h"

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

} // namespace

std::vector<OptionSpec> camera_options() {
    const char* const group = "Camera";
    return {
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
         "how rays leave the film: perspective (from the eye) or orthographic (parallel, from the plane "
         "through the eye; default perspective)",
         [](Options& o, const OptionValue& v) { o.camera.projection = parse_choice<Projection>(v); }},
        {group, "", "--ortho-height", "X",
         "orthographic: height of what the picture shows, scene units (default: fitted to the scene; with "
         "--eye, "
         "what perspective shows at --at)",
         [](Options& o, const OptionValue& v) {
             o.camera.ortho_height = parse_number(v, "a length above 0", positive);
         }},
        {group, "", "--fov", "DEG", "vertical angle of view, degrees (default 40; 60 from within a room)",
         [](Options& o, const OptionValue& v) {
             o.camera.fov_degrees = parse_number(v, "an angle in degrees above 0 and below 180",
                                                 [](double degrees) { return degrees > 0 && degrees < 180; });
         }},
        {group, "", "--focal-length", "X", "of the lens, instead of --fov; any unit",
         [](Options& o, const OptionValue& v) {
             o.camera.focal_length = parse_number(v, "a length above 0", positive);
         }},
        {group, "", "--film-width", "X", "goes with --focal-length, in the same unit",
         [](Options& o, const OptionValue& v) {
             o.camera.film_width = parse_number(v, "a length above 0", positive);
         }},
    };
}

} // namespace clrt
