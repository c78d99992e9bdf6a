// SPDX-License-Identifier: Apache-2.0
// Portals for light samples of the sky: a room gets its window, with less noise and the same light; where the
// sky is seen from everywhere the plan stays as it is.
#include "film/film_error.h"
#include "probes/film_estimate.h"
#include "render/integrator_choice.h"
#include "render/portal_choice.h"
#include "support/windowed_room.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A room with a window of 1 x 1 towards +x, under a constant sky or a map; or a floor in the open.
struct Room : TestScene {
    explicit Room(bool has_walls, bool has_map = false) {
        build.material("white", "Kd 0.75 0.75 0.75").use("white");
        if (has_walls)
            add_windowed_room(build);
        else
            build.floor(4);
        if (has_map) {
            std::vector<float> texels(size_t(32) * 16 * 3, 1.0f);
            texels[(size_t(5) * 32 + 16) * 3] = 150; // red, towards +x
            texture("sky.exr", 32, 16, 3, texels);
            options.light.environment_file = folder.file("sky.exr");
        } else
            options.light.environment = glm::dvec3(1, 0.9, 0.8);
        look({-2.8, 1.6, 1.6}, {1, 0.9, -0.8}, 60);
        options.film.size = {96, 72};
        options.effects.all = false;
    }
    /// Several lights, and a mirror that casts theirs.
    void add_lamps_and_mirror() {
        build.material("lamp", "Kd 0 0 0\nKe 2 2 2").use("lamp");
        for (const double z : {-1.0, 1.0})
            build.icosphere({-1, 2, z}, 0.1, 1, Facing::OUTWARD, Shading::FLAT);
        build.material("mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3").use("mirror").floor(0.5, 0.3);
    }
    std::shared_ptr<PlannedScene> plan(bool chooses) {
        const auto planned = plan_loaded(test_device(), load(), options);
        Progress silent(Toggle::OFF, true);
        PreparedParts parts;
        if (chooses)
            choose_portals(test_device(), planned, parts, silent);
        return planned;
    }
};

Film film_of(const std::shared_ptr<PlannedScene>& planned) {
    planned->options.film.size = {24, 18};
    planned->options.sampling.spp = 512;
    planned->options.sampling.replicates = 32;
    Progress silent(Toggle::OFF, true);
    return render(prepare_render(test_device(), planned), silent).film;
}

/// Of the whole picture's red.
Estimate mean_of(const Film& film) {
    return film_estimate(film, 0, {0, 0, film.width, film.height});
}

} // namespace

// The window is where it was built, and light through it is neither lost nor counted twice.
TEST(PortalChoice, ARoomGetsItsWindow) {
    for (const bool has_map : {false, true}) {
        Room room(true, has_map);
        const auto with = room.plan(true), without = room.plan(false);
        const Environment& sky = with->scene.environment;
        ASSERT_EQ(sky.portals.size(), 1u) << has_map;
        EXPECT_TRUE(without->scene.environment.portals.empty());
        const double scale = with->scene.normalisation.scale;
        const SkyPortal& window = sky.portals[0];
        EXPECT_NEAR(double(window.axis_u.w) * double(window.axis_v.w) / (scale * scale), 1, 0.04);
        EXPECT_NEAR(double(window.normal.x), -1, 1e-3);
        const Film portal_film = film_of(with), plain_film = film_of(without);
        const Estimate portal = mean_of(portal_film), plain = mean_of(plain_film);
        EXPECT_LT(std::abs(portal.mean - plain.mean), 4 * std::hypot(portal.error, plain.error));
        EXPECT_LT(sample_error(portal_film, ErrorMeasure::RELATIVE),
                  0.5 * sample_error(plain_film, ErrorMeasure::RELATIVE));
    }
}

// A constant sky is none of the lights that are chosen from until it has portals. All integrators that
// connect to one light choose alike.
TEST(PortalChoice, BesideLampsAndForLightPathsAsWell) {
    std::optional<double> corner;
    for (const Integrator integrator : {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT}) {
        SCOPED_TRACE(name_of(integrator));
        Room room(true);
        room.add_lamps_and_mirror();
        room.options.transport.integrator = integrator;
        room.options.transport.guide = Toggle::OFF;
        const auto with = room.plan(true), without = room.plan(false);
        EXPECT_FALSE(with->scene.light_tree.nodes.empty());
        ASSERT_EQ(with->scene.environment.portals.size(), 1u);
        EXPECT_EQ(with->options.transport.integrator, integrator);
        const double found = double(with->scene.environment.portals[0].corner.x);
        EXPECT_EQ(found, corner.value_or(found));
        corner = found;
        const Film portal_film = film_of(with), plain_film = film_of(without);
        const Estimate portal = mean_of(portal_film), plain = mean_of(plain_film);
        EXPECT_LT(std::abs(portal.mean - plain.mean), 4 * std::hypot(portal.error, plain.error));
        EXPECT_LT(sample_error(portal_film, ErrorMeasure::RELATIVE),
                  0.5 * sample_error(plain_film, ErrorMeasure::RELATIVE));
    }
}

TEST(PortalChoice, InTheOpenThePlanStays) {
    Room open(false, true);
    const auto planned = open.plan(true);
    EXPECT_TRUE(planned->scene.environment.portals.empty());
    EXPECT_EQ(planned->scene.environment.portal_share, 0);
}

TEST(PortalChoice, CropsAndSeedsChooseAlike) {
    Room room(true, true);
    const auto whole = room.plan(true);
    room.options.film.crop = Crop{10, 10, 40, 30};
    room.options.sampling.seed = 7;
    const auto crop = room.plan(true);
    ASSERT_EQ(whole->scene.environment.portals.size(), crop->scene.environment.portals.size());
    EXPECT_EQ(whole->scene.environment.portals[0].axis_u.w, crop->scene.environment.portals[0].axis_u.w);
    EXPECT_EQ(whole->scene.environment.portal_share, crop->scene.environment.portal_share);
    EXPECT_TRUE(crop->options.film.crop);
}

// The picture's program is the chosen integrator's, not the one that tried portals.
TEST(PortalChoice, LeavesTheIntegratorToBeChosen) {
    Room room(true);
    room.build.material("mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3").use("mirror").floor(0.5, 0.3);
    room.options.light.suns.push_back({{1, 0.6, 0}, {9, 9, 9}, 0});
    room.options.transport.choose = Toggle::ON;
    const auto planned = room.plan(false);
    Progress silent(Toggle::OFF, true);
    PreparedParts parts;
    choose_portals(test_device(), planned, parts, silent);
    choose_integrator(test_device(), planned, parts, silent);
    ASSERT_EQ(planned->options.transport.integrator, Integrator::PATH_LIGHT);
    planned->options.film.size = {24, 18};
    EXPECT_NO_THROW(render(prepare_render(test_device(), planned, parts), silent));
}

} // namespace clrt
