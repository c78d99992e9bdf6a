// SPDX-License-Identifier: Apache-2.0
// The options of the group "Camera".
#include "app/option_rows.h"

namespace clrt {

namespace {

glm::dvec3 direction(const OptionValue& v) {
    const std::string expected = "a direction x,y,z other than 0,0,0";
    const glm::dvec3 d = parse_vector(v, expected);
    if (d == glm::dvec3(0))
        reject_value(v, expected);
    return d;
}

} // namespace

std::vector<OptionSpec> camera_options() {
    const char* const group = "Camera";
    return {
        {group, "", "--eye", "X,Y,Z", "position, scene units (default: fitted to the scene)",
         [](Options& o, const OptionValue& v) { o.camera.eye = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--at", "X,Y,Z", "point to look at, scene units (default: fitted to the scene)",
         [](Options& o, const OptionValue& v) { o.camera.at = parse_vector(v, "a position x,y,z"); }},
        {group, "", "--up", "X,Y,Z", "direction that is up in the picture (default 0,1,0)",
         [](Options& o, const OptionValue& v) { o.camera.up = direction(v); }},
        {group, "", "--fov", "DEG", "vertical angle of view, degrees (default 40)",
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
