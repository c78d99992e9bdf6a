// SPDX-License-Identifier: Apache-2.0
// scene/daylight.h: what is known of the light of clear skies.
#include "scene/daylight.h"

#include "colour.h"
#include "scene/atmosphere.h"
#include "scene/sky_table.h"
#include "scene/spectrum.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

constexpr double PI = 3.14159265358979323846;
constexpr dvec3 Y_UP(0, 1, 0), Z_UP(0, 0, 1);
/// Illuminance by the sun above the air, klx, of which the unit of daylight.h is the part of 1 / pi.
constexpr double SUN_KLX = 133;

SkyOptions sky_of(double elevation, double turbidity = 2.5) {
    SkyOptions sky;
    sky.elevation_degrees = elevation;
    sky.turbidity = turbidity;
    return sky;
}

dvec3 texel(const Daylight& light, int x, int y) {
    return dvec3(light.image.texels[size_t(y * light.image.width + x)]);
}

/// Illuminance of level ground by the sky alone, klx.
double diffuse_klx(const Daylight& light) {
    double sum = 0;
    for (int y = 0; y < light.image.height / 2; ++y)
        for (int x = 0; x < light.image.width; ++x)
            sum += luminance(texel(light, x, y)) * std::cos(PI * (y + 0.5) / light.image.height) *
                   texel_solid_angle(y, light.image.width, light.image.height);
    return sum * SUN_KLX / PI;
}

double direct_klx(const Daylight& light) {
    return luminance(light.sun.irradiance) * light.sun.towards.y * SUN_KLX / PI;
}

} // namespace

TEST(Spectrum, WhiteIsSeenAsWhite) {
    Spectrum even;
    even.fill(1);
    const dvec3 xyz = to_xyz(even);
    EXPECT_NEAR(xyz.x, 1, 0.01);
    EXPECT_NEAR(xyz.y, 1, 1e-12);
    EXPECT_NEAR(xyz.z, 1, 0.015);
    // A black body of the temperature of sRGB's white is white, but for the two points' distance.
    const dvec3 body = to_xyz(black_body(6504)), white = to_linear_srgb(body / body.y);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(white[c], 1, 0.06) << c;
    // The sun's colour is warmer: CIE 1931 x, y of 5778 K are 0.3263, 0.3358.
    const dvec3 sun = to_xyz(black_body(5778));
    EXPECT_NEAR(sun.x / (sun.x + sun.y + sun.z), 0.3263, 2e-3);
    EXPECT_NEAR(sun.y / (sun.x + sun.y + sun.z), 0.3358, 2e-3);
}

TEST(Atmosphere, CleanAirHasTheOpticalDepthOfRayleigh) {
    // Bucholtz (1995): 0.0971 at 550 nm for a standard atmosphere; ozone adds 0.0 to 0.04.
    const Spectrum through = Atmosphere(1, 0.2).sunlight(1);
    for (size_t i = 0; i < SPECTRUM_BANDS; ++i) {
        const double depth = -std::log(through[i]), nm = band_wavelength(i);
        const double rayleigh = 0.0971 * std::pow(550 / nm, 4);
        EXPECT_NEAR(depth, rayleigh, 0.03 * rayleigh + (nm > 450 && nm < 740 ? 0.045 : 0.004)) << nm;
        EXPECT_GT(depth, 0.97 * rayleigh) << nm;
    }
    EXPECT_EQ(Atmosphere(1, 0.2).sunlight(-0.01)[8], 0) << "the ground is in the way";
}

TEST(Daylight, IlluminancesAreThoseOfClearDays) {
    // Clear skies: CIBSE guide, IES: 80 to 120 klx by a high sun, a tenth to a quarter of that by the sky.
    const Daylight high = make_daylight(sky_of(60), Y_UP);
    EXPECT_GT(direct_klx(high), 75);
    EXPECT_LT(direct_klx(high), 100);
    EXPECT_GT(diffuse_klx(high), 10);
    EXPECT_LT(diffuse_klx(high), 25);
    const Daylight low = make_daylight(sky_of(10), Y_UP);
    EXPECT_GT(direct_klx(low) + diffuse_klx(low), 8);
    EXPECT_LT(direct_klx(low) + diffuse_klx(low), 18);
    // Civil twilight ends at -6 degrees, by a few lux.
    const Daylight dusk = make_daylight(sky_of(-6), Y_UP);
    EXPECT_EQ(dusk.sun.irradiance, dvec3(0));
    EXPECT_GT(diffuse_klx(dusk), 1e-4);
    EXPECT_LT(diffuse_klx(dusk), 3e-2);
}

TEST(Daylight, NoMoreLightArrivesThanTheSunSends) {
    for (const double turbidity : {1.0, 2.5, 10.0})
        for (const double elevation : {3.0, 20.0, 90.0}) {
            SkyOptions sky = sky_of(elevation, turbidity);
            sky.ground_albedo = 0;
            const Daylight light = make_daylight(sky, Y_UP);
            EXPECT_LT(direct_klx(light) + diffuse_klx(light),
                      SUN_KLX * std::sin(elevation * PI / 180) * (elevation < 5 ? 1.3 : 1.0))
                << "turbidity " << turbidity << ", elevation " << elevation;
        }
}

TEST(Daylight, HazeTakesFromTheSunAndGivesToTheSky) {
    double direct = 1e9, diffuse = 0;
    for (const double turbidity : {1.0, 2.0, 4.0, 8.0}) {
        const Daylight light = make_daylight(sky_of(50, turbidity), Y_UP);
        EXPECT_LT(direct_klx(light), direct);
        EXPECT_GT(diffuse_klx(light), diffuse);
        direct = direct_klx(light);
        diffuse = diffuse_klx(light);
    }
}

TEST(Daylight, TheSkyIsBlueAndALowSunRed) {
    const Daylight noon = make_daylight(sky_of(50, 1.5), Y_UP), evening = make_daylight(sky_of(2, 1.5), Y_UP);
    const dvec3 zenith = texel(noon, 0, 0);
    EXPECT_GT(zenith.z, 2 * zenith.x);
    EXPECT_GT(evening.sun.irradiance.x, 4 * evening.sun.irradiance.z);
    EXPECT_LT(noon.sun.irradiance.x, 2 * noon.sun.irradiance.z);
}

TEST(Daylight, BothSidesOfTheSunAreAlike) {
    SkyOptions sky = sky_of(25);
    sky.azimuth_degrees = 90; // +x: u = 1/2, in the middle of the map
    const Daylight light = make_daylight(sky, Y_UP);
    const int width = light.image.width, height = light.image.height;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width / 2; ++x) {
            const dvec3 a = texel(light, x, y), b = texel(light, width - 1 - x, y);
            ASSERT_LE(glm::length(a - b), 1e-5 * glm::length(a)) << x << "," << y;
            if (y >= height / 2) {
                ASSERT_EQ(a, texel(light, 0, height - 1)) << "the ground is even";
            }
        }
    // The ground sends back what it gets.
    const double ground = luminance(texel(light, 0, height - 1)) * PI / 0.2 * SUN_KLX / PI;
    EXPECT_NEAR(ground, direct_klx(light) + diffuse_klx(light), 1e-3 * ground);
}

TEST(Daylight, TheSunIsWhereItIsAskedFor) {
    const auto towards = [](double elevation, double azimuth, const dvec3& up) {
        SkyOptions sky;
        sky.elevation_degrees = elevation;
        sky.azimuth_degrees = azimuth;
        return sun_direction(sky, up);
    };
    const auto near = [](const dvec3& a, const dvec3& b) { return glm::length(a - b) < 1e-12; };
    EXPECT_TRUE(near(towards(0, 0, Y_UP), {0, 0, -1}));
    EXPECT_TRUE(near(towards(0, 90, Y_UP), {1, 0, 0}));
    EXPECT_TRUE(near(towards(90, 12, Y_UP), {0, 1, 0}));
    EXPECT_TRUE(near(towards(0, 0, Z_UP), {0, 1, 0}));
    EXPECT_TRUE(near(towards(0, 90, Z_UP), {1, 0, 0}));
    const double half = std::sqrt(0.5);
    EXPECT_TRUE(near(towards(45, 180, Z_UP), {0, -half, half}));

    // The brightest texel lies where the sun is, whatever is up.
    for (const dvec3& up : {Y_UP, Z_UP}) {
        SkyOptions sky = sky_of(40);
        sky.azimuth_degrees = 70;
        const Daylight light = make_daylight(sky, up);
        EXPECT_TRUE(near(light.sun.towards, sun_direction(sky, up)));
        EXPECT_NEAR(light.sun.diameter_degrees, 0.533, 1e-9);
        double brightest = 0, best = 0;
        for (int y = 0; y < light.image.height; ++y)
            for (int x = 0; x < light.image.width; ++x) {
                const double polar = PI * (y + 0.5) / light.image.height;
                const double phi = 2 * PI * ((x + 0.5) / light.image.width - 0.5);
                const dvec3 d(std::sin(polar) * std::cos(phi), std::cos(polar),
                              std::sin(polar) * std::sin(phi));
                if (luminance(texel(light, x, y)) > brightest) {
                    brightest = luminance(texel(light, x, y));
                    best = glm::dot(d, light.sun.towards);
                }
            }
        EXPECT_GT(best, std::cos(8 * PI / 180));
    }
}
