// SPDX-License-Identifier: Apache-2.0
// What the classic integrators trace: the tree of `whitted`, the single ray of `raycast`, and their
// highlights.
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Samples of a picture: its rays are these many times the rays of one.
std::uint64_t samples(const TestScene& scene) {
    return std::uint64_t(scene.options.film.size.x) * std::uint64_t(scene.options.film.size.y) *
           *scene.options.sampling.spp;
}

class TreeScene : public TestScene {
public:
    TreeScene() {
        options.transport.integrator = Integrator::WHITTED;
        options.sampling.spp = 64;
        options.transport.min_contribution = 0;
    }
};

/// Two facing mirrors that also shine, and the camera between them.
class FacingMirrors : public TreeScene {
public:
    explicit FacingMirrors(const std::string& keys) {
        build.material("mirror", "Kd 0 0 0\nillum 3\n" + keys).use("mirror");
        build.polygon({{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}});
        build.polygon({{-9, 9, 1}, {9, 9, 1}, {9, -9, 1}, {-9, -9, 1}});
        look_at_point({0, 0, 0.5}, {0, 0, -1});
    }
};

/// A floor that the camera and one point light see, both at 45 degrees and on opposite sides.
class LitFloor : public TreeScene {
public:
    explicit LitFloor(const std::string& keys) {
        build.material("m", keys).use("m").floor(9);
        options.light.points.push_back({{-1, 1, 0}, glm::dvec3(4)});
        look_at_point({1, 1, 0}, {0, 0, 0});
    }
    double irradiance() const { return 4 * std::sqrt(0.5) / 2; }
};

} // namespace

TEST(RayTree, MirrorsReflectUntilTheDepthLimit) {
    FacingMirrors scene("Ks 0.9 0.9 0.9\nKe 0.1 0.1 0.1");
    for (const int depth : {1, 2, 10, 64}) {
        scene.options.transport.max_depth = depth;
        const Render render = scene.render();
        EXPECT_EQ(render.counts.secondary, (depth - 1) * samples(scene));
        EXPECT_TRUE(agrees(film_estimate(render.film), 1 - std::pow(0.9, depth), 1e-5)) << depth;
    }
    scene.options.transport.max_depth.reset();
    EXPECT_EQ(scene.render().counts.secondary, 9 * samples(scene)) << "the default depth is 10";
}

TEST(RayTree, EveryRayOfADeepTreeHasRandomNumbersOfItsOwn) {
    // A screen that lets 98 % pass stands between the mirrors: the ray of segment k exists with chance 0.98^k
    // where its crossings are independent of each other, and with more where two of them share a number.
    FacingMirrors scene("Ks 1 1 1\nKe 0.01 0.01 0.01");
    scene.build.material("screen", "Kd 0 0 0\nd 0.02").use("screen");
    scene.build.polygon({{-9, -9, 0.25}, {9, -9, 0.25}, {9, 9, 0.25}, {-9, 9, 0.25}});
    scene.options.sampling.spp = 256;
    for (const int depth : {28, 64}) {
        scene.options.transport.max_depth = depth;
        const double expected = 0.01 * 0.98 * (1 - std::pow(0.98, depth)) / (1 - 0.98);
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), expected, 4e-3)) << depth;
    }
}

TEST(RayTree, LongPathsBetweenMirrorsLoseNoLight) {
    FacingMirrors scene("Ks 0.999 0.999 0.999\nKe 0.001 0.001 0.001");
    scene.options.transport.integrator = Integrator::PATH;
    scene.options.transport.roulette_depth = 65535;
    scene.options.transport.max_depth = 1000;
    EXPECT_TRUE(agrees(film_estimate(scene.render().film), 1 - std::pow(0.999, 1000), 1e-5, 1e-4));
}

TEST(RayTree, SmallContributionsAreNotFollowed) {
    FacingMirrors scene("Ks 0.5 0.5 0.25\nKe 1 1 1");
    for (const auto& [smallest, rays] : {std::pair{0.1, 3u}, {0.5, 1u}, {0.51, 0u}, {0.002, 8u}}) {
        scene.options.transport.min_contribution = smallest;
        const Render render = scene.render();
        EXPECT_EQ(render.counts.secondary, rays * samples(scene)) << smallest;
        EXPECT_TRUE(agrees(film_estimate(render.film), 2 - std::pow(0.5, rays), 1e-5)) << smallest;
    }
}

TEST(RayTree, GlassBranchesAtEverySurface) {
    TreeScene scene;
    scene.build.material("glass", "Ni 1.5\nillum 7").use("glass").box({-60, -60, -0.5}, {60, 60, 0.5});
    scene.options.light.environment = glm::dvec3(1);
    scene.look_at_point({0, 0, 5}, {0, 0, 0});
    for (const int depth : {2, 3, 7}) {
        scene.options.transport.max_depth = depth;
        const Render render = scene.render();
        // Of the two rays at each level one leaves the slab for good.
        EXPECT_EQ(render.counts.secondary, 2 * (depth - 1) * samples(scene)) << depth;
    }
}

TEST(RayTree, TheTreeEndsAtMatteSurfaces) {
    LitFloor scene("Kd 0.5 0.5 0.5");
    const Render render = scene.render();
    EXPECT_EQ(render.counts.primary, samples(scene));
    EXPECT_EQ(render.counts.secondary, 0u);
    EXPECT_EQ(render.counts.shadow, samples(scene));
}

TEST(RayTree, EveryLightGetsOneShadowRay) {
    // All emissive triangles together are one light, so is the sky; every point and sun is one.
    LitFloor scene("Kd 0.5 0.5 0.5");
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").use("lamp");
    scene.build.polygon({{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}});
    scene.options.light.points.push_back({{0, 2, 1}, glm::dvec3(1)});
    scene.options.light.suns.push_back({{0, 1, 0}, glm::dvec3(1), 0});
    scene.options.light.environment = glm::dvec3(1);
    for (const Integrator integrator : {Integrator::WHITTED, Integrator::RAYCAST}) {
        scene.options.transport.integrator = integrator;
        EXPECT_EQ(scene.render().counts.shadow, 5 * samples(scene)) << name_of(integrator);
    }
    scene.options.transport.integrator = Integrator::PATH;
    scene.options.transport.max_depth = 2;
    EXPECT_LE(scene.render().counts.shadow, samples(scene)) << "a path's vertex connects to one light";
}

TEST(RayTree, RayCastingNeverTracesASecondaryRay) {
    TreeScene scene;
    scene.build.material("mirror", "Kd 0.1 0.1 0.1\nKs 0.9 0.9 0.9\nillum 3")
        .material("glass", "Ni 1.5\nillum 7");
    scene.build.use("mirror").floor(9).use("glass").icosphere({0, 1, 0}, 0.8, 1);
    scene.options.light.points.push_back({{-1, 4, 0}, glm::dvec3(4)});
    scene.look({0, 3, 5}, {0, 0, 0}, 60);
    scene.options.transport.max_depth = 10;
    EXPECT_GT(scene.render().counts.secondary, 0u);
    scene.options.transport.integrator = Integrator::RAYCAST;
    const Render render = scene.render();
    EXPECT_EQ(render.counts.secondary, 0u);
    EXPECT_GT(render.counts.shadow, 0u);
    EXPECT_LE(render.counts.shadow, samples(scene));
}

TEST(RayTree, WithoutMirrorsAndGlassItIsRayCasting) {
    LitFloor scene("Kd 0.5 0.4 0.3\nKs 0.2 0.2 0.2\nNs 12");
    scene.build.icosphere({-0.4, 0.5, 0}, 0.3, 1);
    scene.look({3, 4, 5}, {0, 0, 0}, 20);
    const Film tree = scene.render().film;
    scene.options.transport.integrator = Integrator::RAYCAST;
    EXPECT_EQ(tree.sums, scene.render().film.sums);
}

TEST(RayTree, InAMirrorItEqualsPathsOfThreeSegments) {
    // Eye, mirror, matte wall, light: the only paths that three segments and a point light allow.
    TreeScene scene;
    scene.build.material("mirror", "Kd 0 0 0\nKs 0.8 0.7 0.6\nillum 3").material("matte", "Kd 0.5 0.5 0.5");
    scene.build.use("mirror").floor(9).use("matte").polygon(
        {{-2, 0.1, -2}, {2, 0.1, -2}, {2, 3, -2}, {-2, 3, -2}});
    scene.options.light.points.push_back({{1, 2, 0}, glm::dvec3(4)});
    scene.options.transport.max_depth = 3;
    scene.look({0, 1, 2}, {0, 0, 0}, 20);
    const Film tree = scene.render().film;
    scene.options.transport.integrator = Integrator::PATH;
    const Film path = scene.render().film;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            EXPECT_GT(film_pixel(tree, x, y).x, 0);
            EXPECT_NEAR(film_pixel(tree, x, y).x, film_pixel(path, x, y).x, 1e-5);
        }
}

TEST(RayTree, TheHighlightIsPhongs) {
    // Straight in the mirror direction: Ks (Ns + 2) / (2 pi).
    for (const Integrator integrator : {Integrator::WHITTED, Integrator::RAYCAST}) {
        LitFloor scene("Kd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 20\nillum 2");
        scene.options.transport.integrator = integrator;
        const double straight = (0.3 / PI + 0.5 * 22 / (2 * PI)) * scene.irradiance();
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), straight, 1e-3, 1e-4)) << name_of(integrator);

        // 20 degrees off: times cos^Ns.
        const double angle = 25 * PI / 180;
        scene.look_at_point({2 * std::sin(angle), 2 * std::cos(angle), 0}, {0, 0, 0});
        const double lobe = 0.5 * 22 / (2 * PI) * std::pow(std::cos(20 * PI / 180), 20);
        EXPECT_TRUE(
            agrees(film_estimate(scene.render().film), (0.3 / PI + lobe) * scene.irradiance(), 1e-3, 1e-4))
            << name_of(integrator);
    }
}

TEST(RayTree, AReflectionThatIsFollowedHasNoHighlight) {
    // illum 3: whitted sends a ray instead, which finds no light; raycast, which cannot, shows the highlight.
    LitFloor scene("Kd 0 0 0\nKs 0.5 0.5 0.5\nNs 20\nillum 3");
    const Render tree = scene.render();
    EXPECT_EQ(film_estimate(tree.film).mean, 0);
    EXPECT_EQ(tree.counts.secondary, samples(scene));
    scene.options.transport.integrator = Integrator::RAYCAST;
    EXPECT_TRUE(
        agrees(film_estimate(scene.render().film), 0.5 * 22 / (2 * PI) * scene.irradiance(), 1e-3, 1e-4));
}

TEST(RayTree, DepthOneSeesOnlyLamps) {
    LitFloor scene("Kd 0.5 0.5 0.5\nKe 0.25 0.25 0.25");
    scene.options.transport.max_depth = 1;
    for (const Integrator integrator : {Integrator::WHITTED, Integrator::PATH}) {
        scene.options.transport.integrator = integrator;
        const Render render = scene.render();
        EXPECT_TRUE(agrees(film_estimate(render.film), 0.25, 1e-6)) << name_of(integrator);
        EXPECT_EQ(render.counts.shadow + render.counts.secondary, 0u) << name_of(integrator);
    }
}

} // namespace clrt
