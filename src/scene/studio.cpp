// SPDX-License-Identifier: Apache-2.0
#include "scene/studio.h"

#include "scene/box_cover.h"
#include "scene/free_way.h"
#include "scene/ground.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace clrt {
namespace {

// Levels, in radiance: without a tone map 1 is white. A white surface (Kd 0.8) that faces the key has
// 0.8 (KEY / pi + SKY) = 0.80 and keeps its shape, also where others light it; towards the camera it is
// brighter than the backdrop, black ones are darker, grey ones both, by their sides.
constexpr double KEY_IRRADIANCE = 2.2;
constexpr double SKY_RADIANCE = 0.3;
constexpr double GROUND_ALBEDO = 0.25;

// The key: above the camera's left shoulder, so wide that shadows are soft.
constexpr double KEY_ELEVATION_DEGREES = 48;
constexpr double KEY_AZIMUTH_DEGREES = 42;
constexpr double KEY_DIAMETER_DEGREES = 15;

// Rooms: the sky through windows, and what the lamp makes of the mean surface around it, before the light
// goes on from wall to wall.
constexpr double ROOM_SKY_RADIANCE = 1;
constexpr double LAMP_IRRADIANCE = 1;

/// Directions and radiances are printed, and taken, with so many decimals.
constexpr double DECIMALS = 1e6;

glm::dvec3 rounded(const glm::dvec3& v) {
    return glm::dvec3(std::nearbyint(v.x * DECIMALS), std::nearbyint(v.y * DECIMALS),
                      std::nearbyint(v.z * DECIMALS)) /
           DECIMALS;
}

/// Directions as the viewer has them.
struct ViewFrame {
    glm::dvec3 up, back, right; ///< up of the scene, level towards the viewer, level to the right
};

/// What is right in the picture, made level, says where the viewer is: where the camera looks along up, too.
ViewFrame view_frame(const Camera& camera, const glm::dvec3& scene_up) {
    const glm::dvec3 up = glm::normalize(scene_up), look = glm::normalize(camera.at - camera.eye);
    const glm::dvec3 level = glm::cross(look, camera.up);
    const glm::dvec3 right = glm::normalize(level - glm::dot(level, up) * up);
    return {up, glm::cross(right, up), right};
}

SunOptions key_light(const ViewFrame& view) {
    const double elevation = glm::radians(KEY_ELEVATION_DEGREES), azimuth = glm::radians(KEY_AZIMUTH_DEGREES);
    const glm::dvec3 level = std::cos(azimuth) * view.back - std::sin(azimuth) * view.right;
    return {rounded(std::sin(elevation) * view.up + std::cos(elevation) * level), glm::dvec3(KEY_IRRADIANCE),
            KEY_DIAMETER_DEGREES};
}

/// Everything as flags to copy.
std::string flags(const LightOptions& light) {
    std::string text;
    for (const SunOptions& sun : light.suns)
        text +=
            fmt::format(" --sun {},{},{}", triple(sun.towards), triple(sun.irradiance), sun.diameter_degrees);
    for (const PointOptions& point : light.points)
        text += fmt::format(" --point {},{}", triple(point.position), triple(point.intensity));
    text += fmt::format(" --env {}", triple(*light.environment));
    if (light.ground)
        text += " --ground " + (light.ground->albedo ? triple(*light.ground->albedo) : "none");
    if (light.background)
        text += " --background " +
                (light.background->is_transparent ? "transparent" : triple(light.background->radiance));
    return text;
}

/// Fewer directions than this share without a surface: indoors, windows and all.
constexpr double OPEN_AIR = 0.25;

/// The axes and diagonals of a cube.
std::vector<glm::dvec3> all_around() {
    std::vector<glm::dvec3> directions;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (const int axes = std::abs(x) + std::abs(y) + std::abs(z); axes == 1 || axes == 3)
                    directions.push_back(glm::normalize(glm::dvec3(x, y, z)));
    return directions;
}

/// What a point has around it, normalised frame.
struct Surroundings {
    double open = 1;          ///< share of the directions without a surface
    double mean_free_way = 0; ///< over the others
    glm::dvec3 middle{0};     ///< half the way to the furthest surface that is not below the point
};

Surroundings look_around(const Scene& scene, const glm::dvec3& from, const glm::dvec3& up) {
    Surroundings around;
    if (std::max({std::fabs(from.x), std::fabs(from.y), std::fabs(from.z)}) > scene.extent)
        return around; // outside of the scene's box
    const std::vector<glm::dvec3> directions = all_around();
    const std::vector<double> ways = free_ways(scene, from, directions);
    double longest = 0, sum = 0;
    size_t closed = 0;
    for (size_t i = 0; i < ways.size(); ++i) {
        if (std::isinf(ways[i]))
            continue;
        ++closed;
        sum += ways[i];
        if (ways[i] > longest && glm::dot(directions[i], up) >= 0) {
            longest = ways[i];
            around.middle = from + 0.5 * longest * directions[i];
        }
    }
    around.open = 1 - double(closed) / double(ways.size());
    if (longest > 0)
        around.mean_free_way = sum / double(closed);
    return around;
}

/// A point light in the middle of the room as far as the camera sees it, of LAMP_IRRADIANCE at the mean free
/// way from there.
PointOptions room_lamp(const Scene& scene, const Surroundings& around, const glm::dvec3& up) {
    const double scale = scene.normalisation.scale;
    const double way = look_around(scene, around.middle, up).mean_free_way / scale;
    return {around.middle / scale + scene.normalisation.centre, glm::dvec3(LAMP_IRRADIANCE * way * way)};
}

LightOptions room_light(LightOptions light, const Scene& scene, const Surroundings& around,
                        const glm::dvec3& up, NoticeList& notices) {
    light.environment = glm::dvec3(ROOM_SKY_RADIANCE);
    if (around.mean_free_way > 0)
        light.points = {room_lamp(scene, around, up)};
    notices.add(fmt::format("no light in the scene, a room: a white sky{}:{}",
                            light.points.empty() ? "" : " and a lamp in its middle", flags(light)));
    return light;
}

/// The radiance of a matte ground that nothing shades.
glm::dvec3 ground_radiance(const glm::dvec3& albedo, const LightOptions& light, const glm::dvec3& up) {
    const SunOptions& key = light.suns.front();
    const double cosine = glm::dot(glm::normalize(key.towards), up);
    return albedo * (key.irradiance * (cosine / PI) + *light.environment * light.environment_scale);
}

} // namespace

LightOptions studio_light(const LightOptions& given, const Scene& scene, const glm::dvec3& up,
                          NoticeList& notices) {
    const ViewFrame view = view_frame(scene.camera, up);
    const glm::dvec3 eye = to_normalised(scene.normalisation, scene.camera.eye);
    const Surroundings around = look_around(scene, eye, view.up);
    if (is_room(measure_box_cover(scene.positions, scene.triangles)) || around.open < OPEN_AIR)
        return room_light(given, scene, around, view.up, notices);

    LightOptions light = given;
    light.environment = glm::dvec3(SKY_RADIANCE);
    light.suns = {key_light(view)};
    const bool looks_from_above = glm::dot(eye, view.up) > lowest_along(scene, view.up);
    const bool is_transparent = given.background && given.background->is_transparent;
    if (!given.ground) {
        const bool has_ground = looks_from_above && !is_transparent && !scene.triangles.empty();
        light.ground = GroundOptions{has_ground ? std::optional(glm::dvec3(GROUND_ALBEDO)) : std::nullopt};
    }
    if (!given.background) {
        const glm::dvec3 albedo = light.ground->albedo.value_or(glm::dvec3(GROUND_ALBEDO));
        light.background = BackgroundOptions{rounded(ground_radiance(albedo, light, view.up)), false};
    }
    notices.add(fmt::format("no light in the scene: a studio of key light, even sky, {}backdrop:{}",
                            light.ground->albedo ? "ground and " : "", flags(light)));
    return light;
}

} // namespace clrt
