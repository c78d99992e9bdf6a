// SPDX-License-Identifier: Apache-2.0
// The options of the group "Light".
#include "app/option_rows.h"
#include "colour.h"

namespace clrt {

namespace {

bool is_colour(const glm::dvec3& c) {
    return c.x >= 0 && c.y >= 0 && c.z >= 0;
}

void apply_environment(Options& o, const OptionValue& v) {
    o.light.environment_file.clear();
    o.light.environment.reset();
    if (!looks_like_numbers(v.text)) {
        o.light.environment_file = parse_path(v);
        return;
    }
    const std::string expected = "an image file or a radiance r,g,b of numbers from 0";
    const glm::dvec3 radiance = parse_vector(v, expected);
    if (!is_colour(radiance))
        reject_value(v, expected);
    o.light.environment = radiance;
}

void apply_sun(Options& o, const OptionValue& v) {
    const std::string expected =
        "x,y,z,r,g,b[,deg]: a direction other than 0,0,0, an irradiance of numbers from 0, "
        "and a diameter from 0 to 90 degrees";
    const std::vector<double> n = parse_numbers(v, 6, 7, expected);
    const SunOptions sun{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, n.size() == 7 ? n[6] : 0};
    const bool diameter_fits = sun.diameter_degrees >= 0 && sun.diameter_degrees <= 90;
    if (sun.towards == glm::dvec3(0) || !is_colour(sun.irradiance) || !diameter_fits)
        reject_value(v, expected);
    o.light.suns.push_back(sun);
}

void apply_point(Options& o, const OptionValue& v) {
    const std::string expected = "x,y,z,r,g,b: a position and an intensity of numbers from 0";
    const std::vector<double> n = parse_numbers(v, 6, 6, expected);
    const PointOptions point{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
    if (!is_colour(point.intensity))
        reject_value(v, expected);
    o.light.points.push_back(point);
}

void apply_spot(Options& o, const OptionValue& v) {
    const std::string expected =
        "x,y,z,dx,dy,dz,r,g,b[,outer[,inner]]: a position, a direction other than 0,0,0, an intensity of "
        "numbers from 0, and angles in degrees, outer from 0 to 180, inner from 0 to outer";
    const std::vector<double> n = parse_numbers(v, 9, 11, expected);
    SpotCone cone{{n[3], n[4], n[5]}};
    if (n.size() > 9)
        cone.outer_degrees = n[9];
    if (n.size() > 10)
        cone.inner_degrees = n[10];
    const PointOptions spot{{n[0], n[1], n[2]}, {n[6], n[7], n[8]}, cone, "--spot"};
    const bool angles_fit =
        cone.inner_degrees >= 0 && cone.inner_degrees <= cone.outer_degrees && cone.outer_degrees <= 180;
    if (cone.direction == glm::dvec3(0) || !is_colour(spot.intensity) || !angles_fit)
        reject_value(v, expected);
    o.light.points.push_back(spot);
}

void apply_studio(Options& o, const OptionValue& v) {
    if (v.text != "auto" && v.text != "off")
        reject_value(v, "auto or off");
    o.light.studio = v.text == "auto";
}

void apply_ground(Options& o, const OptionValue& v) {
    o.light.ground.emplace();
    if (v.text == "none")
        return;
    const std::string expected = "none or a reflectance r,g,b of numbers from 0 to 1";
    const glm::dvec3 albedo = parse_vector(v, expected);
    if (!is_colour(albedo) || largest_component(albedo) > 1)
        reject_value(v, expected);
    o.light.ground->albedo = albedo;
}

void apply_background(Options& o, const OptionValue& v) {
    o.light.background.emplace();
    o.light.background->is_transparent = v.text == "transparent";
    if (o.light.background->is_transparent)
        return;
    const std::string expected = "transparent or a radiance r,g,b of numbers from 0";
    o.light.background->radiance = parse_vector(v, expected);
    if (!is_colour(o.light.background->radiance))
        reject_value(v, expected);
}

} // namespace

std::vector<OptionSpec> light_options() {
    const char* const group = "Light";
    return {
        {group, "", "--env", "FILE|R,G,B",
         "environment: a latitude-longitude picture or one radiance (default: none; --studio where nothing "
         "else gives light)",
         apply_environment},
        {group, "", "--env-scale", "X", "factor on the environment's radiance (default 1)",
         [](Options& o, const OptionValue& v) {
             o.light.environment_scale = parse_number(v, "a factor from 0", not_negative);
         }},
        {group, "", "--env-rotate", "DEG", "turn of the environment about +Y, degrees (default 0)",
         [](Options& o, const OptionValue& v) {
             o.light.environment_rotation_degrees = parse_number(v, "an angle in degrees");
         }},
        {group, "", "--sun", "X,Y,Z,R,G,B[,DEG]",
         "direction to the sun, irradiance, angular diameter in degrees; repeatable", apply_sun, REPEATABLE},
        {group, "", "--point", "X,Y,Z,R,G,B", "point light: position, intensity in W/sr; repeatable",
         apply_point, REPEATABLE},
        {group, "", "--spot", "X,Y,Z,DX,DY,DZ,R,G,B[,OUTER[,INNER]]",
         "spot light: position, direction in which it shines, intensity on its axis in W/sr, angles from the "
         "axis in degrees: none from OUTER on (default 45), all up to INNER (default 0); repeatable",
         apply_spot, REPEATABLE},
        {group, "", "--two-sided-lights", "", "emissive faces shine on both sides (default: on their front)",
         [](Options& o, const OptionValue&) { o.light.two_sided = true; }},
        {group, "", "--studio", "auto|off",
         "where neither the scene nor an option gives light: key light, even sky, ground and backdrop, "
         "said as flags to copy; in rooms a white sky and a lamp; off: a white sky (default auto)",
         apply_studio},
        {group, "", "--ground", "none|R,G,B",
         "matte plane of this reflectance under the scene (default none, but for --studio)", apply_ground},
        {group, "", "--background", "transparent|R,G,B",
         "radiance that the camera sees in place of sky and sun; it lights nothing; transparent: black, "
         "with alpha in .png, .tga, .tif and .exr (default: sky and sun, but for --studio)",
         apply_background},
    };
}

} // namespace clrt
