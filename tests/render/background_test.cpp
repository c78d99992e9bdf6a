// SPDX-License-Identifier: Apache-2.0
// A background is what the camera sees where it hits nothing, and nothing else: it lights nothing, no mirror
// shows it, no integrator and no layer differs about it.
#include "film/film_identity.h"
#include "probes/film_estimate.h"
#include "render/render_params.h"
#include "support/render_scene.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace clrt {

namespace {

const Integrator INTEGRATORS[] = {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED,
                                  Integrator::RAYCAST};

/// A square that fills the middle of the picture, under a sky and a sun with a disc behind it.
class SquareBeforeSky : public TestScene {
public:
    explicit SquareBeforeSky(const std::string& keys = "Kd 0.5 0.5 0.5") {
        build.material("square", keys).use("square");
        build.polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
        options.light.environment = glm::dvec3(0.7, 0.8, 0.9);
        options.light.suns.push_back({{0, 0, -1}, {1, 1, 1}, 60});
        options.sampling.spp = 64;
        options.sampling.replicates = 8;
        look({0, 0, 4}, {0, 0, 0}, 60); // 16 pixels see 4.6 units
    }
    void background(const glm::dvec3& radiance) {
        options.light.background = BackgroundOptions{radiance, false};
    }
};

/// Whether a pixel sees nothing but the square, or nothing of it.
enum class Sees { SQUARE, BOTH, NOTHING };
Sees what_is_seen(int x, int y) {
    const int off = std::max(std::abs(2 * x - 15), std::abs(2 * y - 15));
    return off < 6 ? Sees::SQUARE : off > 8 ? Sees::NOTHING : Sees::BOTH;
}

} // namespace

TEST(Background, TheCameraSeesItAndNothingElseDoes) {
    for (const Integrator integrator : INTEGRATORS) {
        SquareBeforeSky scene;
        scene.options.transport.integrator = integrator;
        const Render without = scene.render();
        scene.background({3, 0.25, 0});
        const Render with = scene.render();
        int seen = 0;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) {
                if (what_is_seen(x, y) == Sees::NOTHING) {
                    EXPECT_EQ(film_pixel(with.film, x, y), glm::dvec3(3, 0.25, 0)) << x << "," << y;
                    ++seen;
                } else if (what_is_seen(x, y) == Sees::SQUARE) {
                    EXPECT_EQ(film_pixel(with.film, x, y), film_pixel(without.film, x, y)) << x << "," << y;
                }
            }
        EXPECT_GT(seen, 50);
    }
}

TEST(Background, MirrorsShowTheSky) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::WHITTED}) {
        SquareBeforeSky scene("Ks 1 1 1\nillum 3");
        scene.options.transport.integrator = integrator;
        scene.background({3, 0.25, 0});
        const Render render = scene.render();
        EXPECT_NEAR(film_pixel(render.film, 7, 7).x, 0.7, 1e-5);
    }
}

TEST(Background, ItLightsAFurnaceByNothing) {
    // A white ball, closed and open to the background alone: whatever it scatters, nothing comes.
    for (const Integrator integrator : INTEGRATORS) {
        TestScene scene;
        scene.build.material("white", "Kd 1 1 1").use("white").icosphere({0, 0, 0}, 1, 2);
        scene.options.light.environment = glm::dvec3(0);
        scene.options.light.background = BackgroundOptions{{5, 5, 5}, false};
        scene.options.transport.integrator = integrator;
        scene.options.sampling.spp = 64;
        scene.options.sampling.replicates = 8;
        scene.look({0, 0, 5}, {0, 0, 0}, 60);
        const Render render = scene.render();
        EXPECT_EQ(film_pixel(render.film, 7, 8), glm::dvec3(0));
        EXPECT_EQ(film_pixel(render.film, 0, 0), glm::dvec3(5));
    }
}

TEST(Background, ABlackOneHidesSkyAndSun) {
    SquareBeforeSky scene;
    scene.background({0, 0, 0});
    EXPECT_EQ(film_pixel(scene.render().film, 0, 8), glm::dvec3(0));
    EXPECT_EQ(film_pixel(scene.render().film, 3, 8), glm::dvec3(0)) << "before the sun";
}

TEST(Background, CutOutsAreSeenThrough) {
    SquareBeforeSky scene("Kd 0.5 0.5 0.5\nd 0");
    scene.background({3, 0.25, 0});
    EXPECT_EQ(film_pixel(scene.render().film, 7, 7), glm::dvec3(3, 0.25, 0));
}

TEST(Background, IsOfTheSkysPaths) {
    SquareBeforeSky scene;
    scene.background({3, 0.25, 0});
    scene.options.output.path_layers = {{"sky", "LeE"}, {"sun", "LdE"}, {"lit", "LD.*E|LD+E"}};
    const Render render = scene.render();
    ASSERT_EQ(render.path_layers.size(), 3u);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            if (what_is_seen(x, y) == Sees::NOTHING) {
                EXPECT_EQ(film_pixel(render.path_layers[0], x, y), glm::dvec3(3, 0.25, 0));
                EXPECT_EQ(film_pixel(render.path_layers[1], x, y), glm::dvec3(0));
            }
    scene.options.output.path_layers.clear();
    scene.options.transport.paths = "LdE";
    EXPECT_EQ(film_pixel(scene.render().film, 0, 0), glm::dvec3(0));
}

TEST(Background, ChangesNoBitWhereEffectsAreCompiledOut) {
    const std::function<void(SquareBeforeSky&)> cases[] = {
        [](SquareBeforeSky&) {},
        [](SquareBeforeSky& s) {
            s.background({3, 0.25, 0});
        },
        [](SquareBeforeSky& s) {
            s.background({0, 0, 0});
        },
        [](SquareBeforeSky& s) {
            s.options.light.environment = glm::dvec3(0);
            s.background({3, 0.25, 0});
        },
        [](SquareBeforeSky& s) {
            s.options.light.environment = glm::dvec3(0);
            s.options.light.suns.clear();
            s.background({0, 0, 0});
        },
    };
    for (const auto& change : cases)
        for (const Integrator integrator : INTEGRATORS) {
            SquareBeforeSky scene;
            change(scene);
            scene.options.transport.integrator = integrator;
            const Render full = scene.render();
            scene.options.effects.all = false;
            EXPECT_EQ(scene.render().film.sums, full.film.sums);
        }
}

TEST(Background, IsBlackWithoutTheEnvironmentsEffect) {
    SquareBeforeSky scene;
    scene.background({3, 0.25, 0});
    scene.options.effects.off = EFFECT_ENVIRONMENT;
    EXPECT_EQ(film_pixel(scene.render().film, 0, 0), glm::dvec3(0));
}

TEST(Background, FilmsTellTheirBackgrounds) {
    SquareBeforeSky scene;
    const auto background = [&] {
        const Scene loaded = scene.load();
        const RenderParams params = make_render_params(loaded, scene.options, {1, 2});
        return film_identity(loaded, scene.options, params, {1, 2}).at("background").dump();
    };
    EXPECT_EQ(background(), "\"sky\"");
    scene.background({0, 0, 0});
    EXPECT_EQ(background(), "[0.0,0.0,0.0]");
    scene.options.light.background->is_transparent = true;
    EXPECT_EQ(background(), "\"transparent\"");
}

} // namespace clrt
