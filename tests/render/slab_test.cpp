// SPDX-License-Identifier: Apache-2.0
// Connections to sky and suns through plane-parallel slabs of glass: closed forms, the light that integrators
// find which do without, and no more noise than an open window has.
#include "film/film_error.h"
#include "probes/closed_forms.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"
#include "support/windowed_room.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr Integrator CONNECTING[] = {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT};

/// A room under a sky and a sun that shines in at its window; the camera sees the wall that is opposite.
struct WindowedRoom : TestScene {
    /// `glass`: keys of the panes; empty: there are none.
    explicit WindowedRoom(const std::string& glass, int panes = 1) {
        build.material("white", "Kd 0.7 0.6 0.5").use("white");
        add_windowed_room(build);
        if (!glass.empty())
            build.material("glass", glass).use("glass");
        for (int i = 0; i < panes && !glass.empty(); ++i)
            build.box({2.1 + 0.1 * i, 0.9, -0.6}, {2.13 + 0.1 * i, 2.1, 0.6});
        look({-0.2, 1.6, 1.7}, {-2.8, 0.6, -1.5}, 75);
        options.light.environment = glm::dvec3(0.5, 0.7, 1);
        options.light.suns.push_back({{0.8, 0.45, -0.2}, {8, 7, 6}, 4});
        options.film.size = {24, 24};
        options.sampling.spp = 512;
        options.transport.max_depth = 8;
        options.transport.guide = Toggle::OFF;
    }
};

/// A floor below a pane that is 1 / 8 thick and as good as endless, under a point sun; all of the picture
/// shows one point of the floor.
struct GlazedFloor : TestScene {
    explicit GlazedFloor(int max_depth) {
        build.material("grey", "Kd 0.5 0.5 0.5").material("glass", "Ni 1.5\nillum 7").use("grey").floor(4);
        build.use("glass").box({-50, 1, -50}, {50, 1.125, 50});
        look_at_point({0.2, 0.5, 0.1}, {0, 0, 0});
        options.light.environment = glm::dvec3(0);
        options.light.suns.push_back({{0.6, 0.8, 0}, {1, 2, 4}, 0});
        options.transport.max_depth = max_depth;
    }
};

/// Glass of some kind, in so many panes.
struct Glass {
    const char* keys;
    int panes;
};
constexpr Glass GLASSES[] = {{"Ni 1.5\nillum 7", 1},
                             {"Ni 1.3\nTf 0.9 0.8 0.6\nillum 7", 2},
                             {"Ni 1.2\nillum 7\nattenuation 3 8 20", 1}};

/// Expects the light of integrators that connect through slabs to be that of light paths alone.
void expect_light_of_light_paths(const WindowedRoom& room, const std::vector<Integrator>& integrators) {
    Options alone = room.options;
    alone.sampling.spp = 8192;
    const TileMeans expected = tile_means(room, alone, Integrator::LIGHT, "");
    for (const Integrator integrator : integrators) {
        SCOPED_TRACE(name_of(integrator));
        expect_equal(tile_means(room, room.options, integrator, ""), expected, 0.06);
    }
}

} // namespace

TEST(Slab, LetsAPointSunThroughAsFresnelSays) {
    const double f = fresnel_reflectance(0.8, 1 / 1.5), passes = 0.5 / PI * 0.8 * (1 - f) * (1 - f);
    for (const Integrator integrator : CONNECTING)
        for (const Toggle shares : {Toggle::OFF, Toggle::ON}) {
            if (shares == Toggle::ON && integrator != Integrator::PATH)
                continue;
            GlazedFloor scene(4);
            scene.options.transport.integrator = integrator;
            scene.options.transport.path_reuse = shares;
            const Film film = scene.render().film;
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_TRUE(agrees(film_estimate(film, channel), passes * (1 << channel), 1e-3, 1e-4))
                    << name_of(integrator);
        }
}

TEST(Slab, CountsItsFacetsAsSegments) {
    for (const Integrator integrator : CONNECTING) {
        GlazedFloor scene(3); // one to the floor, one to either facet
        scene.options.transport.integrator = integrator;
        EXPECT_EQ(film_estimate(scene.render().film, 0).mean, 0) << name_of(integrator);
    }
}

TEST(Slab, ConnectionsFindTheLightThatLightPathsFind) {
    for (const auto& [keys, panes] : GLASSES) {
        SCOPED_TRACE(keys);
        expect_light_of_light_paths(WindowedRoom(keys, panes),
                                    {Integrator::PATH, Integrator::PATH_LIGHT, Integrator::BDPT});
    }
}

TEST(Slab, LightThatIsBentIsLeftToLightPaths) {
    // A box beside the view bends what comes in at one of its faces and leaves it by one that is not
    // parallel.
    for (const auto& [keys, panes] : GLASSES) {
        SCOPED_TRACE(keys);
        WindowedRoom room(keys, panes);
        room.build.box({0.3, 0.3, 0.2}, {0.9, 1, 0.9});
        expect_light_of_light_paths(room, {Integrator::PATH_LIGHT, Integrator::BDPT});
    }
}

TEST(Slab, PanesAreAsQuietAsOpenWindows) {
    for (const Toggle shares : {Toggle::OFF, Toggle::ON}) {
        const auto error_of = [&](const std::string& glass) {
            WindowedRoom room(glass);
            room.options.transport.path_reuse = shares;
            return sample_error(room.render().film, ErrorMeasure::RELATIVE);
        };
        EXPECT_LT(error_of("Ni 1.5\nillum 7"), 1.3 * error_of(""));
    }
}

TEST(Slab, ReusedPathsFindTheSameLight) {
    const WindowedRoom room("Ni 1.5\nillum 7");
    Options reusing = room.options;
    reusing.transport.path_reuse = Toggle::ON;
    reusing.sampling.seed = 1;
    expect_equal(tile_means(room, reusing, Integrator::PATH, ""),
                 tile_means(room, room.options, Integrator::PATH, ""), 0.05);
}

} // namespace clrt
