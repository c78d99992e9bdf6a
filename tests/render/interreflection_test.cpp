// SPDX-License-Identifier: Apache-2.0
// Light that is scattered several times between two matte squares, against radiosity in double precision.
#include "probes/closed_forms.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr int STEPS = 48; ///< patches a side; twice as many change the result by less than 1e-4
constexpr double FLOOR_KD = 0.9, CEILING_KD = 0.6;
const glm::dvec3 LIGHT(0.3, 0.4, -0.2);
constexpr double INTENSITY = 5;

/// A point light's irradiance on a horizontal surface at p.
double direct_irradiance(const glm::dvec3& p) {
    const glm::dvec3 way = LIGHT - p;
    return INTENSITY * std::abs(way.y) / std::pow(glm::dot(way, way), 1.5);
}

/// Radiosities of a square of patches at one height.
struct Square {
    double height = 0, reflectance = 0;
    std::vector<double> radiosity = std::vector<double>(STEPS * STEPS, 0.0);

    glm::dvec3 centre(int i) const {
        return {2 * (i % STEPS + 0.5) / STEPS - 1, height, 2 * (i / STEPS + 0.5) / STEPS - 1};
    }
    /// Irradiance that this square gives at a point of a parallel one.
    double irradiance_at(const glm::dvec3& p) const {
        double sum = 0;
        for (int i = 0; i < STEPS * STEPS; ++i) {
            const glm::dvec3 way = centre(i) - p;
            const double squared = glm::dot(way, way);
            sum += radiosity[size_t(i)] * way.y * way.y / (squared * squared);
        }
        return sum * 4 / (STEPS * STEPS) / PI;
    }
};

/// Radiance of the floor at p by light that was scattered at most `bounces` times.
double floor_radiance(const glm::dvec3& p, int bounces) {
    Square below{0, FLOOR_KD}, above{1, CEILING_KD};
    for (int bounce = 1; bounce < bounces; ++bounce) {
        Square next_below{0, FLOOR_KD}, next_above{1, CEILING_KD};
        for (int i = 0; i < STEPS * STEPS; ++i) {
            const glm::dvec3 low = below.centre(i), high = above.centre(i);
            next_below.radiosity[size_t(i)] = FLOOR_KD * (direct_irradiance(low) + above.irradiance_at(low));
            next_above.radiosity[size_t(i)] =
                CEILING_KD * (direct_irradiance(high) + below.irradiance_at(high));
        }
        below = next_below;
        above = next_above;
    }
    return FLOOR_KD / PI * (direct_irradiance(p) + above.irradiance_at(p));
}

} // namespace

TEST(Interreflection, EveryNumberOfBouncesAgreesWithRadiosity) {
    TestScene scene;
    scene.build.material("floor", "Kd 0.9 0.9 0.9").material("ceiling", "Kd 0.6 0.6 0.6");
    scene.build.use("floor").floor(1).use("ceiling").polygon(
        {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}});
    scene.options.light.points.push_back({LIGHT, glm::dvec3(INTENSITY)});
    const glm::dvec3 seen(-0.4, 0, 0.3);
    scene.look_at_point({-0.6, 0.8, 0.7}, seen);
    for (const int bounces : {1, 2, 3, 4, 6}) {
        scene.options.transport.max_depth = bounces + 1;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), floor_radiance(seen, bounces), 2e-3, 2e-4))
            << bounces;
    }
}

TEST(Interreflection, ABallAroundAPointLightIsEvenlyBright) {
    // I Kd / (pi R^2 (1 - Kd)) at any radius; the icosphere of radius 1 lies a little nearer.
    double reference = 0;
    for (const double radius : {1.0, 1024.0}) {
        TestScene scene;
        scene.build.material("matte", "Kd 0.5 0.5 0.5").use("matte");
        scene.build.icosphere({0, 0, 0}, radius, 3, Facing::INWARD);
        scene.options.light.points.push_back({{0, 0, 0}, glm::dvec3(radius * radius)});
        scene.look({0, 0, 0}, {0, 0, -radius}, 60);
        scene.options.sampling.spp = 256;
        const Estimate estimate = film_estimate(scene.render().film);
        EXPECT_TRUE(agrees(estimate, 1 / PI, 2e-3, 0.02)) << radius;
        reference = reference == 0 ? estimate.mean : reference;
        EXPECT_NEAR(estimate.mean, reference, 1e-9) << "a scale by a power of two";
    }
}

} // namespace clrt
