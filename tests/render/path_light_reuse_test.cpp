// SPDX-License-Identifier: Apache-2.0
// Path reuse beside light paths (path+light): what a path finds that splats may find, too, has a weight that
// depends on its first vertex and stays its own pixel's; all else serves others.
#include "render/pilot.h"
#include "render/reuse_choice.h"
#include "support/choice_box.h"
#include "support/drawn.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"
#include "support/with_reuse.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// The inside of a room, of one tile: thin poles close to the camera before a far wall, so that splats reach
/// pixels side by side with densities that differ a hundredfold.
struct TwoDepths : TestScene {
    TwoDepths() {
        build.material("white", "Kd 0.8 0.8 0.8")
            .material("lamp", "Kd 0 0 0\nKe 60 60 60")
            .material("glass", "Kd 0 0 0\nKs 1 1 1\nTf 1 1 1\nNi 1.5\nillum 7")
            .material("polished", "Kd 0.1 0.1 0.1\nPm 0.8\nPr 0.25")
            .material("lacquer", "Kd 0.7 0.6 0.5\nKs 0.2 0.2 0.2\nNs 300\nillum 2")
            .use("white");
        constexpr double COLUMN = 0.0577; // of pixels, where the poles are
        for (int pole = -2; pole < 2; ++pole)
            build.box({2 * pole * COLUMN, 0.5, 1.25}, {(2 * pole + 1) * COLUMN, 1.5, 1.3});
        look({0, 1, 1.7}, {0, 1, 0}, 60);
        options.effects.all = false;
        options.transport.integrator = Integrator::PATH_LIGHT;
        options.film.size = {8, 8};
        options.sampling.spp = 8192;
    }
    void add_walls(const char* material) {
        build.use(material).box({-2, 0, -2}, {2, 2.5, 2.5}, Facing::INWARD);
    }
    void add_lamp() {
        build.use("lamp").polygon({{-0.2, 2.45, 1.9}, {0.2, 2.45, 1.9}, {0.2, 2.45, 2.3}, {-0.2, 2.45, 2.3}});
    }
    void expect_same_pixels(Toggle guide = Toggle::OFF) {
        const std::pair<Film, Film> films = both_ways(*this, guide);
        EXPECT_LT(mean_square_z(films), LARGEST_MEAN_SQUARE_Z_OF_A_TILE);
        expect_equal_means(films.first, films.second, "all");
    }
};

/// A room that a sun of such a diameter shines into, and a gem on its floor.
struct SunlitRoom : TestScene {
    explicit SunlitRoom(double sun_degrees) {
        build.material("white", "Kd 0.75 0.75 0.75").use("white").floor(2);
        build.polygon({{-2, 0, -2}, {2, 0, -2}, {2, 2.5, -2}, {-2, 2.5, -2}});
        build.polygon({{-2, 0, 2}, {-2, 2.5, 2}, {2, 2.5, 2}, {2, 0, 2}});
        build.polygon({{-2, 0, -2}, {-2, 2.5, -2}, {-2, 2.5, 2}, {-2, 0, 2}});
        build.polygon({{-2, 2.5, -2}, {1, 2.5, -2}, {1, 2.5, 2}, {-2, 2.5, 2}});
        build.material("gem", "Kd 0 0 0\nKs 1 1 1\nTf 1 1 1\nNi 1.7\nillum 7").use("gem");
        build.box({0.8, 0.01, 0}, {1.2, 0.4, 0.4});
        look({0, 1.2, 1.9}, {-0.6, 1, -2}, 80);
        options.light.suns = {{{1, 1, 0.1}, {9, 9, 8}, sun_degrees}};
        options.effects.all = false;
        options.transport.integrator = Integrator::PATH_LIGHT;
        options.transport.guide = Toggle::OFF;
        options.film.size = {48, 48};
        options.sampling.spp = 64;
    }
};

} // namespace

TEST(PathLightReuse, ChangesNoMeanUnderAnyLight) {
    for (const Lighting& lighting : drawn(lightings(), 2)) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.add_hidden_mirrors();
        room.options.sampling.spp = 256;
        expect_same_light(room, Integrator::PATH_LIGHT);
    }
}

// All light is caustics, also by way of a second wall: a lamp in a ball of glass.
TEST(PathLightReuse, ChangesNoMeanAroundAGlassBall) {
    TwoDepths room;
    room.add_walls("white");
    room.build.use("lamp").box({-0.1, 2, 2}, {0.1, 2.1, 2.1});
    room.build.use("glass").icosphere({0, 2.05, 2.05}, 0.3, 3, Facing::OUTWARD, Shading::SMOOTH);
    room.options.sampling.spp = 4096;
    room.expect_same_pixels();
}

// Splats compete with connections to second vertices,
TEST(PathLightReuse, ChangesNoMeanBetweenSharpWalls) {
    TwoDepths room;
    room.add_walls("lacquer");
    room.add_lamp();
    room.options.sampling.spp = 2048;
    room.expect_same_pixels();
}

// and to those behind them.
TEST(PathLightReuse, ChangesNoMeanBesideSharpMetal) {
    TwoDepths room;
    room.add_walls("white");
    room.add_lamp();
    room.build.use("polished").box({-1.9, 0.1, -1}, {-1.8, 2.4, 2.4}).box({-1, 0.01, 1.8}, {1, 0.1, 2.4});
    room.expect_same_pixels(Toggle::ON);
}

// A bell of glass over two walls: the sun, met behind it, shines at the one that is not seen.
TEST(PathLightReuse, ChangesNoMeanUnderABellOfGlass) {
    TwoDepths room;
    room.build.use("white").floor(2).polygon({{-2, 0, -2}, {2, 0, -2}, {2, 2.5, -2}, {-2, 2.5, -2}});
    room.build.polygon({{-2, 0, 2.4}, {-2, 2, 2.4}, {2, 2, 2.4}, {2, 0, 2.4}});
    room.build.use("glass").icosphere({0, 1, 0}, 5, 3, Facing::OUTWARD, Shading::SMOOTH);
    room.build.icosphere({0, 1, 0}, 4.5, 3, Facing::INWARD, Shading::SMOOTH);
    room.options.light.environment = glm::dvec3(0.02);
    room.options.light.suns = {{{0.1, 1, -0.9}, {3, 3, 3}, 10}};
    room.options.transport.max_depth = 8;
    room.expect_same_pixels();
}

TEST(PathLightReuse, LowersNoiseInARoomWithACaustic) {
    SunlitRoom room(0.5);
    const Cost alone(room, Toggle::OFF), reusing(room, Toggle::ON);
    EXPECT_LT(reusing.cost, 0.6 * alone.cost);
    EXPECT_EQ(reusing.render.counts.bad(), 0u);
}

// Whatever of both finds light, path+light reuses what it finds by paths from the eye.
TEST(PathLightReuse, IsChosenWherePathDoesNotSeeTheCaustic) {
    for (const Toggle asked : {Toggle::AUTO, Toggle::ON}) {
        SunlitRoom room(0);
        room.options.film.size = {96, 72};
        room.options.transport.choose = Toggle::AUTO;
        room.options.transport.path_reuse = asked;
        Chosen chosen = choose(room);
        EXPECT_EQ(chosen.choice.integrator, Integrator::PATH_LIGHT) << chosen.choice.reason;
        Progress silent(Toggle::OFF, true);
        choose_path_reuse(test_device(), chosen.planned, chosen.parts, silent);
        EXPECT_EQ(chosen.planned->options.transport.path_reuse, Toggle::ON);
    }
}

TEST(PathLightReuse, ProgramsThatCanDoWithoutTakeTheSameSamples) {
    TwoDepths room;
    room.add_walls("white");
    room.add_lamp();
    const auto planned = plan_loaded(test_device(), room.load(), room.options);
    const PilotSize size = in_tiles({8, 8, 64});
    PreparedParts parts;
    const PreparedScene able = prepare_path_pilot(test_device(), planned, parts);
    const PathPilot without = run_path_pilot(able, size), with = run_path_pilot(able, size, true);
    planned->options.transport.path_reuse = Toggle::OFF;
    const PathPilot unable = run_path_pilot(prepare_path_pilot(test_device(), planned, parts), size);
    EXPECT_EQ(without.errors, unable.errors);
    EXPECT_EQ(without.rays, unable.rays);
    EXPECT_GT(with.rays, unable.rays);
}

} // namespace clrt
