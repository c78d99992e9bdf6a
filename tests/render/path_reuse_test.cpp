// SPDX-License-Identifier: Apache-2.0
// Path reuse: what a path has found behind its second vertex serves other pixels. The light stays the same in
// every tile, under every kind of light and on every kind of surface; the noise of light that comes by
// detours falls; and it is chosen where that pays.
#include "error.h"
#include "film/film_error.h"
#include "render/pilot.h"
#include "render/reuse_choice.h"
#include "support/adjoining_rooms.h"
#include "support/drawn.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"
#include "support/with_reuse.h"

#include <gtest/gtest.h>
#include <utility>

namespace clrt {

namespace {

/// A closed room with a lamp, or the same floor in the open.
struct Lit : TestScene {
    explicit Lit(bool has_walls) {
        build.material("white", "Kd 0.75 0.75 0.75").material("lamp", "Kd 0 0 0\nKe 9 9 9").use("white");
        build.floor(2);
        if (has_walls)
            build.box({-2, -0.1, -2}, {2, 2.5, 2}, Facing::INWARD);
        build.use("lamp").polygon({{-1, 2.4, -1}, {0, 2.4, -1}, {0, 2.4, 0}, {-1, 2.4, 0}});
        look({1.8, 1.6, 1.8}, {0, 0.8, 0}, 60);
        options.film.size = {96, 72};
        options.sampling.spp = 64;
        options.effects.all = false;
    }
    /// What is chosen.
    Toggle chosen() {
        planned = plan_loaded(test_device(), load(), options);
        Progress silent(Toggle::OFF, true);
        parts = {};
        choose_path_reuse(test_device(), planned, parts, silent);
        return planned->options.transport.path_reuse;
    }
    std::shared_ptr<PlannedScene> planned;
    PreparedParts parts;
};

/// A closed room with dim mirrors on parts of two walls that see each other.
struct MirrorRoom : Lit {
    MirrorRoom() : Lit(true) {
        build.material("mirror", "Kd 0 0 0\nKs 0.3 0.25 0.2\nillum 3").use("mirror");
        build.polygon({{-1.9, 0.3, -1.95}, {0.4, 0.3, -1.95}, {0.4, 2.2, -1.95}, {-1.9, 2.2, -1.95}});
        build.polygon({{-1.95, 0.3, -1.9}, {-1.95, 2.2, -1.9}, {-1.95, 2.2, 0.4}, {-1.95, 0.3, 0.4}});
    }
};

/// A closed room of one material with a lamp, before a dark wall and a bright one.
struct GlossyRoom : TestScene {
    explicit GlossyRoom(const char* material) {
        build.material("gloss", material).material("lamp", "Kd 0 0 0\nKe 9 9 9").use("gloss");
        build.box({-2, 0, -2}, {2, 2.5, 2}, Facing::INWARD);
        build.material("dark", "Kd 0.02 0.05 0.1").material("bright", "Kd 0.9 0.8 0.7").use("dark");
        build.polygon({{-1.9, 0, -2}, {-1.9, 0, 2}, {-1.9, 2.5, 2}, {-1.9, 2.5, -2}}).use("bright");
        build.polygon({{-2, 0, -1.9}, {-2, 2.5, -1.9}, {2, 2.5, -1.9}, {2, 0, -1.9}}).use("lamp");
        build.polygon({{-1, 2.4, -1}, {0, 2.4, -1}, {0, 2.4, 0}, {-1, 2.4, 0}});
        look({1.8, 1.6, 1.8}, {0, 0.8, 0}, 80);
        options.effects.all = false;
    }
};

} // namespace

TEST(PathReuse, ChangesNoMeanUnderAnyLight) {
    for (const Lighting& lighting : lightings()) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.options.sampling.spp = 256;
        expect_same_light(room, Integrator::PATH);
    }
}

TEST(PathReuse, ChangesNoMeanWhereNormalsAreBent) {
    Room room;
    room.add_lamp();
    room.add_bent_normals();
    room.add_steep_normals();
    expect_same_light(room, Integrator::PATH);
}

TEST(PathReuse, ChangesNoMeanWherePathsEndEarly) {
    Room room;
    room.add_lamp();
    room.options.transport.roulette_depth = 2;
    expect_same_light(room, Integrator::PATH);
    room.options.transport.roulette_depth = 5;
    room.options.transport.max_depth = 3;
    expect_same_light(room, Integrator::PATH);
}

// Poles before the walls of a room: of pixels side by side one sees what the other does not.
TEST(PathReuse, ChangesNoMeanWhereSurfacesAreHidden) {
    Lit room(true);
    for (double x = -1.8; x < 1; x += 0.3)
        room.build.use("white").box({x, 0, -1.9}, {x + 0.1, 2.4, -1.7});
    room.look({0.3, 1.2, 1.9}, {0, 1.2, -2}, 50);
    room.options.film.size = {48, 48};
    room.options.sampling.spp = 256;
    EXPECT_LT(mean_square_z(both_ways(room)), LARGEST_MEAN_SQUARE_Z);
}

// What leaves a glossy wall depends on the direction.
TEST(PathReuse, ChangesNoMeanBetweenGlossyWalls) {
    TestScene room;
    room.build.material("gloss", "Kd 0.2 0.2 0.2\nKs 0.7 0.7 0.7\nNs 30\nillum 2");
    room.build.material("lamp", "Kd 0 0 0\nKe 9 9 9").use("gloss");
    room.build.box({-2, 0, -2}, {2, 2.5, 2}, Facing::INWARD);
    room.build.use("lamp").polygon({{-1, 2.4, -1}, {0, 2.4, -1}, {0, 2.4, 0}, {-1, 2.4, 0}});
    room.look({1.8, 1.6, 1.8}, {0, 0.8, 0}, 60);
    room.options.film.size = {24, 24};
    room.options.sampling.spp = 2048;
    room.options.effects.all = false;
    EXPECT_LT(mean_square_z(both_ways(room)), LARGEST_MEAN_SQUARE_Z);
}

// Within one tile, so that what is given to wrong pixels shows: rough metal beside paint, plastic, lacquers
// as smooth as a mirror, the second by Fresnel's formula, paint under a coat and fibres, brushed metal beside
// paint and brushed varnish. The first are guided.
TEST(PathReuse, ChangesNoMeanBetweenGlossyWallsOfOneTile) {
    Toggle guide = Toggle::ON;
    const std::vector<const char*> kinds = {"Kd 0.2 0.2 0.2\nKs 0.7 0.7 0.7\nNs 30\nillum 2",
                                            "Kd 0.8 0.6 0.3\nKs 0.05 0.05 0.05\nNs 10\nillum 2",
                                            "Kd 0.5 0.5 0.5\nKs 0.2 0.3 0.4\nillum 3",
                                            "Kd 0.8 0.6 0.3\nKs 0.1 0.1 0.1\nillum 5",
                                            "Kd 0.7 0.7 0.7\nPc 1\nPcr 0.3\nPs 0.5 0.5 0.5",
                                            "Kd 0.4 0.4 0.4\nKs 0.4 0.4 0.4\nPr 0.4\naniso 0.8\nillum 2",
                                            "Kd 0.8 0.6 0.3\nPm 0.2\nPr 0.4\naniso 0.8"};
    for (const char* kind : drawn(kinds, 2)) {
        SCOPED_TRACE(kind);
        GlossyRoom room(kind);
        room.options.film.size = {8, 8};
        room.options.sampling.spp = 8192;
        const std::pair<Film, Film> films = both_ways(room, std::exchange(guide, Toggle::OFF));
        EXPECT_LT(mean_square_z(films), LARGEST_MEAN_SQUARE_Z_OF_A_TILE);
        expect_equal_means(films.first, films.second, kind);
    }
}

TEST(PathReuse, LowersNoiseBetweenPlasticWalls) {
    GlossyRoom room("Kd 0.8 0.8 0.8\nKs 0.04 0.04 0.04\nNs 100\nillum 2");
    room.options.film.size = {48, 48};
    room.options.sampling.spp = 64;
    room.options.transport.guide = Toggle::OFF;
    const Cost alone(room, Toggle::OFF), reusing(room, Toggle::ON);
    EXPECT_LT(reusing.cost, 0.6 * alone.cost);
}

// A veil over half of the floor, tinted panes across the room: paths pass them by chance, each its own.
TEST(PathReuse, ChangesNoMeanBehindCutOutsAndPanes) {
    Lit room(true);
    room.build.material("veil", "Kd 0.5 0.5 0.5\nd 0.4")
        .material("pane", "Ni 1.5\nillum 7\nTf 0.9 0.3 0.6\nthin_walled 1");
    room.build.use("veil").polygon({{-2, 0.4, -2}, {-2, 0.4, 2}, {0.3, 0.4, 2}, {0.3, 0.4, -2}});
    room.build.use("pane").polygon({{-1, 0, -2}, {-1, 2.4, -2}, {-1, 2.4, 1}, {-1, 0, 1}});
    room.build.polygon({{-2, 0.2, 0.5}, {-2, 0.2, 2}, {2, 0.2, 2}, {2, 0.2, 0.5}});
    room.options.film.size = {24, 24};
    room.options.sampling.spp = 2048;
    EXPECT_LT(mean_square_z(both_ways(room)), LARGEST_MEAN_SQUARE_Z);
}

// What is seen in rough glass, and what it sends to the walls.
TEST(PathReuse, ChangesNoMeanAroundGlassThatAbsorbsOrDisperses) {
    for (const char* kind : drawn<const char*>({"attenuation 0.5 1.5 3", "abbe 10"}, 2)) {
        Lit room(true);
        room.build.material("resin", std::string("Ni 1.5\nillum 7\nPr 0.4\n") + kind).use("resin");
        room.build.box({-1.5, 0.1, -1.5}, {1, 1, 1}).use("white").box({-0.6, 0.3, -0.6}, {0.2, 0.6, 0.2});
        room.options.film.size = {24, 24};
        room.options.sampling.spp = 1024;
        EXPECT_LT(mean_square_z(both_ways(room)), LARGEST_MEAN_SQUARE_Z) << kind;
    }
}

// In the picture walls are side by side that are seen at once, in a mirror, in two and through glass: as many
// segments are left behind each as max_depth says.
TEST(PathReuse, ChangesNoMeanBehindMirrorsAndGlass) {
    struct Limits {
        int max_depth, roulette_depth;
    };
    for (const Limits limits : drawn<Limits>({{4, 5}, {64, 2}, {64, 3}}, 2)) {
        SCOPED_TRACE(testing::Message() << limits.max_depth << ", " << limits.roulette_depth);
        MirrorRoom room;
        room.build
            .material("glass", "Kd 0 0 0\nKs 1 1 1\nTf 0.9 1 0.8\nNi 1.5\nillum 7\nattenuation 0.1 0.3 0.6")
            .material("gem", "Kd 0 0 0\nKs 1 1 1\nTf 1 1 1\nNi 1.7\nillum 7\nabbe 10");
        room.build.use("glass").box({-0.5, 0.7, 0.2}, {0.3, 1.3, 0.6});
        room.build.use("gem").box({0.3, 0.4, -0.9}, {1, 0.9, -0.3});
        room.options.film.size = {24, 24};
        room.options.sampling.spp = 2048;
        room.options.transport.max_depth = limits.max_depth;
        room.options.transport.roulette_depth = limits.roulette_depth;
        EXPECT_LT(mean_square_z(both_ways(room)), LARGEST_MEAN_SQUARE_Z);
    }
}

// A wall that is seen in a mirror, by light from a lamp that shines at the ceiling.
TEST(PathReuse, LowersNoiseBehindMirrors) {
    TestScene room;
    room.build.material("white", "Kd 0.75 0.75 0.75").material("lamp", "Kd 0 0 0\nKe 9 9 9").use("white");
    room.build.box({-2, 0, -2}, {2, 2.5, 2}, Facing::INWARD).box({-1, 1.8, 0}, {1, 1.9, 1});
    room.build.use("lamp").polygon(
        {{-0.9, 1.95, 0.1}, {-0.9, 1.95, 0.9}, {0.9, 1.95, 0.9}, {0.9, 1.95, 0.1}});
    room.build.material("mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3").use("mirror");
    room.build.polygon({{-1.9, 0.1, -1.95}, {1.9, 0.1, -1.95}, {1.9, 1.7, -1.95}, {-1.9, 1.7, -1.95}});
    room.look({0.3, 1, -0.5}, {0, 0.9, -2}, 60);
    room.options.film.size = {32, 32};
    room.options.sampling.spp = 256;
    room.options.transport.guide = Toggle::OFF;
    room.options.effects.all = false;
    const Cost alone(room, Toggle::OFF), reusing(room, Toggle::ON);
    EXPECT_LT(reusing.cost, 0.6 * alone.cost);
}

TEST(PathReuse, LowersNoiseTimesRays) {
    TestScene rooms;
    add_adjoining_rooms(rooms);
    rooms.options.sampling.spp = 256;
    rooms.options.sampling.replicates = 32;
    const Cost alone(rooms, Toggle::OFF), reusing(rooms, Toggle::ON);
    EXPECT_LT(reusing.cost, 0.5 * alone.cost);
    EXPECT_LT(double(reusing.render.counts.rays()), 2 * double(alone.render.counts.rays()));
    EXPECT_EQ(reusing.render.counts.bad(), 0u);
    EXPECT_EQ(reusing.render.film.shown, alone.render.film.shown);
}

TEST(PathReuse, AWindowOfWholeTilesIsAPartOfThePicture) {
    expect_crop_is_a_part(Integrator::PATH, {8, 8, 24, 32}, Toggle::ON);
}

TEST(PathReuse, PicturesSmallerThanATileHaveTheSameLight) {
    Room room;
    room.add_lamp();
    room.options.film.size = {9, 3};
    room.options.sampling.spp = 4096;
    const Film alone = room.render().film;
    room.options.transport.path_reuse = Toggle::ON;
    room.options.sampling.seed = 1;
    expect_equal_means(room.render().film, alone, "9 x 3 pixels");
}

TEST(PathReuse, IsChosenWhereLightComesByDetours) {
    Lit room(true);
    EXPECT_EQ(room.chosen(), Toggle::ON);
    EXPECT_TRUE(room.parts.tree);
    EXPECT_TRUE(room.parts.programs);
    EXPECT_EQ(Lit(false).chosen(), Toggle::OFF);
}

// The pixels of pilots are as near to each other as those of the picture.
TEST(PathReuse, PilotsTellWhatItGains) {
    Lit room(true);
    room.options.film.size = {320, 240};
    room.options.transport.guide = Toggle::OFF;
    room.planned = plan_loaded(test_device(), room.load(), room.options);
    const double told = run_reuse_pilots(test_device(), room.planned, room.parts)->gain;
    EXPECT_EQ(room.planned->options.transport.path_reuse, Toggle::AUTO);
    room.options.sampling.spp = 8; // as the pilots
    room.options.sampling.replicates = 4;
    const Cost alone(room, Toggle::OFF), reusing(room, Toggle::ON);
    const double errors = sample_error(alone.render.film, ErrorMeasure::RELATIVE) /
                          sample_error(reusing.render.film, ErrorMeasure::RELATIVE);
    const double rays = double(reusing.render.counts.rays()) / double(alone.render.counts.rays());
    EXPECT_GT(told, 0.8 * errors / rays);
    EXPECT_LT(told, errors);
    EXPECT_NEAR(told, errors / (1 + 0.35 * (rays - 1)), 0.15 * told);
}

// So that one program serves both pilots and the picture.
TEST(PathReuse, ProgramsThatCanDoWithoutTakeTheSameSamples) {
    Lit room(true);
    room.planned = plan_loaded(test_device(), room.load(), room.options);
    const PilotSize size = in_tiles({64, 48, 8});
    const PreparedScene able = prepare_path_pilot(test_device(), room.planned, room.parts);
    EXPECT_TRUE(room.parts.reusing);
    EXPECT_FALSE(room.parts.programs);
    const PathPilot without = run_path_pilot(able, size);
    const PathPilot with = run_path_pilot(able, size, true);
    room.planned->options.transport.path_reuse = Toggle::OFF;
    const PathPilot unable =
        run_path_pilot(prepare_path_pilot(test_device(), room.planned, room.parts), size);
    EXPECT_TRUE(room.parts.programs);
    EXPECT_EQ(without.errors, unable.errors);
    EXPECT_EQ(without.rays, unable.rays);
    EXPECT_LT(with.errors[size_t(ErrorMeasure::RELATIVE)], unable.errors[size_t(ErrorMeasure::RELATIVE)]);
    EXPECT_GT(with.rays, unable.rays);
}

TEST(PathReuse, IsNotChosenForParts) {
    Lit room(true);
    room.options.run.given["--first-sample"] = "";
    EXPECT_EQ(room.chosen(), Toggle::OFF);
    room.options.run.given.clear();
    room.options.sampling.spp = 1;
    EXPECT_EQ(room.chosen(), Toggle::OFF) << "too few samples for a pilot";
    room.options.sampling.spp = 64;
    room.options.film.crop = Crop{1, 0, 96, 72};
    EXPECT_EQ(room.chosen(), Toggle::OFF) << "tiles of the window are not those of the picture";
    room.options.sampling.spp = 128;
    room.options.film.crop = Crop{8, 0, 96, 72};
    EXPECT_EQ(room.chosen(), Toggle::ON);
}

// Its interval takes the pixels of a tile together, whose noise goes together.
TEST(PathReuse, ErrorBarsKnowThatPixelsShareNoise) {
    Lit room(true);
    room.options.sampling.replicates = 16;
    for (const Toggle reuse : {Toggle::OFF, Toggle::ON}) {
        room.options.transport.path_reuse = reuse;
        Film film = room.render().film;
        const double told = film_squared_error(film)->degrees;
        film.block = 1;
        const double of_pixels = film_squared_error(film)->degrees;
        if (reuse == Toggle::ON)
            EXPECT_LT(told, 0.8 * of_pixels);
        else
            EXPECT_EQ(told, of_pixels);
    }
}

TEST(PathReuse, IsRefusedWhereAPathIsOfUseToItsPixelAlone) {
    Lit room(true);
    room.options.scene.texture_filter = TextureFilter::FOOTPRINT;
    room.texture8("wood.png", 2, 2, 1, {90, 180, 180, 90});
    room.build.material("wood", "Kd 0.5 0.5 0.5\nmap_Kd wood.png")
        .use("wood")
        .textured_quad({{-1, 0.1, 1}, {1, 0.1, 1}, {1, 0.1, -1}, {-1, 0.1, -1}});
    EXPECT_EQ(room.chosen(), Toggle::OFF);
    room.options.transport.path_reuse = Toggle::ON;
    EXPECT_THROW(room.chosen(), UsageError);
}

} // namespace clrt
