// SPDX-License-Identifier: Apache-2.0
#include "scene/daylight.h"

#include "colour.h"
#include "scene/atmosphere.h"
#include "scene/sky_table.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>

namespace clrt {
namespace {

/// Texels of 1.4 degrees: the sky is smooth, but for the sun, which is a light of its own.
constexpr int WIDTH = 256, HEIGHT = 128;
constexpr double SUN_DIAMETER_DEGREES = 0.533;
constexpr double SUN_KELVIN = 5778;

double radians(double degrees) {
    return degrees * PI / 180;
}

/// Sunlight above the air: luminance pi.
Spectrum sun_spectrum() {
    Spectrum sun = black_body(SUN_KELVIN);
    const double luminance = to_xyz(sun).y;
    for (double& band : sun)
        band *= PI / luminance;
    return sun;
}

glm::dvec3 colour_of(const Spectrum& sun, const Spectrum& share) {
    Spectrum product;
    for (size_t i = 0; i < SPECTRUM_BANDS; ++i)
        product[i] = sun[i] * share[i];
    return to_linear_srgb(to_xyz(product));
}

/// The direction of a texel's middle, as kernels/lights/environment.h has it.
glm::dvec3 texel_direction(int x, int y) {
    const double polar = PI * (y + 0.5) / HEIGHT, azimuth = 2 * PI * ((x + 0.5) / WIDTH - 0.5);
    return {std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth)};
}

} // namespace

glm::dvec3 sun_direction(const SkyOptions& sky, const glm::dvec3& up) {
    const glm::dvec3 zenith = glm::normalize(up);
    // North lies level; where z is up, -z is no direction for it.
    const bool is_z_up = std::fabs(zenith.z) > std::fabs(zenith.y);
    const glm::dvec3 given = is_z_up ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, -1);
    const glm::dvec3 north = glm::normalize(given - glm::dot(given, zenith) * zenith);
    const glm::dvec3 east = glm::cross(north, zenith);
    const double azimuth = radians(sky.azimuth_degrees), elevation = radians(sky.elevation_degrees);
    const glm::dvec3 level = std::cos(azimuth) * north + std::sin(azimuth) * east;
    return std::sin(elevation) * zenith + std::cos(elevation) * level;
}

Daylight make_daylight(const SkyOptions& sky, const glm::dvec3& up) {
    const Atmosphere air(sky.turbidity, sky.ground_albedo);
    const Spectrum above_air = sun_spectrum();
    const glm::dvec3 zenith = glm::normalize(up), towards = sun_direction(sky, up);
    const double cos_sun = std::sin(radians(sky.elevation_degrees));

    Daylight light;
    light.sun = {towards, colour_of(above_air, air.sunlight(cos_sun)), SUN_DIAMETER_DEGREES, "--sky"};
    light.image = {WIDTH, HEIGHT, std::vector<glm::vec3>(size_t(WIDTH) * HEIGHT)};
    const auto texel = [&](int x, int y) -> glm::vec3& {
        return light.image.texels[size_t(y) * WIDTH + size_t(x)];
    };
    tbb::parallel_for(0, HEIGHT, [&](int y) {
        for (int x = 0; x < WIDTH; ++x) {
            const glm::dvec3 view = texel_direction(x, y);
            if (const double cosine = glm::dot(view, zenith); cosine > 0)
                texel(x, y) =
                    glm::vec3(colour_of(above_air, air.sky(cosine, cos_sun, glm::dot(view, towards))));
        }
    });

    glm::dvec3 irradiance = light.sun.irradiance * std::max(cos_sun, 0.0);
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            irradiance += glm::dvec3(texel(x, y)) * (texel_solid_angle(y, WIDTH, HEIGHT) *
                                                     std::max(glm::dot(texel_direction(x, y), zenith), 0.0));
    const glm::vec3 ground(irradiance * (sky.ground_albedo / PI));
    for (int y = 0; y < HEIGHT; ++y)
        for (int x = 0; x < WIDTH; ++x)
            if (glm::dot(texel_direction(x, y), zenith) <= 0)
                texel(x, y) = ground;
    return light;
}

} // namespace clrt
