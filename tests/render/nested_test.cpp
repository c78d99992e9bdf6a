// SPDX-License-Identifier: Apache-2.0
// Solids that overlap, by priority: closed forms of slabs, one of which begins inside the other or behind a
// gap, and things within solids that must not be seen at all.
#include "probes/closed_forms.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator ALL_THAT_NEST[] = {Integrator::WHITTED, Integrator::DISTRIBUTION, Integrator::PATH,
                                    Integrator::PATH_LIGHT, Integrator::BDPT};

constexpr double GLASS = 1.5, WATER = 1.33;

/// Glass from z = 0 to 0.5, water from z = -0.5 to `water_end`, and a lamp at z = -2 that shines towards +z
/// from x = `edge` on.
class Aquarium : public TestScene {
public:
    Aquarium(const std::string& glass_keys, const std::string& water_keys, double water_end,
             double edge = -50) {
        build.material("glass", fmt::format("Ni {}\nillum 7\n", GLASS) + glass_keys);
        build.material("water", fmt::format("Ni {}\nillum 7\n", WATER) + water_keys);
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1");
        build.use("glass").box({-60, -60, 0}, {60, 60, 0.5});
        build.use("water").box({-59, -59, -0.5}, {59, 59, water_end});
        build.use("lamp").polygon({{edge, -50, -2}, {50, -50, -2}, {50, 50, -2}, {edge, 50, -2}});
        look_at_point({0, 0, 5}, {0, 0, -2});
        options.transport.min_contribution = 0;
        options.sampling.spp = 256;
    }

    /// Looks at the glass where x = 0, at 45 degrees.
    void look_askew() {
        const double sine = std::sqrt(0.5);
        look_at_point({-3 * sine, 0, 0.5 + 3 * sine}, {0, 0, 0.5});
    }
};

/// What a boundary passes of light head-on.
double passes(double first, double second) {
    return 1 - fresnel_reflectance(1, first / second);
}

/// How far a ray at 45 degrees goes on inside a layer of index n and of this thickness.
double shift(double n, double thickness) {
    return thickness * std::tan(std::asin(std::sqrt(0.5) / n));
}

} // namespace

TEST(Nested, WhereSolidsOverlapThereIsOneBoundary) {
    Aquarium overlapping("priority 2", "priority 1", 0.1);
    overlapping.options.transport.max_depth = 4; // no light that was reflected
    for (const Integrator integrator : ALL_THAT_NEST) {
        overlapping.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(overlapping.render().film),
                           passes(1, GLASS) * passes(GLASS, WATER) * passes(WATER, 1), 3e-2))
            << name_of(integrator);
    }
}

TEST(Nested, AGapOfAirIsThereWhateverThePriorities) {
    Aquarium apart("priority 2", "priority 1", -0.05);
    apart.options.transport.integrator = Integrator::WHITTED;
    apart.options.transport.max_depth = 5;
    const double both = passes(1, GLASS) * passes(WATER, 1);
    EXPECT_TRUE(agrees(film_estimate(apart.render().film), both * both, 1e-5, 1e-5));
}

TEST(Nested, TheSolidOfGreaterPriorityIsWhereBothAre) {
    // The boundary is where the weaker solid would go on: rays are shifted by as much of either layer.
    for (const auto& [glass, water, boundary] :
         {std::tuple{2, 1, 0.0}, {1, 2, 0.25}, {1, 1, 0.25}}) { // of equals the one entered last
        const double there = shift(GLASS, 0.5 - boundary) + shift(WATER, 0.5 + boundary) + 1.5;
        Aquarium scene(fmt::format("priority {}", glass), fmt::format("priority {}", water), 0.25, there);
        scene.look_askew();
        scene.options.transport.max_depth = 4;
        scene.options.transport.integrator = Integrator::WHITTED;
        const double cosine = std::sqrt(0.5), in_glass = std::sqrt(1 - 0.5 / (GLASS * GLASS)),
                     in_water = std::sqrt(1 - 0.5 / (WATER * WATER));
        const double passes_all = (1 - fresnel_reflectance(cosine, 1 / GLASS)) *
                                  (1 - fresnel_reflectance(in_glass, GLASS / WATER)) *
                                  (1 - fresnel_reflectance(in_water, WATER));
        SCOPED_TRACE(fmt::format("priorities {} and {}", glass, water));
        const Film film = scene.render().film;
        EXPECT_TRUE(agrees(film_estimate(film, 0, {0, 0, 7, 16}), 0, 1e-3, 1e-6));
        EXPECT_TRUE(
            agrees(film_estimate(film, 0, {9, 0, 16, 16}), passes_all, 1e-3, 4e-3)); // over half the view
    }
}

TEST(Nested, WhatIsThereAbsorbs) {
    const char* const grey = "attenuation 0.5 0.5 0.5\nattenuation_distance 0.5\n";
    const char* const blue = "attenuation 0.25 0.5 0.9\nattenuation_distance 0.5\n";
    // 0.5 of glass, then 0.5 of water.
    Aquarium scene(std::string("priority 2\n") + grey, std::string("priority 1\n") + blue, 0.3);
    scene.options.transport.max_depth = 4;
    const double bare = passes(1, GLASS) * passes(GLASS, WATER) * passes(WATER, 1);
    for (const Integrator integrator : ALL_THAT_NEST) {
        scene.options.transport.integrator = integrator;
        const Film film = scene.render().film;
        EXPECT_TRUE(agrees(film_estimate(film, 0), 0.5 * 0.25 * bare, 3e-2, 2e-3)) << name_of(integrator);
        EXPECT_TRUE(agrees(film_estimate(film, 2), 0.5 * 0.9 * bare, 3e-2, 2e-3)) << name_of(integrator);
    }
}

// A camera, a lamp and a matte floor below water, and between them a box of black glass.
TEST(Nested, WhatIsWithinAStrongerSolidIsNotSeenAndThrowsNoShadow) {
    const auto estimate = [](Integrator integrator, const std::string& box) {
        TestScene scene;
        scene.build.material("water", "Ni 1.33\nillum 7\npriority 2")
            .use("water")
            .box({-5, -1, -5}, {5, 4, 5});
        scene.build.material("white", "Kd 0.7 0.7 0.7").use("white").floor(3);
        scene.build.material("lamp", "Kd 0 0 0\nKe 6 6 6")
            .use("lamp")
            .polygon({{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}});
        scene.build.material("box", "Ni 1.5\nillum 7\nattenuation 0 0 0\n" + box).use("box");
        const double moved = box.empty() ? 100 : 0;
        scene.build.box({-0.7 + moved, 0.8, -0.7}, {0.7 + moved, 1.4, 0.7});
        scene.look({0, 1.5, 3}, {0, 0.3, 0}, 40);
        scene.options.sampling.spp = 64;
        scene.options.light.environment = glm::dvec3(0);
        scene.options.transport.integrator = integrator;
        return film_estimate(scene.render().film);
    };
    for (const Integrator integrator :
         {Integrator::RAYCAST, Integrator::WHITTED, Integrator::DISTRIBUTION, Integrator::PATH,
          Integrator::LIGHT, Integrator::PATH_LIGHT, Integrator::BDPT}) {
        const Estimate none = estimate(integrator, ""), weaker = estimate(integrator, "priority 1"),
                       stronger = estimate(integrator, "priority 3");
        EXPECT_NEAR(weaker.mean, none.mean, 5 * std::hypot(weaker.error, none.error)) << name_of(integrator);
        EXPECT_LT(stronger.mean, 0.8 * none.mean) << name_of(integrator) << " sees a box that is there";
    }
}

TEST(Nested, PathsFromBothEndsAgree) {
    TestScene scene;
    scene.build.material("honey", "Ni 1.4\nillum 7\nPr 0.5\npriority 1\nattenuation 0.4 0.6 0.3\n"
                                  "attenuation_distance 0.5\nabbe 20");
    scene.build.material("glass", "Ni 1.6\nillum 7\nPr 0.4\npriority 2");
    scene.build.material("floor", "Kd 0.6 0.6 0.6").material("lamp", "Kd 0 0 0\nKe 6 6 6");
    scene.build.use("honey").box({-0.5, 0.2, -0.5}, {0.5, 0.8, 0.5});
    scene.build.use("glass").box({-0.3, 0.5, -0.3}, {0.7, 1.1, 0.3});
    scene.build.use("floor").floor(3).use("lamp").polygon({{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}});
    scene.build.polygon(
        {{0.1, 0.3, 0.1}, {0.1, 0.3, -0.1}, {0.1, 0.5, -0.1}, {0.1, 0.5, 0.1}}); // within honey
    scene.look({0, 1.5, 3}, {0, 0.4, 0}, 40);
    scene.options.sampling.spp = 512;
    const Film path = scene.render().film;
    for (const Integrator integrator :
         {Integrator::BDPT, Integrator::PATH_LIGHT, Integrator::LIGHT, Integrator::MLT}) {
        scene.options.transport.integrator = integrator;
        expect_equal_means(path, scene.render().film, name_of(integrator));
    }
}

} // namespace clrt
