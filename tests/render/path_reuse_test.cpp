// SPDX-License-Identifier: Apache-2.0
// Path reuse: what a path has found behind its second vertex serves other pixels. The light stays the same in
// every tile, under every kind of light and on every kind of surface; the noise of light that comes by
// detours falls; and it is chosen where that pays.
#include "error.h"
#include "film/film_error.h"
#include "render/reuse_choice.h"
#include "support/adjoining_rooms.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"

#include <gtest/gtest.h>
#include <utility>

namespace clrt {

namespace {

/// Whether a room has the same light in every tile with and without reuse.
void expect_same_light(const Room& room, double sharpness) {
    Options reusing = room.options;
    reusing.transport.path_reuse = Toggle::ON;
    reusing.sampling.seed = 1;
    expect_equal(tile_means(room, reusing, Integrator::PATH, ""),
                 tile_means(room, room.options, Integrator::PATH, ""), sharpness);
}

/// A render, its squared error of a sample times its rays.
struct Cost {
    Render render;
    double cost;
    Cost(TestScene& scene, Toggle path_reuse) {
        scene.options.transport.path_reuse = path_reuse;
        render = scene.render();
        cost = sample_error(render.film, ErrorMeasure::RELATIVE) * double(render.counts.rays());
    }
};

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

} // namespace

TEST(PathReuse, ChangesNoMeanUnderAnyLight) {
    for (const Lighting& lighting : lightings()) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.options.sampling.spp = 256;
        expect_same_light(room, 0.08);
    }
}

TEST(PathReuse, ChangesNoMeanWhereNormalsAreBent) {
    Room room;
    room.add_lamp();
    room.add_bent_normals();
    room.add_steep_normals();
    expect_same_light(room, 0.08);
}

TEST(PathReuse, ChangesNoMeanWherePathsEndEarly) {
    Room room;
    room.add_lamp();
    room.options.transport.roulette_depth = 2;
    expect_same_light(room, 0.08);
    room.options.transport.roulette_depth = 5;
    room.options.transport.max_depth = 3;
    expect_same_light(room, 0.08);
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

TEST(PathReuse, IsRefusedWhereAPathIsOfUseToItsPixelAlone) {
    Lit room(true);
    room.build.material("veil", "Kd 0.5 0.5 0.5\nd 0.5").use("veil").floor(0.5, 1);
    EXPECT_EQ(room.chosen(), Toggle::OFF);
    room.options.transport.path_reuse = Toggle::ON;
    EXPECT_THROW(room.chosen(), UsageError);
}

} // namespace clrt
