// SPDX-License-Identifier: Apache-2.0
// The table by which path samples an environment map: pilots find the better one, and leave the rest of the
// plan as it is.
#include "film/film_error.h"
#include "render/sky_choice.h"
#include "scene/sky_table.h"
#include "support/windowed_room.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <set>

namespace clrt {

namespace {

/// Under which sky a scene is.
enum class Place { ROOM_WITH_SUN, ROOM_WITHOUT_SUN, OUTDOORS };

/// A room with a window towards +x, into which the sun shines or not, or a floor and a wall.
struct Sunlit : TestScene {
    explicit Sunlit(Place place) {
        build.material("white", "Kd 0.75 0.75 0.75").use("white");
        if (place == Place::OUTDOORS)
            add_block();
        else
            add_windowed_room(build);
        constexpr int WIDTH = 32, HEIGHT = 16;
        const bool is_outdoors = place == Place::OUTDOORS;
        std::vector<float> texels(size_t(WIDTH) * HEIGHT * 3, is_outdoors ? 0.3f : 2.0f);
        if (is_outdoors) // brighter above the horizon
            std::fill_n(texels.begin(), texels.size() / 2, 3.0f);
        const int column = place == Place::ROOM_WITHOUT_SUN ? 0 : WIDTH / 2; // towards -x or +x
        for (size_t channel = 0; channel < 3; ++channel)
            texels[(size_t(5) * WIDTH + size_t(column)) * 3 + channel] = 150;
        texture("sky.exr", WIDTH, HEIGHT, 3, texels);
        options.light.environment_file = folder.file("sky.exr");
        look({-2.8, 1.6, 1.6}, {1, 0.9, -0.8}, 60);
        options.film.size = {24, 18}; // as large as a pilot
        options.effects.all = false;
    }
    /// A floor, and a wall that shades it.
    void add_block() {
        build.floor(4);
        build.polygon({{1, 0, -2}, {1, 1.5, -2}, {1, 1.5, 1}, {1, 0, 1}});
    }
    std::shared_ptr<PlannedScene> plan() const { return plan_loaded(test_device(), load(), options); }

    /// The plan after the choice.
    std::shared_ptr<PlannedScene> choose() {
        const auto planned = plan();
        Progress silent(Toggle::OFF, true);
        parts = {};
        choose_sky_table(test_device(), planned, parts, silent);
        return planned;
    }
    SkySampling chosen() { return *choose()->scene.environment.sampling; }

    PreparedParts parts;
};

/// Squared relative error of a sample a pixel by a table.
double squared_error(const Sunlit& room, SkySampling sampling) {
    const auto planned = room.plan();
    tabulate_sky(planned->scene.environment, sampling);
    planned->options.sampling.spp = 256;
    planned->options.sampling.replicates = 32; // 8 samples each: nets as of a pilot
    Progress silent(Toggle::OFF, true);
    return sample_error(render(prepare_render(test_device(), planned), silent).film, ErrorMeasure::RELATIVE);
}

std::vector<float> probabilities(const Environment& sky) {
    std::vector<float> values;
    for (const SkyTile& tile : sky.tiles)
        values.push_back(tile.probability);
    return values;
}

} // namespace

TEST(SkyChoice, TheBestTableIsTaken) {
    constexpr SkySampling ALL[] = {SkySampling::BY_TABLE_AND_BSDF, SkySampling::BY_TABLE,
                                   SkySampling::BRIGHTEST_BY_TABLE};
    std::set<SkySampling> taken;
    for (const Place place : {Place::ROOM_WITH_SUN, Place::ROOM_WITHOUT_SUN, Place::OUTDOORS}) {
        Sunlit scene(place);
        const SkySampling chosen = scene.chosen();
        taken.insert(chosen);
        const double error = squared_error(scene, chosen);
        for (const SkySampling other : ALL)
            EXPECT_LT(error, 1.15 * squared_error(scene, other)) << int(place) << " " << int(other);
    }
    EXPECT_EQ(taken.size(), 3u) << "each of them is the best somewhere";
}

TEST(SkyChoice, WhatThePilotsMadeIsThere) {
    Sunlit room(Place::ROOM_WITHOUT_SUN);
    room.choose();
    EXPECT_TRUE(room.parts.tree);
    EXPECT_TRUE(room.parts.programs || room.parts.reusing);
}

TEST(SkyChoice, ThePlanIsAsBeforeWhereTheTableStays) {
    Sunlit room(Place::ROOM_WITH_SUN);
    const auto planned = room.plan(), after = room.choose();
    EXPECT_EQ(probabilities(after->scene.environment), probabilities(planned->scene.environment));
    EXPECT_EQ(after->scene.environment.tabulated_share, planned->scene.environment.tabulated_share);
}

TEST(SkyChoice, PartsOfAPictureChooseAlike) {
    Sunlit room(Place::ROOM_WITHOUT_SUN);
    room.options.film.crop = Crop{0, 0, 8, 8};
    room.options.sampling.spp = 1;
    const auto planned = room.choose();
    EXPECT_EQ(planned->scene.environment.sampling, SkySampling::BY_TABLE);
    ASSERT_TRUE(planned->options.film.crop);
    EXPECT_EQ(planned->options.film.crop->x1, 8);
}

TEST(SkyChoice, ThereIsNoPilotWhereThereIsNoChoice) {
    Sunlit small(Place::ROOM_WITHOUT_SUN);
    small.options.film.size = {16, 12};
    EXPECT_EQ(small.chosen(), SkySampling::BY_TABLE_AND_BSDF);
    EXPECT_FALSE(small.parts.programs);
    Sunlit other(Place::ROOM_WITHOUT_SUN);
    other.options.transport.integrator = Integrator::BDPT;
    other.choose();
    EXPECT_FALSE(other.parts.programs);
    Sunlit constant(Place::ROOM_WITHOUT_SUN);
    constant.options.light.environment_file.clear();
    constant.options.light.environment = glm::dvec3(1);
    constant.choose();
    EXPECT_FALSE(constant.parts.programs);
}

} // namespace clrt
