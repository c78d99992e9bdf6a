// SPDX-License-Identifier: Apache-2.0
// Light paths: alone (`light`) they bring every path but those that the eye sees by a mirror or smooth glass;
// under one weighting with paths from the eye (`path+light`) they change no mean. Compared with `path`
// restricted to the same paths, tile by tile, under every kind of light.
#include "film/merge_films.h"
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double PI = 3.14159265358979323846;

/// What `light` finds.
const char* const BY_LIGHT_PATHS = "LE|L(D|S)*DE";

void expect_light_is_path(const TestScene& scene, double sharpness) {
    expect_equal(tile_means(scene, scene.options, Integrator::LIGHT, ""),
                 tile_means(scene, scene.options, Integrator::PATH, BY_LIGHT_PATHS), sharpness);
}

} // namespace

TEST(LightPaths, BringWhatPathsFromTheEyeFindOfEveryKindOfLight) {
    for (const Lighting& lighting : lightings()) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.options.sampling.spp = 768;
        expect_light_is_path(room, 0.05);
    }
}

TEST(LightPaths, CrossGlassWithoutTheSquaredIndex) {
    // The eye is in a glass sea whose bottom is lit through its surface, and under a slab.
    TestScene scene;
    scene.build.material("glass", "Ni 1.5\nillum 7").material("matte", "Kd 0.5 0.5 0.5");
    scene.build.use("glass").floor(8, 1).use("matte").floor(8);
    scene.options.light.environment = glm::dvec3(1);
    scene.options.film.size = {16, 16};
    scene.options.transport.max_depth = 5;
    scene.look({0, 0.8, 1}, {0, 0, 0}, 60);
    scene.options.sampling.spp = 4096;
    expect_light_is_path(scene, 0.05);
}

TEST(LightPaths, ShadingNormalsScaleThemAsTheEyeSeesThem) {
    // A coarse ball with smooth normals and a bumpy plate, lit from about where they are looked at: no path
    // is near the horizon of a facet. A sun: paths from the eye look at nearer lights from above the facets.
    TestScene scene;
    std::vector<unsigned char> heights;
    for (int i = 0; i < 8 * 8; ++i)
        heights.push_back((i % 8 + i / 8) % 3 == 0 ? 180 : 90);
    scene.texture8("bump.png", 8, 8, 1, heights);
    scene.build.material("bumpy", "Kd 0.7 0.7 0.7\nbump -bm 0.4 bump.png").material("ball", "Kd 0.7 0.7 0.7");
    scene.build.use("ball").icosphere({-0.6, 0, 0}, 0.5, 1, Facing::OUTWARD, Shading::SMOOTH);
    scene.build.use("bumpy").textured_quad({{0.1, -0.5, 0}, {1.1, -0.5, 0}, {1.1, 0.5, 0}, {0.1, 0.5, 0}});
    scene.options.light.suns.push_back({{0, 0.2, 1}, {3, 3, 3}, 0});
    scene.options.light.environment = glm::dvec3(0);
    scene.options.transport.max_depth = 2;
    for (const double x : {-0.6, 0.6}) {
        scene.look({x, 0, 4}, {x, 0, 0}, 9);
        expect_light_is_path(scene, 0.05);
    }
}

TEST(LightPaths, ShadingNormalsScaleWhatTheySendOn) {
    // A floor that the sun passes by, lit by a wall alone, whose map turns its normals towards sun and floor,
    // or so far up that the floor sees most of them from behind.
    for (const float up : {-0.5f, 0.8f}) {
        SCOPED_TRACE(up);
        TestScene scene;
        scene.texture("tilt.exr", 1, 1, 3, {0.5f, 0.5f * (1 + up), 0.5f * (1 + std::sqrt(1 - up * up))});
        scene.build.material("plain", "Kd 0.7 0.7 0.7").use("plain").floor(1.5);
        scene.build.material("tilted", "Kd 0.7 0.7 0.7\nnorm tilt.exr").use("tilted");
        scene.build.textured_quad({{-1.5, 0, -1.5}, {1.5, 0, -1.5}, {1.5, 2, -1.5}, {-1.5, 2, -1.5}});
        scene.options.light.suns.push_back({{0, -0.4, 1}, {3, 3, 3}, 0});
        scene.options.light.environment = glm::dvec3(0);
        scene.options.transport.max_depth = 3;
        scene.options.sampling.spp = 4096;
        scene.look({0, 3, 0}, {0, 0, -0.7}, 40);
        expect_light_is_path(scene, 0.05);
    }
}

TEST(LightPaths, SeeNormalsFromBehindAsTheEyeDoes) {
    // A small plate whose map leans away from the camera: its normal is bent to where it is seen.
    TestScene scene;
    scene.texture("lean.exr", 1, 1, 3, {0.9f, 0.5f, 0.8f});
    scene.build.material("leaning", "Kd 1 1 1\nnorm lean.exr").use("leaning");
    scene.build.textured_quad({{-0.1, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, -0.1}, {-0.1, 0, -0.1}});
    scene.look({-9, 4, 0}, {0, 0, 0}, 0.3);
    scene.options.light.environment = glm::dvec3(0);
    scene.options.film.size = {8, 8};
    scene.options.sampling.spp = 1024;
    scene.options.transport.max_depth = 2;
    const glm::dvec3 eye = glm::normalize(glm::dvec3(-9, 4, 0)), mapped(0.8, 0.6, 0);
    const glm::dvec3 bent = glm::normalize(mapped + (1e-3 - glm::dot(mapped, eye)) * eye);
    // The second is behind the mapped normal, the last behind the bent one.
    for (const glm::dvec3& towards : {glm::dvec3(1, 1, 0.2), {-1, 1, 0.2}, {0, 1, 3}, {-1, 0.1, 0}}) {
        scene.options.light.suns = {{towards, glm::dvec3(PI), 0}};
        const double expected = std::max(glm::dot(bent, glm::normalize(towards)), 0.0);
        for (const Integrator integrator : {Integrator::LIGHT, Integrator::PATH, Integrator::BDPT}) {
            scene.options.transport.integrator = integrator;
            SCOPED_TRACE(name_of(integrator));
            const Estimate radiance = film_estimate(scene.render().film);
            if (expected > 0)
                EXPECT_TRUE(agrees(radiance, expected, 0.02, 2e-4)) << towards.x << ", " << towards.z;
            else
                EXPECT_EQ(radiance.mean, 0);
        }
    }
}

TEST(LightPaths, ScatterAsTheEyeSeesIt) {
    for (const bool is_sky : {false, true}) {
        SCOPED_TRACE(is_sky);
        Room room;
        if (is_sky)
            room.options.light.environment = glm::dvec3(1, 2, 3);
        else
            room.add_lamp();
        room.add_steep_normals();
        room.look({-1.6, 0.7, 3}, {0, 0.3, 0}, 50);
        room.options.transport.max_depth = 5;
        room.options.sampling.spp = 1024;
        expect_light_is_path(room, 0.1);
    }
}

TEST(LightPaths, SplatsAreSpreadByThePixelFilter) {
    for (const auto& [filter, radius] :
         {std::pair(Filter::BOX, 0.9), {Filter::TENT, 1.3}, {Filter::GAUSSIAN, 2.0}}) {
        SCOPED_TRACE(name_of(filter));
        TestScene scene;
        scene.build.material("lit", "Kd 0.7 0.7 0.7").use("lit");
        scene.build.polygon({{-0.5, -0.5, 0}, {0.25, -0.5, 0}, {0.25, 0.5, 0}, {-0.5, 0.5, 0}});
        scene.options.light.points.push_back({{0.3, 0.4, 3}, {8, 8, 8}});
        scene.options.light.environment = glm::dvec3(0);
        scene.options.film.size = {24, 24}; // a pixel is a tenth of the square
        scene.options.film.filter = filter;
        scene.options.film.filter_radius = radius;
        scene.options.transport.max_depth = 2;
        scene.look({0, 0, 4}, {0, 0, 0}, 33);
        const auto picture = [&](Integrator integrator) {
            scene.options.transport.integrator = integrator;
            return scene.render().film;
        };
        const Film splatted = picture(Integrator::LIGHT), gathered = picture(Integrator::PATH);
        for (int x = 0; x < 24; ++x) {
            const Crop column{x, 8, x + 1, 16};
            const Estimate a = film_estimate(splatted, 0, column), b = film_estimate(gathered, 0, column);
            EXPECT_NEAR(a.mean, b.mean, LARGEST_Z * std::hypot(a.error, b.error) + 1e-6) << x;
        }
    }
}

// A patch just in front of the plane of the eye is seen a hundred million pixels beside the picture, where
// the next pixel has the same coordinate.
TEST(LightPaths, FiltersEndWhereAPixelsWidthIsLost) {
    TestScene scene;
    scene.build.material("lit", "Kd 0.7 0.7 0.7").use("lit");
    const double z = 4 - std::ldexp(1.0, -21);
    scene.build.polygon({{1, 0, z}, {2, 0, z}, {2, 1, z}, {1, 1, z}});
    scene.options.light.points.push_back({{1.5, 0.5, 6}, {8, 8, 8}});
    scene.options.light.environment = glm::dvec3(0);
    scene.options.film.size = {24, 24};
    scene.options.film.filter = Filter::TENT;
    scene.options.transport.integrator = Integrator::LIGHT;
    scene.look({0, 0, 4}, {0, 0, 0}, 33);
    const Film film = scene.render().film;
    for (const std::int64_t sum : film.sums)
        ASSERT_EQ(sum, 0);
}

TEST(LightPaths, ACropIsAPartOfThePictureToTheBit) {
    expect_crop_is_a_part(Integrator::LIGHT);
}

TEST(LightPaths, PartsOfARunMergeToTheWholeToTheBit) {
    for (const Integrator integrator : {Integrator::LIGHT, Integrator::PATH_LIGHT}) {
        SCOPED_TRACE(name_of(integrator));
        Room room;
        room.add_lamp();
        room.add_caustics();
        room.options.transport.integrator = integrator;
        room.options.sampling.replicates = 8;
        const auto part = [&](std::uint32_t first, int samples) {
            room.options.sampling.first_sample = first;
            room.options.sampling.spp = samples;
            FilmFile file;
            file.render = room.render();
            return file;
        };
        const FilmFile whole = part(0, 24);
        FilmFile merged = part(0, 5);
        merge_film(merged, "first", part(5, 11), "second");
        merge_film(merged, "first", part(16, 8), "third");
        EXPECT_TRUE(merged.render.film.sums == whole.render.film.sums);
        EXPECT_EQ(merged.render.counts.secondary, whole.render.counts.secondary);
        EXPECT_FALSE(part(1, 24).render.film.sums == whole.render.film.sums) << "samples count";
    }
}

TEST(LightPaths, AClosedFurnaceHasItsSeries) {
    // e / (1 - a), by light paths alone and by all three ways together.
    for (const Integrator integrator : {Integrator::LIGHT, Integrator::PATH_LIGHT}) {
        TestScene scene;
        scene.build.material("wall", "Kd 0.5 0.5 0.5\nKe 1 1 1")
            .use("wall")
            .box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
        if (integrator == Integrator::PATH_LIGHT)
            scene.build.material("glass", "Ni 1.5\nillum 7")
                .use("glass")
                .box({-0.9, -0.9, -0.9}, {-0.6, -0.6, -0.6});
        scene.look({0.1, 0.2, 0.7}, {0.2, -0.1, -0.5}, 70);
        scene.options.transport.integrator = integrator;
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), 2, 1e-2)) << name_of(integrator);
    }
}

TEST(WeightedSplats, ChangeNoMeanUnderAnyKindOfLight) {
    for (const Lighting& lighting : lightings()) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.options.transport.roulette_depth = 1; // it has no part in the weights
        // Of points and suns without a disc, `path` does not find what comes by mirrors and smooth glass;
        // `light` does, where the eye sees none.
        if (lighting.is_delta)
            room.add_hidden_mirrors();
        else
            room.add_caustics();
        expect_equal(
            tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
            tile_means(room, room.options, lighting.is_delta ? Integrator::LIGHT : Integrator::PATH, ""),
            0.08);
    }
}

// What has a density and casts caustics is found from both ends, and by connections to the lights, too.
TEST(WeightedSplats, ChangeNoMeanAroundSharpReflections) {
    for (const Lighting& lighting : lightings()) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.add_sharp_reflections();
        room.options.sampling.spp = 2048;
        expect_equal(tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
                     tile_means(room, room.options, Integrator::PATH, ""), 0.05);
    }
}

// The normal of a facet differs from that of its corners by more than the reflection is wide.
TEST(WeightedSplats, ChangeNoMeanAroundCoarseBallsOfSharpMetal) {
    Room room;
    room.build.material("sharp", "Kd 0.9 0.8 0.6\nPm 1\nPr 0.1").use("sharp");
    room.build.icosphere({-0.4, 0.5, 0.6}, 0.4, 1, Facing::OUTWARD, Shading::SMOOTH);
    room.build.use("lamp").polygon({{-1.2, 1.2, 0.4}, {-0.4, 1.2, 0.4}, {-0.4, 1.2, 1.2}, {-1.2, 1.2, 1.2}});
    room.options.sampling.spp = 4096;
    expect_equal(tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
                 tile_means(room, room.options, Integrator::PATH, ""), 0.03);
}

TEST(WeightedSplats, GoOnWithoutWhatHasCastTheCaustics) {
    Room room;
    room.build.material("sharp", "Kd 0.9 0.8 0.6\nPm 1\nPr 0.1").use("sharp");
    room.build.polygon({{2.6, 0.01, -1}, {2.6, 2, -1}, {2.6, 2, 2}, {2.6, 0.01, 2}});
    room.options.light.suns.push_back({{-1, 1, 0.3}, {3, 3, 3}, 5});
    room.options.effects.off = EFFECT_GLOSSY;
    room.options.sampling.spp = 256;
    expect_equal(tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
                 tile_means(room, room.options, Integrator::PATH, ""), 0.05);
}

TEST(WeightedSplats, ChangeNoMeanWhereCastersHideEachOtherAndEncloseLamps) {
    // Panes one behind the other as the lights see them, a mirror above the lamp's plane, a lamp in a glass.
    for (const bool is_distant : {false, true}) {
        SCOPED_TRACE(is_distant);
        Room room;
        if (is_distant)
            room.options.light.suns.push_back({{0, 2, 0.1}, {3, 2, 1}, 15});
        else {
            room.build.use("lamp").polygon({{-0.2, 3, 0.4}, {0.2, 3, 0.4}, {0.2, 3, 0.8}, {-0.2, 3, 0.8}});
            room.build.use("lamp").box({-1.05, 0.65, -0.05}, {-0.95, 0.75, 0.05});
            room.build.use("glass").box({-1.2, 0.5, -0.2}, {-0.8, 0.9, 0.2});
        }
        room.build.use("glass").box({-0.4, 2.3, 0.2}, {0.4, 2.35, 1}).box({-0.4, 0.9, 0.2}, {0.4, 0.95, 1});
        room.build.use("mirror").box({-1.2, 3.2, -1.2}, {-1, 3.4, -1});
        room.options.sampling.spp = 2048;
        expect_equal(tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
                     tile_means(room, room.options, Integrator::PATH, ""), 0.08);
    }
}

TEST(WeightedSplats, LeaveBentNormalsAndCurvedFacetsToTheEye) {
    Room room;
    room.add_lamp();
    room.add_caustics();
    room.add_bent_normals();
    room.options.sampling.spp = 2048;
    expect_equal(tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
                 tile_means(room, room.options, Integrator::PATH, ""), 0.05);
}

TEST(WeightedSplats, SeeLampsBelowCoatsAsPathsFromTheEyeDo) {
    Room room;
    room.build.material("coated", "Kd 0.3 0.3 0.3\nKe 6 5 4\nPc 1\nPcr 0.3").use("coated");
    room.build.polygon({{-0.6, 2, -0.6}, {0.6, 2, -0.6}, {0.6, 2, 0.6}, {-0.6, 2, 0.6}});
    expect_equal(tile_means(room, room.options, Integrator::LIGHT, ""),
                 tile_means(room, room.options, Integrator::PATH, ""), 0.08);
}

TEST(WeightedSplats, AreLeftOutWhereThereAreNoCaustics) {
    for (const bool is_glossy : {false, true}) {
        Room room;
        room.add_lamp();
        room.options.light.environment = glm::dvec3(0.1, 0.2, 0.3);
        if (is_glossy) // a mirror, but nothing that scatters the light that it sends on
            room.options.transport.max_depth = 2, room.add_caustics();
        room.options.sampling.spp = 16;
        room.options.transport.integrator = Integrator::PATH;
        const Film path = room.render().film;
        room.options.transport.integrator = Integrator::PATH_LIGHT;
        EXPECT_TRUE(room.render().film.sums == path.sums) << is_glossy;
    }
}

TEST(WeightedSplats, TakeTheNoiseFromCaustics) {
    // Beside the view, a ball of glass below a lamp, or metal that is all but a mirror in the sun.
    for (const bool is_metal : {false, true}) {
        SCOPED_TRACE(is_metal);
        Room room;
        if (is_metal) {
            room.options.light.suns.push_back({{-1, 1, 0.3}, {3, 3, 3}, 0.5});
            room.build.material("polished", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.1").use("polished");
            room.build.polygon({{2.6, 0.01, -1}, {2.6, 2, -1}, {2.6, 2, 2}, {2.6, 0.01, 2}});
        } else {
            room.build.use("lamp").polygon(
                {{-0.1, 3.9, 0.4}, {0.1, 3.9, 0.4}, {0.1, 3.9, 0.6}, {-0.1, 3.9, 0.6}});
            room.build.use("glass").icosphere({0, 3.2, 0.5}, 0.4, 3);
        }
        const auto variance = [&](Integrator integrator) {
            double sum = 0;
            for (const double of_tile : tile_means(room, room.options, integrator, "").variance)
                sum += of_tile;
            return sum;
        };
        EXPECT_LT(variance(Integrator::PATH_LIGHT), 0.1 * variance(Integrator::PATH));
    }
}

} // namespace clrt
