// SPDX-License-Identifier: Apache-2.0
// The table by which path samples an environment map: pilots find the better one, and leave the rest of the
// plan as it is.
#include "film/film_error.h"
#include "render/sky_choice.h"
#include "scene/sky_table.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Where the sun of the map is, as seen from the room.
enum class Sun { IN_WINDOW, BEHIND_WALL };

/// A room with a window towards +x under a sky that is nearly even, but for a sun.
struct Room : TestScene {
    explicit Room(Sun sun) {
        build.material("white", "Kd 0.75 0.75 0.75").use("white");
        for (const double y : {0.0, 2.5})
            build.polygon({{-3, y, -2}, {-3, y, 2}, {2, y, 2}, {2, y, -2}});
        for (const double z : {-2.0, 2.0})
            build.polygon({{-3, 0, z}, {2, 0, z}, {2, 2.5, z}, {-3, 2.5, z}});
        build.polygon({{-3, 0, -2}, {-3, 2.5, -2}, {-3, 2.5, 2}, {-3, 0, 2}});
        build.polygon({{2, 0, -2}, {2, 1, -2}, {2, 1, 2}, {2, 0, 2}});
        build.polygon({{2, 2, -2}, {2, 2.5, -2}, {2, 2.5, 2}, {2, 2, 2}});
        build.polygon({{2, 1, -2}, {2, 2, -2}, {2, 2, -0.5}, {2, 1, -0.5}});
        build.polygon({{2, 1, 0.5}, {2, 2, 0.5}, {2, 2, 2}, {2, 1, 2}});
        constexpr int WIDTH = 32, HEIGHT = 16;
        std::vector<float> texels(size_t(WIDTH) * HEIGHT * 3, 2.0f);
        const int column = sun == Sun::IN_WINDOW ? WIDTH / 2 : 0; // towards +x or -x
        for (size_t channel = 0; channel < 3; ++channel)
            texels[(size_t(5) * WIDTH + size_t(column)) * 3 + channel] = 150;
        texture("sky.exr", WIDTH, HEIGHT, 3, texels);
        options.light.environment_file = folder.file("sky.exr");
        look({-2.8, 1.6, 1.6}, {1, 0.9, -0.8}, 60);
        options.film.size = {40, 30};
        options.effects.all = false;
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
double squared_error(const Room& room, SkySampling sampling) {
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

TEST(SkyChoice, TheBetterTableIsTaken) {
    Room lit(Sun::IN_WINDOW), sky_only(Sun::BEHIND_WALL);
    EXPECT_EQ(lit.chosen(), SkySampling::BY_TABLE_AND_BSDF);
    EXPECT_EQ(sky_only.chosen(), SkySampling::BY_TABLE);
    for (const Room* room : {&lit, &sky_only}) {
        const double by_excess = squared_error(*room, SkySampling::BY_TABLE_AND_BSDF);
        const double by_radiance = squared_error(*room, SkySampling::BY_TABLE);
        EXPECT_EQ(by_excess > 1.1 * by_radiance, room == &sky_only) << by_excess << " " << by_radiance;
    }
}

TEST(SkyChoice, WhatThePilotsMadeIsThere) {
    Room room(Sun::BEHIND_WALL);
    room.choose();
    EXPECT_TRUE(room.parts.tree);
    EXPECT_TRUE(room.parts.programs);
}

TEST(SkyChoice, ThePlanIsAsBeforeWhereTheTableStays) {
    Room room(Sun::IN_WINDOW);
    const auto planned = room.plan(), after = room.choose();
    EXPECT_EQ(probabilities(after->scene.environment), probabilities(planned->scene.environment));
    EXPECT_EQ(after->scene.environment.tabulated_share, planned->scene.environment.tabulated_share);
}

TEST(SkyChoice, PartsOfAPictureChooseAlike) {
    Room room(Sun::BEHIND_WALL);
    room.options.film.crop = Crop{0, 0, 8, 8};
    room.options.sampling.spp = 1;
    const auto planned = room.choose();
    EXPECT_EQ(planned->scene.environment.sampling, SkySampling::BY_TABLE);
    ASSERT_TRUE(planned->options.film.crop);
    EXPECT_EQ(planned->options.film.crop->x1, 8);
}

TEST(SkyChoice, ThereIsNoPilotWhereThereIsNoChoice) {
    Room small(Sun::BEHIND_WALL);
    small.options.film.size = {16, 12};
    EXPECT_EQ(small.chosen(), SkySampling::BY_TABLE_AND_BSDF);
    EXPECT_FALSE(small.parts.programs);
    Room other(Sun::BEHIND_WALL);
    other.options.transport.integrator = Integrator::BDPT;
    other.choose();
    EXPECT_FALSE(other.parts.programs);
    Room constant(Sun::BEHIND_WALL);
    constant.options.light.environment_file.clear();
    constant.options.light.environment = glm::dvec3(1);
    constant.choose();
    EXPECT_FALSE(constant.parts.programs);
}

} // namespace clrt
