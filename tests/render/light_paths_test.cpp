// SPDX-License-Identifier: Apache-2.0
// Light paths: alone (`light`) they bring every path but those that the eye sees by a mirror or smooth glass;
// under one weighting with paths from the eye (`path+light`) they change no mean. Compared with `path`
// restricted to the same paths, tile by tile, under every kind of light.
#include "film/merge_films.h"
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// What `light` finds.
const char* const BY_LIGHT_PATHS = "LE|L(D|S)*DE";

struct TileMeans {
    std::vector<double> mean, variance;
};

/// Mean and squared standard error of each tile of 8 x 8 pixels and channel, over the replicates.
TileMeans tile_means(const TestScene& scene, Options options, Integrator integrator, const char* paths) {
    options.transport.integrator = integrator;
    options.transport.paths = paths;
    const Render render = render_loaded(scene.load(), options);
    EXPECT_EQ(render.counts.bad(), 0u) << name_of(integrator);
    TileMeans tiles;
    for (int y = 0; y < render.film.height; y += 8)
        for (int x = 0; x < render.film.width; x += 8)
            for (int channel = 0; channel < 3; ++channel) {
                const Estimate tile = film_estimate(render.film, channel, {x, y, x + 8, y + 8});
                tiles.mean.push_back(tile.mean);
                tiles.variance.push_back(tile.error * tile.error);
            }
    return tiles;
}

/// Whether two integrators agree in every tile, to `sharpness` of the picture's mean.
void expect_equal(const TileMeans& a, const TileMeans& b, double sharpness) {
    double squares = 0, mean = 0, noise = 0;
    for (size_t i = 0; i < a.mean.size(); ++i) {
        mean += b.mean[i] / double(b.mean.size());
        noise += (a.variance[i] + b.variance[i]) / double(b.mean.size());
        if (a.variance[i] + b.variance[i] == 0) {
            EXPECT_NEAR(a.mean[i], b.mean[i], 1e-5 * b.mean[i]) << "tile " << i;
            continue;
        }
        const double z = (a.mean[i] - b.mean[i]) / std::sqrt(a.variance[i] + b.variance[i]);
        EXPECT_LT(std::abs(z), LARGEST_Z) << "tile " << i << ": " << a.mean[i] << ", expected " << b.mean[i];
        squares += z * z;
    }
    // Channels are nearly alike: the squares of 16 tiles have a mean of 1 +- 0.35.
    EXPECT_LT(squares / double(a.mean.size()), 2.8);
    EXPECT_LT(std::sqrt(noise), sharpness * mean) << "too noisy to tell them apart";
}

/// A floor and a wall with plates of metal and rough glass in front of the camera; no light.
struct Room : TestScene {
    Room() {
        build.material("matte", "Kd 0.6 0.5 0.4").material("metal", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.4");
        build.material("frosted", "Ni 1.5\nillum 7\nPr 0.4").material("mirror", "Ks 0.9 0.8 0.7\nillum 3");
        build.material("glass", "Ni 1.5\nillum 7").material("lamp", "Kd 0 0 0\nKe 6 5 4");
        build.use("matte").floor(3);
        build.polygon({{-3, 0, -2}, {3, 0, -2}, {3, 3, -2}, {-3, 3, -2}});
        build.use("metal").polygon(
            {{-1.5, 0.05, 0.5}, {-0.5, 0.05, 0.5}, {-0.5, 0.5, -0.5}, {-1.5, 0.5, -0.5}});
        build.use("frosted").box({0.3, 0.01, -0.5}, {1.2, 0.6, 0.3});
        look({0, 1.6, 4}, {0, 0.7, 0}, 50);
        options.film.size = {32, 32};
        options.sampling.spp = 512;
        options.transport.max_depth = 6;
        options.light.environment = glm::dvec3(0);
    }
    void add_lamp() {
        build.use("lamp").raw("o lamp").polygon(
            {{-0.6, 2, -0.6}, {0.6, 2, -0.6}, {0.6, 2, 0.6}, {-0.6, 2, 0.6}});
    }
    /// Mirrors beside the view that throw caustics into it.
    void add_hidden_mirrors() {
        for (const double x : {-2.6, 2.6})
            build.use("mirror").polygon({{x, 0.01, -1}, {x, 2, -1}, {x, 2, 2}, {x, 0.01, 2}});
    }
    /// Bodies that throw caustics.
    void add_caustics() {
        build.use("mirror").box({-0.4, 0.01, -1.4}, {0.2, 1.1, -1.1});
        build.use("glass").box({0.1, 0.9, 0.0}, {0.9, 1.2, 0.8});
    }
};

/// A way to light a room.
struct Lighting {
    const char* name;
    std::function<void(Room&)> add;
};

const Lighting LIGHTINGS[] = {
    {"lamp", [](Room& room) { room.add_lamp(); }},
    {"two-sided",
     [](Room& room) {
         room.options.light.two_sided = true;
         room.build.use("lamp").polygon({{-1, 1.4, -1.2}, {1, 1.4, -1.2}, {1, 1.8, -0.9}, {-1, 1.8, -0.9}});
     }},
    {"textured",
     [](Room& room) {
         room.texture("lamp.exr", 2, 2, 3, {4, 0, 0, 0, 3, 0, 0, 0, 5, 1, 1, 1});
         room.build.material("slide", "Kd 0 0 0\nKe 2 2 2\nmap_Ke lamp.exr").use("slide");
         room.build.textured_quad({{-0.6, 2, -0.6}, {0.6, 2, -0.6}, {0.6, 2, 0.6}, {-0.6, 2, 0.6}});
     }},
    {"point",
     [](Room& room) {
         room.options.light.points.push_back({{0.5, 1.8, 1}, {4, 5, 6}});
     }},
    {"far point",
     [](Room& room) {
         room.options.light.points.push_back({{9, 18, 20}, {4000, 3000, 2000}});
     }},
    {"sun",
     [](Room& room) {
         room.options.light.suns.push_back({{-1, 2, 1.5}, {3, 2, 1}, 0});
     }},
    {"disc",
     [](Room& room) {
         room.options.light.suns.push_back({{-1, 2, 1.5}, {3, 2, 1}, 20});
     }},
    {"even sky", [](Room& room) { room.options.light.environment = glm::dvec3(1, 2, 3); }},
    {"map",
     [](Room& room) {
         std::vector<float> texels;
         for (int i = 0; i < 8 * 4; ++i)
             for (int channel = 0; channel < 3; ++channel)
                 texels.push_back(i == 12 ? 40.0f : 0.2f + 0.1f * float((i * 7 + channel) % 5));
         room.texture("sky.exr", 8, 4, 3, texels);
         room.options.light.environment.reset();
         room.options.light.environment_file = room.folder.file("sky.exr");
     }},
    {"all",
     [](Room& room) {
         room.add_lamp();
         room.options.light.points.push_back({{0.5, 1.8, 1}, {1, 1, 2}});
         room.options.light.suns.push_back({{-1, 2, 1.5}, {1, 0.5, 0.5}, 10});
         room.options.light.environment = glm::dvec3(0.3, 0.4, 0.5);
     }},
};

void expect_light_is_path(const TestScene& scene, double sharpness) {
    expect_equal(tile_means(scene, scene.options, Integrator::LIGHT, ""),
                 tile_means(scene, scene.options, Integrator::PATH, BY_LIGHT_PATHS), sharpness);
}

} // namespace

TEST(LightPaths, BringWhatPathsFromTheEyeFindOfEveryKindOfLight) {
    for (const Lighting& lighting : LIGHTINGS) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
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
    // A floor that the sun passes by, lit by a wall alone, whose map turns its normals towards sun and floor.
    TestScene scene;
    const float down = -0.5f, out = 0.8660254f; // of the normal
    scene.texture("tilt.exr", 1, 1, 3, {0.5f, 0.5f * (1 + down), 0.5f * (1 + out)});
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

TEST(LightPaths, ACropIsAPartOfThePictureToTheBit) {
    Room room;
    room.add_lamp();
    room.options.transport.integrator = Integrator::LIGHT;
    room.options.sampling.spp = 16;
    room.options.sampling.replicates = 8;
    const Film whole = room.render().film;
    room.options.film.crop = Crop{5, 9, 24, 30};
    const Film window = room.render().film;
    const auto at = [](const Film& film, int replicate, int x, int y) {
        const size_t pixel = size_t(y) * size_t(film.width) + size_t(x);
        return film.sums[size_t(replicate) * film_plane(film) + 3 * pixel];
    };
    for (int replicate = 0; replicate < 8; ++replicate)
        for (int y = 0; y < window.height; ++y)
            for (int x = 0; x < window.width; ++x)
                ASSERT_EQ(at(window, replicate, x, y), at(whole, replicate, x + 5, y + 9)) << x << "," << y;
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
    for (const Lighting& lighting : LIGHTINGS) {
        SCOPED_TRACE(lighting.name);
        Room room;
        lighting.add(room);
        room.options.transport.roulette_depth = 1; // it has no part in the weights
        // Of points and suns without a disc, `path` does not find what comes by mirrors and smooth glass;
        // `light` does, where the eye sees none.
        const bool is_delta = !room.options.light.points.empty() || lighting.name == std::string("sun");
        if (is_delta)
            room.add_hidden_mirrors();
        else
            room.add_caustics();
        expect_equal(tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
                     tile_means(room, room.options, is_delta ? Integrator::LIGHT : Integrator::PATH, ""),
                     0.08);
    }
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
    std::vector<unsigned char> heights;
    for (int i = 0; i < 8 * 8; ++i)
        heights.push_back((i % 8 + i / 8) % 3 == 0 ? 180 : 90);
    room.texture8("bump.png", 8, 8, 1, heights);
    room.build.material("bumpy", "Kd 0.7 0.7 0.7\nbump -bm 0.4 bump.png").use("bumpy");
    room.build.textured_quad({{-1.6, 0.2, -1}, {-0.6, 0.2, -1}, {-0.6, 1.2, -1}, {-1.6, 1.2, -1}});
    room.build.use("matte").icosphere({-0.7, 0.4, 0.7}, 0.3, 1, Facing::OUTWARD, Shading::SMOOTH);
    room.build.use("frosted").icosphere({0, 0.4, 1}, 0.3, 1, Facing::OUTWARD, Shading::SMOOTH);
    room.build.use("glass").icosphere({0.8, 0.4, 1}, 0.3, 1, Facing::OUTWARD, Shading::SMOOTH);
    room.options.sampling.spp = 2048;
    expect_equal(tile_means(room, room.options, Integrator::PATH_LIGHT, ""),
                 tile_means(room, room.options, Integrator::PATH, ""), 0.05);
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
    Room room;
    room.build.use("lamp").polygon({{-0.1, 3.9, 0.4}, {0.1, 3.9, 0.4}, {0.1, 3.9, 0.6}, {-0.1, 3.9, 0.6}});
    room.build.use("glass").icosphere({0, 3.2, 0.5}, 0.4, 3); // above the view
    const auto variance = [&](Integrator integrator) {
        double sum = 0;
        for (const double of_tile : tile_means(room, room.options, integrator, "").variance)
            sum += of_tile;
        return sum;
    };
    EXPECT_LT(variance(Integrator::PATH_LIGHT), 0.1 * variance(Integrator::PATH));
}

} // namespace clrt
