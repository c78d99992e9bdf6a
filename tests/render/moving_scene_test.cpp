// SPDX-License-Identifier: Apache-2.0
// Scenes that move while the shutter is open: the same bits by every tree, no light through closed surfaces,
// and the picture is the mean of those of its moments.
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A scene that is built at both ends of its way.
class MovingScene : public TestScene {
public:
    /// `make` builds the scene at a time.
    explicit MovingScene(const std::function<void(SceneBuilder&, double)>& make) {
        make(build, 0);
        SceneBuilder at_end;
        make(at_end, 1);
        options.scene.end_path = folder.write("end.obj", at_end.obj("scene.mtl"));
    }
};

/// A square of radiance 1 (a screen's hole to a white sky would do as well): 4 x 4 units, moved by `way`.
void add_square(SceneBuilder& build, double way) {
    build.material("black", "Kd 0 0 0").use("black");
    build.polygon({{-2 + way, -2, 0}, {2 + way, -2, 0}, {2 + way, 2, 0}, {-2 + way, 2, 0}});
}

/// A ball that rolls over a floor past a box, and is squeezed on its way.
void add_ball(SceneBuilder& build, double time) {
    build.material("floor", "Kd 0.7 0.6 0.5")
        .material("ball", "Kd 0.3 0.5 0.8\nKs 0.3 0.3 0.3\nNs 40\nillum 2");
    build.material("lamp", "Kd 0 0 0\nKe 6 5 4").use("floor").floor(3);
    build.box({0.6, 0.01, -0.9}, {1.1, 0.8, -0.4});
    build.use("ball").icosphere({-0.7 + 1.1 * time, 0.5 + 0.2 * time, 0}, 0.45 - 0.1 * time, 2,
                                Facing::OUTWARD, Shading::SMOOTH);
    build.use("lamp").polygon({{-1, 2.5, -1}, {1, 2.5, -1}, {1, 2.5, 1}, {-1, 2.5, 1}});
}

} // namespace

TEST(MovingScene, EdgesBlurAsTheirCoverageSays) {
    // A black square before a white sky, a unit a pixel, that moves by 3.5 of them.
    constexpr int SIDE = 16, STEPS = 20000;
    constexpr double WAY = 3.5;
    for (const BvhLayout layout : ALL_LAYOUTS) {
        MovingScene scene([](SceneBuilder& build, double time) { add_square(build, WAY * time); });
        scene.options.camera.eye = glm::dvec3(0, 0, 5);
        scene.options.camera.at = glm::dvec3(0);
        scene.options.camera.projection = PROJECTION_ORTHOGRAPHIC;
        scene.options.camera.ortho_height = SIDE;
        scene.options.light.environment = glm::dvec3(1);
        scene.options.transport.max_depth = 1;
        scene.options.sampling.spp = 1024;
        scene.options.bvh.layout = layout;
        const Film film = scene.render().film;
        for (int x = 0; x < SIDE; ++x) {
            double shown = 0;
            for (int i = 0; i < STEPS; ++i) {
                const double left = -2 + WAY * (i + 0.5) / STEPS, pixel = x - SIDE / 2;
                shown += std::max(0.0, std::min(pixel + 1, left + 4) - std::max(pixel, left)) / STEPS;
            }
            const Estimate found = film_estimate(film, 0, {x, 7, x + 1, 8});
            EXPECT_NEAR(found.mean, 1 - shown, 6 * found.error + 2e-3) << x << " " << name_of(layout);
        }
    }
}

TEST(MovingScene, EveryTreeGivesTheSameBits) {
    MovingScene scene(add_ball);
    scene.look({0.3, 1.6, 3.5}, {0, 0.5, 0}, 45);
    scene.options.sampling.spp = 64;
    const auto render = [&](BvhLayout layout, BvhQuality quality, bool all) {
        scene.options.bvh.layout = layout;
        scene.options.bvh.quality = quality;
        scene.options.effects.all = all;
        const Render render = scene.render();
        EXPECT_EQ(render.counts.bad(), 0u);
        return render.film.sums;
    };
    const auto expected = render(BvhLayout::BVH8, BvhQuality::FAST, true);
    for (const BvhLayout layout : ALL_LAYOUTS) {
        EXPECT_EQ(render(layout, BvhQuality::HIGH, true), expected) << name_of(layout);
        EXPECT_EQ(render(layout, BvhQuality::FAST, false), expected) << name_of(layout);
    }
}

TEST(MovingScene, ThePictureIsTheMeanOfItsMoments) {
    // Shadows, gloss and normals included: a moment is a scene that stands still.
    constexpr int MOMENTS = 16, SIDE = 16, TILE = 4;
    for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED}) {
        MovingScene scene(add_ball);
        scene.look({0.3, 1.6, 3.5}, {0, 0.5, 0}, 45);
        scene.options.transport.integrator = integrator;
        scene.options.transport.max_depth = 3;
        scene.options.sampling.spp = 4096;
        const Film whole = scene.render().film;
        std::vector<Film> moments;
        for (int i = 0; i < MOMENTS; ++i) {
            // The midpoint rule: the radiance of a tile is smooth enough in time for 16 of them.
            scene.options.camera.shutter = glm::dvec2((i + 0.5) / MOMENTS);
            scene.options.sampling.spp = 512;
            scene.options.sampling.seed = u32(1 + i);
            moments.push_back(scene.render().film);
        }
        for (int y = 0; y < SIDE; y += TILE)
            for (int x = 0; x < SIDE; x += TILE) {
                const Crop tile{x, y, x + TILE, y + TILE};
                const Estimate found = film_estimate(whole, 1, tile);
                double expected = 0, variance = 0;
                for (const Film& film : moments) {
                    const Estimate moment = film_estimate(film, 1, tile);
                    expected += moment.mean / MOMENTS;
                    variance += moment.error * moment.error / (MOMENTS * MOMENTS);
                }
                EXPECT_NEAR(found.mean, expected,
                            6 * std::hypot(found.error, std::sqrt(variance)) + 2e-3 * expected)
                    << name_of(integrator) << " " << x << " " << y;
            }
    }
}

TEST(MovingScene, NormalsTurnWithTime) {
    // A wall that stands still before a sun, whose normals turn by 60 degrees.
    MovingScene scene([](SceneBuilder& build, double time) {
        build.material("wall", "Kd 0.5 0.5 0.5").use("wall");
        const glm::dvec3 n = time == 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(std::sqrt(0.75), 0, 0.5);
        build.raw("v -9 -9 0\nv 9 -9 0\nv 0 9 0\nvn " + std::to_string(n.x) + " 0 " + std::to_string(n.z) +
                  "\nf -3//-1 -2//-1 -1//-1");
    });
    scene.look_at_point({0, 0, 5}, {0, 0, 0});
    scene.options.light.environment = glm::dvec3(0);
    scene.options.light.suns.push_back({{0, 0, 1}, glm::dvec3(1), 0});
    constexpr int MOMENTS = 64;
    const Estimate turning = film_estimate(scene.render().film);
    scene.options.sampling.spp = 64;
    double expected = 0, last = 0;
    for (int i = 0; i < MOMENTS; ++i) {
        scene.options.camera.shutter = glm::dvec2((i + 0.5) / MOMENTS);
        last = film_estimate(scene.render().film).mean;
        expected += last / MOMENTS;
    }
    EXPECT_LT(last, 0.7 * expected) << "the normals turn from the sun";
    EXPECT_TRUE(agrees(turning, expected, 2e-3, 1e-4));
}

TEST(MovingScene, NoLightLeavesAClosedSurfaceThatMoves) {
    // A lamp within a ball that grows, turns and flies: nothing outside, at any time, in any tree.
    const auto make = [](SceneBuilder& build, double time) {
        build.material("shell", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 9 9 9");
        build.use("shell").icosphere({0.6 * time - 0.3, 0.2 * time, 0.1}, 1 + 0.37 * time, 3);
        build.use("lamp").box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1});
    };
    for (const BvhLayout layout : ALL_LAYOUTS) {
        MovingScene scene(make);
        scene.look({0, 0.4, 4}, {0, 0, 0}, 45);
        scene.options.light.environment = glm::dvec3(0);
        scene.options.film.size = {64, 64};
        scene.options.sampling.spp = 256;
        scene.options.bvh.layout = layout;
        const Film film = scene.render().film;
        EXPECT_EQ(std::count_if(film.sums.begin(), film.sums.end(), [](auto sum) { return sum != 0; }), 0)
            << name_of(layout);
    }
}

TEST(MovingScene, AClosedShutterHasTheBitsOfTheSceneOfItsMoment) {
    for (const double time : {0.0, 1.0}) {
        MovingScene moving(add_ball);
        moving.look({0.3, 1.6, 3.5}, {0, 0.5, 0}, 45);
        moving.options.camera.shutter = glm::dvec2(time);
        moving.options.sampling.spp = 64;
        TestScene still;
        add_ball(still.build, time);
        still.options = moving.options;
        still.options.scene.end_path.clear();
        still.options.camera.shutter.reset();
        EXPECT_EQ(moving.render().film.sums, still.render().film.sums) << time;
    }
}

TEST(MovingScene, DoublePrecisionAgrees) {
    MovingScene scene(add_ball);
    scene.look({0.3, 1.6, 3.5}, {0, 0.5, 0}, 45);
    scene.options.camera.aperture = 0.1;
    scene.options.camera.end_eye = glm::dvec3(0.4, 1.7, 3.4);
    scene.options.sampling.spp = 64;
    scene.options.sampling.replicates = 8;
    scene.options.transport.max_depth = 2;
    const Film single = scene.render().film;
    scene.options.device.precision = Precision::DOUBLE;
    const Film exact = scene.render().film;
    size_t different = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            different += glm::length(film_pixel(single, x, y) - film_pixel(exact, x, y)) >
                         1e-4 * glm::length(film_pixel(exact, x, y)) + 1e-5;
    EXPECT_LE(different, 26u)
        << "a tenth of the pixels may have a sample that falls on the other side of an edge";
}

} // namespace clrt
