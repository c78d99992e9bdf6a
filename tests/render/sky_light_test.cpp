// SPDX-License-Identifier: Apache-2.0
// Light from outside the scene: constant skies and latitude-longitude maps, seen and as irradiance.
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "scene/daylight.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED,
                                  Integrator::RAYCAST};

/// A grey map: one value a texel, rows from +Y down.
struct GreyMap {
    int width, height;
    std::vector<float> values;

    GreyMap(int columns, int rows) : width(columns), height(rows), values(size_t(columns * rows), 0.0f) {}
    float& at(int x, int y) { return values[size_t(y * width + x)]; }

    /// Bilinear lookup that wraps around in u and ends at the poles.
    double lookup(double u, double v) const {
        const double x = u * width - 0.5, y = v * height - 0.5;
        const double fx = x - std::floor(x), fy = y - std::floor(y);
        const auto texel = [&](int column, int row) {
            return double(
                values[size_t(std::min(std::max(row, 0), height - 1) * width + (column + width) % width)]);
        };
        const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
        return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x0 + 1, y0)) +
               fy * ((1 - fx) * texel(x0, y0 + 1) + fx * texel(x0 + 1, y0 + 1));
    }

    /// Direction of map coordinates, turned by `degrees` about +Y, right-handed.
    static glm::dvec3 direction(double u, double v, double degrees = 0) {
        const double phi = 2 * PI * (u - 0.5), theta = PI * v, turn = degrees * PI / 180;
        const glm::dvec3 d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        return {std::cos(turn) * d.x + std::sin(turn) * d.z, d.y,
                -std::sin(turn) * d.x + std::cos(turn) * d.z};
    }

    /// Irradiance on a surface with this normal, by the midpoint rule.
    double irradiance(const glm::dvec3& normal, double degrees = 0) const {
        const int columns = 2048, rows = 1024;
        double sum = 0;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < columns; ++x) {
                const double u = (x + 0.5) / columns, v = (y + 0.5) / rows;
                const double cosine = glm::dot(direction(u, v, degrees), normal);
                if (cosine > 0)
                    sum += lookup(u, v) * cosine * std::sin(PI * v);
            }
        return sum * (2 * PI / columns) * (PI / rows);
    }
};

/// A matte slope (normal 0, 0.8, 0.6) under a map.
class SlopeUnderMap : public TestScene {
public:
    const glm::dvec3 normal{0, 0.8, 0.6};

    explicit SlopeUnderMap(const GreyMap& map) {
        build.material("matte", "Kd 0.5 0.5 0.5").use("matte");
        build.polygon({{-9, -6, 8}, {9, -6, 8}, {9, 6, -8}, {-9, 6, -8}});
        look_at_point({0.5, 1, 0.8}, {0, 0, 0});
        use(map);
    }
    void use(const GreyMap& map) {
        std::vector<float> rgb;
        for (const float value : map.values)
            rgb.insert(rgb.end(), {value, 2 * value, 0.5f * value});
        texture("map.exr", map.width, map.height, 3, rgb);
        options.light.environment_file = folder.file("map.exr");
    }
    /// Expects KD irradiance / pi of every integrator.
    void expect_irradiance(double irradiance, double sharpness) {
        for (const Integrator integrator : INTEGRATORS) {
            options.transport.integrator = integrator;
            SCOPED_TRACE(name_of(integrator));
            EXPECT_TRUE(agrees(film_estimate(render().film), 0.5 * irradiance / PI, sharpness, 2e-5));
        }
    }
};

/// A map without symmetry, every texel different.
GreyMap uneven_map(int width, int height) {
    GreyMap map(width, height);
    std::uint32_t state = 1;
    for (float& value : map.values) {
        state = state * 1664525u + 1013904223u;
        value = 0.1f + float(state >> 24) / 64;
    }
    return map;
}

} // namespace

TEST(SkyLight, AConvexMatteBodyUnderAConstantSkyShowsItsReflectance) {
    for (const Integrator integrator : INTEGRATORS) {
        TestScene scene;
        scene.build.material("matte", "Kd 0.6 0.3 0").use("matte").icosphere({0, 0, 0}, 1, 3);
        scene.options.light.environment = glm::dvec3(2);
        scene.options.light.environment_scale = 0.5;
        scene.options.transport.integrator = integrator;
        scene.look({0, 0, 5}, {0, 0, 0}, 12);
        const Film film = scene.render().film;
        EXPECT_TRUE(agrees(film_estimate(film, 0), 0.6, 1e-6)) << name_of(integrator);
        EXPECT_TRUE(agrees(film_estimate(film, 1), 0.3, 1e-6)) << name_of(integrator);
        EXPECT_EQ(film_estimate(film, 2).mean, 0);
    }
}

TEST(SkyLight, AWhiteSkyIsTakenWhereNothingElseShines) {
    TestScene scene;
    scene.build.material("matte", "Kd 0.6 0.3 0").use("matte").icosphere({0, 0, 0}, 1, 2);
    scene.look({0, 0, 5}, {0, 0, 0}, 12);
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.6, 1e-6));
}

TEST(SkyLight, EveryTexelIsSeenInItsDirection) {
    GreyMap map = uneven_map(8, 4);
    for (const double turn : {0.0, 90.0, -37.0}) {
        SlopeUnderMap scene(map);
        scene.options.light.environment_rotation_degrees = turn;
        scene.options.sampling.spp = 64;
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 8; x += 3) {
                const glm::dvec3 eye(0, 30, 0); // above the slope, which hides nothing that it looks at
                const glm::dvec3 d = GreyMap::direction((x + 0.5) / 8, (y + 0.5) / 4, turn);
                scene.look_at_point(d.y < 0 ? -eye : eye, (d.y < 0 ? -eye : eye) + d);
                EXPECT_TRUE(agrees(film_estimate(scene.render().film), map.at(x, y), 1e-3, 2e-2)) // bilinear
                    << x << "," << y << " turned by " << turn;
            }
    }
}

TEST(SkyLight, TheMapLiesAsDocumented) {
    // u = 0.5 + atan2(z, x) / (2 pi), v = acos(y) / pi: +X is in the middle, +Z at three quarters, +Y on top.
    EXPECT_NEAR(GreyMap::direction(0.5, 0.5).x, 1, 1e-12);
    EXPECT_NEAR(GreyMap::direction(0.75, 0.5).z, 1, 1e-12);
    EXPECT_NEAR(GreyMap::direction(0.3, 0).y, 1, 1e-12);
    // Turned by 90 degrees about +Y, what lay at +Z lies at +X.
    EXPECT_NEAR(GreyMap::direction(0.75, 0.5, 90).x, 1, 1e-12);
}

TEST(SkyLight, OneBrightTexelGivesTheIrradianceOfItsTent) {
    for (const auto& [column, row] : {std::pair{20, 6}, {24, 2}, {31, 4}, {12, 0}}) {
        GreyMap map(32, 16);
        map.at(column, row) = 1000;
        SlopeUnderMap scene(map);
        SCOPED_TRACE(std::to_string(column) + "," + std::to_string(row));
        const double irradiance = map.irradiance(scene.normal);
        ASSERT_GT(irradiance, 0);
        scene.expect_irradiance(irradiance, 5e-3);
    }
}

TEST(SkyLight, AnUnevenMapGivesTheIrradianceOfItsIntegral) {
    const GreyMap map = uneven_map(16, 8);
    SlopeUnderMap scene(map);
    scene.expect_irradiance(map.irradiance(scene.normal), 3e-3);
}

TEST(SkyLight, TurningTheMapTurnsItsLight) {
    GreyMap map(32, 16);
    map.at(10, 4) = 1000;
    SlopeUnderMap scene(map);
    for (const double turn : {60.0, 200.0}) {
        scene.options.light.environment_rotation_degrees = turn;
        const double irradiance = map.irradiance(scene.normal, turn);
        ASSERT_GT(irradiance, 0);
        EXPECT_GT(std::abs(irradiance / map.irradiance(scene.normal) - 1), 0.1);
        scene.expect_irradiance(irradiance, 5e-3);
    }
}

TEST(SkyLight, AMapOfOneValueIsAConstantSky) {
    GreyMap map(8, 4);
    map.values.assign(map.values.size(), 0.75f);
    SlopeUnderMap scene(map);
    scene.expect_irradiance(0.75 * PI, 3e-3);
}

/// A map that is bright on the side of +Z and dim on the other, so that its table beside BSDF sampling holds
/// the bright half alone.
GreyMap half_bright_map() {
    GreyMap map(32, 16);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 32; ++x)
            map.at(x, y) = x >= 16 ? 3 : 1;
    return map;
}

TEST(SkyLight, TheDimHalfOfAMapLightsAFloorWhateverEndsThePaths) {
    const GreyMap map = half_bright_map();
    SlopeUnderMap scene(map);
    const double irradiance = map.irradiance(scene.normal);
    for (const char* paths : {"", "LDE", "L(D|G)E", "L.*E"})
        for (const int depth : {2, 8})
            for (const int roulette : {1, 4}) {
                SCOPED_TRACE(
                    fmt::format("--paths '{}' --max-depth {} --roulette-depth {}", paths, depth, roulette));
                scene.options.transport.paths = paths;
                scene.options.transport.max_depth = depth;
                scene.options.transport.roulette_depth = roulette;
                EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.5 * irradiance / PI, 1.5e-3, 2e-5));
            }
}

TEST(SkyLight, AClearSkyAndItsSunLightAFloorByTheirIrradiance) {
    SkyOptions sky;
    sky.elevation_degrees = 25;
    sky.azimuth_degrees = 200;
    const Daylight light = make_daylight(sky, {0, 1, 0});
    glm::dvec3 irradiance = light.sun.irradiance * light.sun.towards.y;
    for (int channel = 0; channel < 3; ++channel) {
        GreyMap map(light.image.width, light.image.height);
        for (size_t i = 0; i < map.values.size(); ++i)
            map.values[i] = light.image.texels[i][channel];
        irradiance[channel] += map.irradiance({0, 1, 0});
    }
    for (const Integrator integrator : {Integrator::PATH, Integrator::DISTRIBUTION}) {
        TestScene scene;
        scene.build.material("matte", "Kd 0.5 0.5 0.5").use("matte").floor(1);
        scene.look_at_point({0, 2, 0.5}, {0, 0, 0});
        scene.options.light.sky = sky;
        scene.options.light.environment_scale = 2;
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_TRUE(agrees(film_estimate(film, channel), 2 * 0.5 / PI * irradiance[channel], 2e-3, 1e-5))
                << name_of(integrator) << ", channel " << channel;
    }
}

TEST(SkyLight, AMirrorShowsTheMapAsItIs) {
    const GreyMap map = uneven_map(8, 4);
    SlopeUnderMap scene(map);
    scene.build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3").use("mirror").floor(5, 40);
    const glm::dvec3 towards = glm::normalize(GreyMap::direction(2.5 / 8, 1.5 / 4)), at(0, 40, 0);
    scene.look_at_point(at + glm::dvec3(-towards.x, towards.y, -towards.z), at);
    for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED}) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), map.lookup(2.5 / 8, 1.5 / 4), 1e-3, 1e-3));
    }
}

} // namespace clrt
