// SPDX-License-Identifier: Apache-2.0
// Coverage below 1: what shows through, what shadows and lamps become.
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED,
                                  Integrator::RAYCAST};
const glm::dvec3 UP(0, 1, 0);

/// Coloured lamps that face +z.
class Screens : public TestScene {
public:
    Screens() { look({0, 0, 5}, {0, 0, 0}, 10); }
    void add(double z, const std::string& keys) {
        const std::string name = "screen" + std::to_string(count_++);
        build.material(name, "Kd 0 0 0\n" + keys).use(name);
        build.textured_quad({{-1, -1, z}, {1, -1, z}, {1, 1, z}, {-1, 1, z}});
    }

private:
    int count_ = 0;
};

/// A matte floor below a screen, with a light above both.
class ShadedFloor : public TestScene {
public:
    explicit ShadedFloor(const std::string& screen_keys) {
        build.material("matte", "Kd 0.5 0.5 0.5").material("screen", "Kd 0 0 0\n" + screen_keys);
        build.use("matte").floor(9).use("screen");
        build.textured_quad({{-2, 1, 2}, {2, 1, 2}, {2, 1, -2}, {-2, 1, -2}});
        look_at_point({3, 0.5, 0}, {0, 0, 0});
        options.light.points.push_back({{0, 2, 0}, glm::dvec3(8)});
    }
    /// The floor's radiance without the screen.
    double unshaded() const { return 0.5 / PI * 8 / 4; }
};

} // namespace

TEST(CutOut, TheBackgroundShowsThroughInProportion) {
    Screens scene;
    scene.add(0, "Ke 0 0 1");
    scene.add(1, "Ke 0 1 0\nd 0.5");
    scene.add(2, "Ke 1 0 0\nTr 0.75");
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        SCOPED_TRACE(name_of(integrator));
        EXPECT_TRUE(agrees(film_estimate(film, 0), 0.25, 5e-3));
        EXPECT_TRUE(agrees(film_estimate(film, 1), 0.75 * 0.5, 5e-3));
        EXPECT_TRUE(agrees(film_estimate(film, 2), 0.75 * 0.5, 5e-3));
    }
}

TEST(CutOut, CoincidentLayersAreMetOneAfterTheOther) {
    Screens scene;
    scene.add(0, "Ke 1 0 0\nd 0.5");
    scene.add(0, "Ke 0 1 0\nd 0.5");
    scene.add(0, "Ke 0 0 1");
    const Film film = scene.render().film;
    EXPECT_TRUE(agrees(film_estimate(film, 0), 0.5, 5e-3));
    EXPECT_TRUE(agrees(film_estimate(film, 1), 0.25, 5e-3));
    EXPECT_TRUE(agrees(film_estimate(film, 2), 0.25, 5e-3));
}

TEST(CutOut, AMaskCutsAlongItsPicture) {
    // Alpha 1 on the left half, 0 on the right; between the middle texels it falls off.
    std::vector<unsigned char> rgba;
    for (int i = 0; i < 16 * 16; ++i)
        rgba.insert(rgba.end(), {255, 255, 255, (unsigned char)(i % 16 < 8 ? 255 : 0)});
    Screens scene;
    scene.texture8("mask.png", 16, 16, 4, rgba);
    scene.add(0, "Ke 0 1 0");
    scene.add(0.01, "Ke 1 0 0\nmap_d -clamp on mask.png");
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        EXPECT_TRUE(agrees(film_estimate(film, 0, {0, 0, 6, 16}), 1, 1e-6)) << name_of(integrator);
        EXPECT_EQ(film_estimate(film, 1, {0, 0, 6, 16}).mean, 0) << name_of(integrator);
        EXPECT_EQ(film_estimate(film, 0, {10, 0, 16, 16}).mean, 0) << name_of(integrator);
        EXPECT_TRUE(agrees(film_estimate(film, 1, {10, 0, 16, 16}), 1, 1e-6)) << name_of(integrator);
    }
}

TEST(CutOut, ShadowsOfScreensLetTheirShareThrough) {
    for (const auto& [keys, share] :
         {std::pair{"d 1", 0.0}, {"d 0.25", 0.75}, {"Tr 0.4", 0.4}, {"d 0", 1.0}}) {
        ShadedFloor scene(keys);
        for (const Integrator integrator : INTEGRATORS) {
            scene.options.transport.integrator = integrator;
            EXPECT_TRUE(agrees(film_estimate(scene.render().film), share * scene.unshaded(), 1e-4, 4e-5))
                << keys << ", " << name_of(integrator);
        }
    }
}

TEST(CutOut, SharesOfSeveralScreensMultiply) {
    ShadedFloor scene("d 0.25");
    scene.build.polygon({{-2, 1.5, 2}, {2, 1.5, 2}, {2, 1.5, -2}, {-2, 1.5, -2}});
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 0.75 * 0.75 * scene.unshaded(), 1e-4, 4e-5));
}

TEST(CutOut, ALampGivesLightInProportionToItsCoverage) {
    const std::vector<glm::dvec3> corners = {{-1, 1, -1}, {0.5, 1, -1}, {0.5, 1, 0.7}, {-1, 1, 0.7}};
    TestScene scene;
    scene.build.material("matte", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 3 3 3\nd 0.25");
    scene.build.use("matte").floor(9).use("lamp").polygon(corners);
    scene.look_at_point({3, 0.8, 0.4}, {0, 0, 0});
    for (const Integrator integrator : INTEGRATORS) {
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film),
                           0.25 * 3 * 0.5 * polygon_irradiance({0, 0, 0}, UP, corners) / PI, 4e-3))
            << name_of(integrator);
    }
}

} // namespace clrt
