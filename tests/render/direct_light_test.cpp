// SPDX-License-Identifier: Apache-2.0
// Direct light on matte surfaces against closed forms, for every integrator: area lights, point lights, suns.
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double KD = 0.5;
const glm::dvec3 UP(0, 1, 0);
const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED,
                                  Integrator::RAYCAST};

/// A matte floor seen where the y axis meets it, and room for lights that only shine.
class FloorScene : public TestScene {
public:
    FloorScene() {
        build.material("matte", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 3 2 1");
        build.use("matte").floor(20);
        look_at_point({1.5, 0.8, 0.4}, {0, 0, 0});
    }
    void add_point(const glm::dvec3& position, const glm::dvec3& intensity) {
        options.light.points.push_back({position, intensity});
    }
    void add_sun(const glm::dvec3& towards, const glm::dvec3& irradiance, double diameter_degrees) {
        options.light.suns.push_back({towards, irradiance, diameter_degrees});
    }
};

/// Renders with every integrator and expects the radiance KD irradiance / pi, where the lamp of radiance 1
/// would give `irradiance`.
void expect_lamp_irradiance(FloorScene& scene, double irradiance) {
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        SCOPED_TRACE(name_of(integrator));
        EXPECT_TRUE(agrees(film_estimate(film, 0), 3 * KD * irradiance / PI));
        EXPECT_TRUE(agrees(film_estimate(film, 2), 1 * KD * irradiance / PI));
    }
}

/// The same for lights without noise, whatever the light is.
void expect_radiance(FloorScene& scene, double radiance, double sharpness = 1e-6,
                     double rounding = RENDER_ROUNDING) {
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        SCOPED_TRACE(name_of(integrator));
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), radiance, sharpness, rounding));
    }
}

} // namespace

TEST(DirectLight, ASphereLightGivesTheSumOfItsPolygons) {
    const glm::dvec3 centre(-0.8, 1.6, 0.6);
    const double radius = 0.5, distance = glm::length(centre);
    double irradiance = 0;
    for (const TestTriangle& t : icosphere_triangles(centre, radius, 3)) {
        const glm::dvec3 normal = glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
        if (glm::dot(normal, t.corners[0]) < 0) // the origin sees its front
            irradiance += polygon_irradiance({0, 0, 0}, UP, {t.corners[0], t.corners[1], t.corners[2]});
    }
    // The sphere itself gives pi (R/d)^2 cos.
    EXPECT_NEAR(irradiance, PI * radius * radius * centre.y / (distance * distance * distance),
                0.01 * irradiance);

    FloorScene scene;
    scene.build.use("lamp").icosphere(centre, radius, 3);
    scene.options.sampling.spp = 2 * *scene.options.sampling.spp; // half of it shines away from the floor
    expect_lamp_irradiance(scene, irradiance);
}

TEST(DirectLight, ATriangleLightFollowsLambertsFormula) {
    const std::vector<glm::dvec3> corners = {{-1.5, 0.7, -0.6}, {-0.9, 2.2, -0.4}, {-0.5, 1.2, 0.8}};
    FloorScene scene;
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    ASSERT_LT(glm::dot(normal, corners[0]), 0) << "its front shines on the floor";
    scene.build.use("lamp").polygon(corners);
    expect_lamp_irradiance(scene, polygon_irradiance({0, 0, 0}, UP, corners));
}

TEST(DirectLight, AQuadLightAboveTheFloorFollowsLambertsFormula) {
    const std::vector<glm::dvec3> corners = {{-1, 1, -1}, {0.5, 1, -1}, {0.5, 1, 0.7}, {-1, 1, 0.7}};
    FloorScene scene;
    scene.build.use("lamp").polygon(corners);
    scene.look_at_point({3, 0.8, 0.4}, {0, 0, 0}); // below the lamp's edge
    expect_lamp_irradiance(scene, polygon_irradiance({0, 0, 0}, UP, corners));
}

TEST(DirectLight, ALightThatSinksBelowTheHorizonIsCutThere) {
    const std::vector<glm::dvec3> corners = {{-1, -2, 1}, {-1, -2, -1}, {-1, 1.5, -1}, {-1, 1.5, 1.2}};
    FloorScene scene;
    scene.build.use("lamp").polygon(corners);
    expect_lamp_irradiance(scene, polygon_irradiance({0, 0, 0}, UP, corners));
}

TEST(DirectLight, ATinyFarLightIsNeitherLostNorTooBright) {
    const double side = 0x1p-13; // so that floats hold the corners
    const std::vector<glm::dvec3> corners = {
        {-2, 3, 1}, {-2 + side, 3, 1}, {-2 + side, 3, 1 + side}, {-2, 3, 1 + side}};
    FloorScene scene;
    scene.build.use("lamp").polygon(corners);
    expect_lamp_irradiance(scene, polygon_irradiance({0, 0, 0}, UP, corners));
}

TEST(DirectLight, APanelOverAWholeFloorIsNearlyASky) {
    const double s = 15;
    const std::vector<glm::dvec3> corners = {{-s, 0.5, -s}, {s, 0.5, -s}, {s, 0.5, s}, {-s, 0.5, s}};
    FloorScene scene;
    scene.build.use("lamp").polygon(corners);
    scene.look_at_point({0.5, 0.3, 0.2}, {0, 0, 0});
    scene.options.transport.integrator = Integrator::PATH;
    const double irradiance = polygon_irradiance({0, 0, 0}, UP, corners);
    EXPECT_GT(irradiance, 0.99 * PI);
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 3 * KD * irradiance / PI));
}

TEST(DirectLight, ManyLightsOfUnequalPowerAddUp) {
    // Brighter and larger lamps are chosen more often; the sum must not notice.
    FloorScene scene;
    scene.build.material("dim", "Kd 0 0 0\nKe 0.3 0.2 0.1");
    double irradiance = 0;
    for (int i = 0; i < 12; ++i) {
        const double size = 0.05 + 0.03 * i, angle = 0.5 * i;
        const glm::dvec3 corner(1.5 * std::cos(angle), 1 + 0.1 * i, 1.5 * std::sin(angle));
        const std::vector<glm::dvec3> corners = {corner, corner + glm::dvec3(size, 0, 0),
                                                 corner + glm::dvec3(0, 0, size)};
        scene.build.use(i % 3 ? "lamp" : "dim").polygon(corners);
        irradiance += (i % 3 ? 1 : 0.1) * polygon_irradiance({0, 0, 0}, UP, corners);
    }
    scene.look_at_point({0.3, 0.4, 0.1}, {0, 0, 0});
    expect_lamp_irradiance(scene, irradiance);
}

TEST(DirectLight, LampsShineOnTheirFrontOnlyUnlessToldOtherwise) {
    FloorScene scene;
    const std::vector<glm::dvec3> corners = {{-1, 1, 1}, {0.5, 1, 1}, {0.5, 1, -1}, {-1, 1, -1}}; // faces up
    scene.build.use("lamp").polygon(corners);
    scene.look_at_point({3, 0.8, 0.4}, {0, 0, 0});
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        EXPECT_EQ(film_estimate(scene.render().film).mean, 0) << name_of(integrator);
    }
    scene.options.light.two_sided = true;
    expect_lamp_irradiance(scene, polygon_irradiance({0, 0, 0}, UP, corners));

    // Seen from below the lamp is bright with two sides, and black with one.
    scene.look({-0.3, 0.5, 0}, {-0.3, 1, 0}, 20);
    scene.options.transport.integrator = Integrator::PATH;
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 3, 1e-6));
    scene.options.light.two_sided = false;
    EXPECT_EQ(film_estimate(scene.render().film).mean, 0);
    scene.look({-0.3, 1.5, 0}, {-0.3, 1, 0}, 20);
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 3, 1e-6));
}

TEST(DirectLight, AnOccluderTakesExactlyItsShareOfALight) {
    // A black screen over half of the lamp, touching neither floor nor lamp: what remains is the other half.
    FloorScene scene;
    scene.build.material("black", "Kd 0 0 0");
    scene.build.use("lamp").polygon({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    scene.build.use("black").polygon({{0, 1, -3}, {0, 1, 3}, {-3, 1, 3}, {-3, 1, -3}});
    scene.look_at_point({3, 0.8, 0.4}, {0, 0, 0});
    expect_lamp_irradiance(scene,
                           polygon_irradiance({0, 0, 0}, UP, {{0, 2, -1}, {1, 2, -1}, {1, 2, 1}, {0, 2, 1}}));
}

TEST(DirectLight, APointLightFallsWithTheSquareOfItsDistance) {
    for (const double distance : {0.5, 20.0, 1e4}) {
        FloorScene scene;
        scene.add_point(glm::dvec3(0, 0.6, 0.8) * distance, glm::dvec3(7));
        scene.look_at_point({0.03, 0.02, 0}, {0, 0, 0}); // the patch is small beside every distance
        expect_radiance(scene, KD / PI * 7 * 0.6 / (distance * distance), 1e-5,
                        2e-5); // the floor is 40 units wide
    }
}

TEST(DirectLight, PointLightsAddUpAndCastSharpShadows) {
    FloorScene scene;
    scene.build.material("black", "Kd 0 0 0").use("black");
    scene.build.polygon({{-0.6, 0.5, -0.1}, {-0.4, 0.5, -0.1}, {-0.4, 0.5, 0.1}, {-0.6, 0.5, 0.1}});
    scene.add_point({0, 2, 0}, glm::dvec3(4));
    scene.add_point({3, 4, 0}, glm::dvec3(25));
    scene.add_point({-1, 1, 0}, glm::dvec3(100)); // behind the black square
    expect_radiance(scene, KD / PI * (4.0 / 4 + 25 * 0.8 / 25), 1e-2);
}

TEST(DirectLight, ASpotDimsTowardsItsOuterCone) {
    const auto cosine = [](double degrees) { return std::cos(degrees * PI / 180); };
    for (const double outer : {40.0, 24.0}) { // the patch is 25 degrees off the axis
        FloorScene scene;
        const SpotCone cone{{0, -cosine(25), std::sin(25 * PI / 180)}, outer, 10};
        scene.options.light.points.push_back({{0, 100, 0}, glm::dvec3(7e4), cone});
        scene.look_at_point({0.03, 0.02, 0}, {0, 0, 0});
        const double share = std::max(0.0, (cosine(25) - cosine(outer)) / (cosine(10) - cosine(outer)));
        expect_radiance(scene, KD / PI * 7 * share * share, 1e-5, 2e-4);
    }
}

TEST(DirectLight, ASunGivesItsIrradianceTimesTheCosine) {
    for (const double diameter : {0.0, 0.5, 30.0}) {
        FloorScene scene;
        scene.add_sun({0, 3, 4}, {5, 4, 3}, diameter);
        scene.look_at_point({1, 1, 0}, {0, 0, 0});
        SCOPED_TRACE(diameter);
        expect_radiance(scene, KD / PI * 5 * 0.6, diameter > 0 ? 1e-3 : 1e-6);
    }
}

TEST(DirectLight, TheDiscOfASunIsSeenWithItsRadiance) {
    FloorScene scene;
    scene.add_sun({0, 1, -1}, {5, 4, 3}, 2);
    scene.look({0, 1, 0}, {0, 2, -1}, 0.1); // within the disc
    const double sine = std::sin(PI / 180);
    expect_radiance(scene, 5 / (PI * sine * sine));
    scene.look({0, 1, 0}, {0.05, 2, -1}, 0.1); // two degrees beside it
    expect_radiance(scene, 0);
}

TEST(DirectLight, AllKindsOfLightTogetherAreTheSumOfEachAlone) {
    // The path tracer shares its light samples between the kinds; the others sample each.
    FloorScene scene;
    const std::vector<glm::dvec3> corners = {{-1, 1, -1}, {0.5, 1, -1}, {0.5, 1, 0.7}, {-1, 1, 0.7}};
    scene.build.use("lamp").polygon(corners);
    scene.add_point({2, 2, 0.5}, glm::dvec3(4));
    scene.add_sun({4, 3, 0}, glm::dvec3(0.7), 5);
    scene.look_at_point({3, 0.8, 0.4}, {0, 0, 0});
    const double point = 4 * 2 / std::pow(2 * 2 + 2 * 2 + 0.25, 1.5);
    expect_radiance(scene, KD / PI * (3 * polygon_irradiance({0, 0, 0}, UP, corners) + point + 0.7 * 0.6),
                    2e-3);
}

TEST(DirectLight, ALightInAClosedBoxLeaksNothing) {
    FloorScene scene;
    scene.build.use("lamp").icosphere({0, 1, 0}, 0.3, 1);
    scene.build.use("matte").box({-0.5, 0.5, -0.5}, {0.5, 1.5, 0.5});
    scene.look({3, 2, 4}, {0, 0.8, 0}, 40);
    scene.options.film.size = {64, 64};
    scene.options.sampling.spp = 64;
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        EXPECT_EQ(std::count(film.sums.begin(), film.sums.end(), 0), std::int64_t(film.sums.size()));
    }
}

TEST(DirectLight, ARoomWithoutGapsKeepsTheSkyOut) {
    FloorScene scene;
    scene.build.box({-1, 0.25, -1}, {1, 2, 1}, Facing::INWARD);
    scene.options.light.environment = glm::dvec3(1000);
    scene.look({0.9, 0.3, 0.9}, {-1, 2, -1}, 120);
    scene.options.film.size = {64, 64};
    scene.options.sampling.spp = 256;
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        EXPECT_EQ(std::count(film.sums.begin(), film.sums.end(), 0), std::int64_t(film.sums.size()));
    }
}

} // namespace clrt
