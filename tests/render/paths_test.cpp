// SPDX-License-Identifier: Apache-2.0
// Path notation in pictures: expressions that share no path add up to the whole, each shows what a closed
// form says, and what they exclude costs no ray.
#include "film/film_identity.h"
#include "probes/closed_forms.h"
#include "render/kernels.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numeric>

namespace clrt {

namespace {

std::uint64_t samples(const TestScene& scene) {
    return std::uint64_t(scene.options.film.size.x) * std::uint64_t(scene.options.film.size.y) *
           *scene.options.sampling.spp;
}

/// Renders the paths of an expression.
Render render_paths(TestScene& scene, const std::string& paths) {
    scene.options.transport.paths = paths;
    return scene.render();
}

Estimate estimate_paths(TestScene& scene, const std::string& paths) {
    return film_estimate(render_paths(scene, paths).film);
}

/// A scene of this file: all its expressions share the program of its effects, which is a small and fast one.
class PathScene : public TestScene {
public:
    PathScene() { options.effects.all = false; }
};

/// Every letter of the notation: floor of two lobes, mirror, smooth and frosted glass, and all four kinds of
/// light. Without rough lobes the classic integrators have the same light.
class AllLetters : public PathScene {
public:
    explicit AllLetters(bool has_rough = true) {
        std::vector<float> sky;
        for (int i = 0; i < 32; ++i)
            sky.insert(sky.end(), {0.2f + 0.1f * float(i % 5), 0.3f, 0.2f * float(i % 3)});
        texture("sky.exr", 8, 4, 3, sky);
        build.material("floor",
                       has_rough ? "Kd 0.4 0.3 0.2\nKs 0.3 0.4 0.5\nNs 20\nillum 2" : "Kd 0.4 0.3 0.2");
        build.material("wall", "Kd 0.6 0.2 0.1").material("metal", "Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.7\nillum 3");
        build.material("glass", "Ni 1.5\nTf 0.9 1 0.9\nillum 7")
            .material("frosted", has_rough ? "Ni 1.4\nillum 7\nPr 0.5" : "Kd 0.3 0.3 0.6");
        build.material("lamp", "Kd 0.2 0.2 0.2\nKe 2 3 4");
        build.use("floor").floor(2).use("wall").polygon(
            {{-2, 0, -1.5}, {2, 0, -1.5}, {2, 2, -1.5}, {-2, 2, -1.5}});
        build.use("metal").box({0.5, 0.01, -1}, {1.2, 0.8, -0.3});
        build.use("glass").icosphere({-0.6, 0.45, -0.2}, 0.4, 2, Facing::OUTWARD, Shading::SMOOTH);
        build.use("frosted").box({-0.1, 0.01, 0.3}, {0.4, 0.4, 0.7});
        build.use("lamp").polygon({{-0.5, 1.9, -0.5}, {0.5, 1.9, -0.5}, {0.5, 1.9, 0.5}, {-0.5, 1.9, 0.5}});
        options.light.environment_file = folder.file("sky.exr");
        options.light.suns.push_back({{1, 2, 1}, {1, 1, 0.5}, 20});
        options.light.points.push_back({{-1, 1.5, 1}, {1, 1, 2}});
        options.transport.max_depth = 8;
        options.sampling.spp = 2048;
        look({0, 1.2, 3}, {0, 0.6, 0}, 60);
    }
};

/// A room of two colours with a lamp and a box: one kind of light, matte.
class Room : public PathScene {
public:
    Room() {
        build.material("white", "Kd 0.7 0.7 0.7").material("red", "Kd 0.6 0.1 0.1");
        build.material("lamp", "Kd 0 0 0\nKe 8 7 5");
        build.use("white").box({-1, 0, -1}, {1, 2, 1}, Facing::INWARD);
        build.use("lamp").polygon({{-0.4, 1.9, -0.4}, {0.4, 1.9, -0.4}, {0.4, 1.9, 0.4}, {-0.4, 1.9, 0.4}});
        build.use("red").box({-0.5, 0.01, -0.5}, {0.1, 0.8, 0.2});
        look({0.2, 1, 0.9}, {0, 0.7, -1}, 100);
        options.sampling.spp = 64;
        options.sampling.replicates = 8;
    }
};

/// A slab of glass under a sky of radiance 1, seen head on.
class SlabUnderSky : public PathScene {
public:
    SlabUnderSky() {
        build.material("glass", "Ni 1.5\nillum 7").use("glass").box({-60, -60, -0.5}, {60, 60, 0.5});
        options.light.environment = glm::dvec3(1);
        options.sampling.spp = 64;
        look_at_point({0, 0, 5}, {0, 0, 0});
    }
};

/// A floor that the camera sees at 45 degrees under a sky of radiance 1.
class FloorUnderSky : public PathScene {
public:
    explicit FloorUnderSky(const std::string& keys) {
        build.material("m", keys).use("m").floor(50);
        options.light.environment = glm::dvec3(1);
        look_at_point({1, 1, 0}, {0, 0, 0});
    }
};

/// Added to an expression without G: then D is matte alone. No path is as long.
const std::string MATTE_ALONE = "|L" + std::string(30, 'G') + "E";

/// Sums of all replicates, as a layer has them.
std::vector<std::int64_t> folded(const Film& film) {
    const size_t plane = size_t(film.width) * size_t(film.height) * 3;
    std::vector<std::int64_t> sums(plane, 0);
    for (size_t i = 0; i < film.sums.size(); ++i)
        sums[i % plane] += film.sums[i];
    return sums;
}

size_t count_differences(const std::vector<std::int64_t>& a, const std::vector<std::int64_t>& b) {
    EXPECT_EQ(a.size(), b.size());
    size_t count = 0;
    for (size_t i = 0; i < a.size(); ++i)
        count += a[i] != b[i];
    return count;
}

/// Expects expressions that share no path to add up to the picture of another, in each channel and quarter.
void expect_partition(TestScene& scene, const std::string& whole, const std::vector<std::string>& parts) {
    const Film picture = render_paths(scene, whole).film;
    std::vector<Film> films;
    for (const std::string& part : parts)
        films.push_back(render_paths(scene, part).film);
    const int half = scene.options.film.size.x / 2;
    for (const Crop& window : {Crop{0, 0, half, half}, Crop{half, 0, 2 * half, half},
                               Crop{0, half, half, 2 * half}, Crop{half, half, 2 * half, 2 * half}})
        for (int channel = 0; channel < 3; ++channel) {
            const Estimate all = film_estimate(picture, channel, window);
            double sum = 0, squares = all.error * all.error;
            for (const Film& film : films) {
                const Estimate part = film_estimate(film, channel, window);
                sum += part.mean;
                squares += part.error * part.error;
            }
            const double error = std::sqrt(squares);
            EXPECT_LT(error, 0.02 * all.mean) << "too much noise to tell";
            EXPECT_NEAR(sum, all.mean, 5 * error + 1e-5 * all.mean)
                << parts.front() << " and others, channel " << channel << " at " << window.x0 << ","
                << window.y0;
        }
}

} // namespace

TEST(Paths, DisjointExpressionsAddUpToThePicture) {
    AllLetters scene;
    // By the surface that the eye sees, and by the one that the light meets.
    expect_partition(scene, "", {"LE", "L.*DE" + MATTE_ALONE, "L.*GE", "L.*RE", "L.*TE"});
    expect_partition(scene, "L.+E", {"LD.*E" + MATTE_ALONE, "LG.*E", "LR.*E", "LT.*E"});
}

TEST(Paths, LightsAddUpToThePicture) {
    AllLetters scene;
    expect_partition(scene, "", {"La(D|S)*E", "Lp(D|S)*E", "Ld(D|S)*E", "Le(D|S)*E"});
}

TEST(Paths, TheTableOfTheSkyDoesNotChangeTheMean) {
    // The classic integrators' table holds every texel, the path tracer's only the bright ones.
    for (const char* paths : {"", "LDE", "L(D|G)E", "LS*GS*E", "L.*DE"})
        for (const int depth : {2, 8}) {
            SCOPED_TRACE(fmt::format("--paths '{}' --max-depth {}", paths, depth));
            AllLetters scene;
            scene.options.light.suns.clear();
            scene.options.light.points.clear();
            scene.options.sampling.spp = 1024;
            scene.options.transport.paths = paths;
            scene.options.transport.max_depth = depth;
            Scene bright = scene.load();
            scene.options.transport.integrator = Integrator::WHITTED;
            Scene whole = scene.load();
            scene.options.transport.integrator = Integrator::PATH;
            ASSERT_NE(scene_hash(bright), scene_hash(whole));
            const Film a = render_loaded(std::move(bright), scene.options).film;
            scene.options.sampling.seed = 1;
            const Film b = render_loaded(std::move(whole), scene.options).film;
            for (int channel = 0; channel < 3; ++channel) {
                const Estimate x = film_estimate(a, channel), y = film_estimate(b, channel);
                const double error = std::hypot(x.error, y.error);
                EXPECT_LE(std::abs(x.mean - y.mean), LARGEST_Z * error) << x.mean << " and " << y.mean;
                EXPECT_LE(error, 0.03 * y.mean) << "too noisy for this comparison";
            }
        }
}

TEST(Paths, MatteAndGlossyOfOneSurfaceAreToldApart) {
    // The floor scatters a direction by both lobes. An odd and an even number of glossy events both can go on
    // from either, so at every vertex the class of the event is chosen.
    AllLetters scene;
    const std::string even = "((D|S)*G(D|S)*G)*(D|S)*E";
    expect_partition(scene, "", {"L" + even, "L(D|S)*G" + even});
}

TEST(Paths, DirectLightIsTheClosedForm) {
    PathScene scene;
    scene.build.material("floor", "Kd 0.5 0.5 0.5")
        .material("lamp", "Kd 0 0 0\nKe 3 3 3")
        .use("floor")
        .floor(9);
    const std::vector<glm::dvec3> lamp = {{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}};
    scene.build.use("lamp").polygon(lamp);
    scene.build.use("floor").polygon(
        {{-2, 0, -9}, {-2, 5, -9}, {-2, 5, 9}, {-2, 0, 9}}); // a wall that lights the floor
    scene.look_at_point({3, 3, 0}, {0, 0, 0});
    const double direct = 0.5 / PI * 3 * polygon_irradiance({0, 0, 0}, {0, 1, 0}, lamp);
    EXPECT_TRUE(agrees(estimate_paths(scene, "LDE"), direct));
    EXPECT_GT(estimate_paths(scene, "").mean, 1.001 * direct) << "the wall should matter";
    EXPECT_EQ(estimate_paths(scene, "LE").mean, 0);
    scene.look_at_point({0, 0.5, 0}, {0, 2, 0});
    EXPECT_TRUE(agrees(estimate_paths(scene, "LE"), 3, 1e-6));
}

TEST(Paths, ReflectionAndRefractionOfGlassAreToldApart) {
    const double r = 0.04, t = 1 - r; // ((1.5 - 1) / (1.5 + 1))^2
    SlabUnderSky scene;
    EXPECT_TRUE(agrees(estimate_paths(scene, "LRE"), r, 1e-6)) << "the only way is sampled: no noise";
    EXPECT_TRUE(agrees(estimate_paths(scene, "LTTE"), t * t, 1e-6));
    EXPECT_TRUE(agrees(estimate_paths(scene, "LTRTE"), t * r * t, 1e-6));
    EXPECT_TRUE(agrees(estimate_paths(scene, "LTRRTE"), t * r * r * t, 1e-5));
    scene.options.sampling.spp = 1024;
    EXPECT_TRUE(agrees(estimate_paths(scene, "LT*E"), t * t));
    EXPECT_TRUE(agrees(estimate_paths(scene, "L(RE|TTE)"), r + t * t));
    EXPECT_EQ(estimate_paths(scene, "LTE").mean, 0) << "one refraction ends inside";
}

TEST(Paths, TotalReflectionIsReflection) {
    // Seen from inside glass at 60 degrees, beyond the critical angle of 41.8.
    PathScene scene;
    scene.build.material("glass", "Ni 1.5\nillum 7").material("lamp", "Kd 0 0 0\nKe 1 1 1");
    scene.build.use("glass").floor(50).use("lamp").floor(50, -3);
    scene.options.light.environment = glm::dvec3(5);
    scene.look_at_point({-std::sqrt(3.0), -1, 0}, {0, 0, 0});
    EXPECT_TRUE(agrees(estimate_paths(scene, "LRE"), 1, 1e-6));
    EXPECT_EQ(estimate_paths(scene, "LTE").mean, 0);
}

TEST(Paths, LobesOfOneMaterialHaveTheirOwnAlbedo) {
    constexpr double TABLE_ERROR = 1e-3; // of the loss, scattering/albedo.h
    FloorUnderSky scene("Kd 0.3 0.3 0.3\nKs 0.5 0.5 0.5\nNs 6\nillum 2");
    scene.options.transport.max_depth = 8;
    const double alpha = std::sqrt(2.0 / 8);
    // Light that the facets reflect more than once is glossy too (Kulla and Conty 2017), by the mean loss of
    // this alpha.
    const auto once = [&](double cosine) {
        return rough_reflection_albedo({alpha, alpha, cosine, 0}, [](double) { return 1.0; });
    };
    double lost = 0;
    for (double cosine = 0.025; cosine < 1; cosine += 0.05)
        lost += (1 - once(cosine)) * 2 * cosine * 0.05;
    const double seen = once(std::sqrt(0.5)),
                 glossy = 0.5 * seen + 0.25 * (1 - lost) / (1 - 0.5 * lost) * (1 - seen);
    EXPECT_TRUE(agrees(estimate_paths(scene, "LDE" + MATTE_ALONE), 0.3, 1e-6))
        << "the glossy lobe is not sampled";
    EXPECT_TRUE(agrees(estimate_paths(scene, "LDE|LGGE"), 0.3, 4e-3)) << "both classes go on: one is chosen";
    EXPECT_TRUE(agrees(estimate_paths(scene, "LGE|LDDE"), glossy, 4e-3, TABLE_ERROR));
    EXPECT_TRUE(agrees(estimate_paths(scene, "LGE"), glossy, 2e-3, TABLE_ERROR));
    EXPECT_TRUE(agrees(estimate_paths(scene, "LDE"), 0.3 + glossy, 2e-3, TABLE_ERROR))
        << "without G, D is both";
}

TEST(Paths, WhatCannotBeAcceptedCostsNoRay) {
    Room room;
    const auto rays = [&](const std::string& paths) {
        const RenderCounts counts = render_paths(room, paths).counts;
        return std::pair{counts.secondary, counts.shadow};
    };
    const auto [all_secondary, all_shadow] = rays("");
    room.options.transport.emission_rays = 1;
    EXPECT_EQ(rays("LE"), std::pair(std::uint64_t(0), std::uint64_t(0)));
    room.options.transport.emission_rays = 16; // none is cast below, where LE is not accepted
    const auto [secondary, shadow] = rays("LDE");
    EXPECT_LE(secondary, samples(room));
    EXPECT_LE(shadow, samples(room));
    EXPECT_GT(secondary, samples(room) / 2) << "the other half of multiple importance sampling";
    EXPECT_LT(secondary + shadow, (all_secondary + all_shadow) / 2);
    const auto [deep_secondary, deep_shadow] = rays("LDDE");
    EXPECT_LE(deep_secondary, 2 * samples(room));
    EXPECT_LE(deep_shadow, samples(room)) << "no shadow ray at the first surface";

    // Behind the last surface before a point light there is nothing to meet.
    room.options.light.points.push_back({{0.5, 1, 0.5}, glm::dvec3(1)});
    EXPECT_EQ(rays("LpDE").first, 0u);
    EXPECT_LE(rays("LpDDE").first, samples(room));
    EXPECT_GT(rays("LaDE").first, 0u);
}

TEST(Paths, MaximumDepthEndsWhatCannotArriveInTime) {
    Room room;
    room.options.transport.max_depth = 3;
    EXPECT_EQ(render_paths(room, "LDD+E").film.sums, render_paths(room, "LDDE").film.sums);
    const Film in_time = render_paths(room, "LDDE").film;
    room.options.transport.max_depth = 64;
    EXPECT_EQ(render_paths(room, "LDDE").film.sums, in_time.sums) << "two surfaces need three segments";
    room.options.transport.max_depth = 3;
    room.options.transport.emission_rays = 1;
    const Render lamp = render_paths(room, "LDDDE|LE");
    EXPECT_EQ(lamp.counts.secondary + lamp.counts.shadow, 0u) << "three surfaces need four segments";
    EXPECT_GT(film_estimate(lamp.film).mean, 0);
}

TEST(Paths, LayersLeaveThePictureAlone) {
    AllLetters scene;
    scene.options.sampling.spp = 64;
    scene.options.sampling.replicates = 8;
    const Render alone = scene.render();
    scene.options.output.path_layers = {
        {"direct", "LDE"}, {"glossy", "L.*G.*E"}, {"matte_first", "L.*D.G.*E"}, {"all", "L.*E"}};
    const Render layered = scene.render();
    EXPECT_EQ(alone.film.sums, layered.film.sums);
    EXPECT_EQ(alone.counts.rays(), layered.counts.rays());
    ASSERT_EQ(layered.path_layers.size(), 4u);
    // Where no class is chosen the layer of everything has the picture's bits up to a rounding a sample.
    const std::vector<std::int64_t> all = folded(layered.path_layers[3]), picture = folded(alone.film);
    double difference = 0, sum = 0;
    for (size_t i = 0; i < all.size(); ++i) {
        difference += double(all[i] - picture[i]);
        sum += double(picture[i]);
    }
    EXPECT_LT(std::abs(difference), 0.01 * sum);
    EXPECT_EQ(layered.counts.bad(), 0u);
}

TEST(Paths, ALayerHasTheBitsOfItsOwnRender) {
    Room room;
    const std::vector<std::string> expressions = {"LE", "LDE", "LDDE", "LDDD+E", "L(D|S)*E"};
    for (const std::string& expression : expressions)
        room.options.output.path_layers.push_back({"layer", expression});
    const Render layered = room.render();
    ASSERT_EQ(layered.path_layers.size(), expressions.size());
    room.options.output.path_layers.clear();
    for (size_t i = 0; i < expressions.size(); ++i) {
        const Film alone = render_paths(room, expressions[i]).film;
        EXPECT_EQ(count_differences(folded(alone), layered.path_layers[i].sums), 0u) << expressions[i];
        EXPECT_GT(std::accumulate(alone.sums.begin(), alone.sums.end(), std::int64_t(0)), 0)
            << expressions[i];
    }
}

TEST(Paths, LampsInViewSplitOffBitForBit) {
    // The lamp reflects nothing, so each path's light is of one part, if paths find the lamp.
    Room room;
    room.options.transport.emission_rays = 1;
    const std::vector<std::int64_t> whole = folded(render_paths(room, "").film);
    const std::vector<std::int64_t> lamp = folded(render_paths(room, "LE").film);
    std::vector<std::int64_t> sum = folded(render_paths(room, "LD+E").film);
    for (size_t i = 0; i < sum.size(); ++i)
        sum[i] += lamp[i];
    EXPECT_EQ(count_differences(sum, whole), 0u);
    EXPECT_NE(count_differences(lamp, whole), 0u);
}

TEST(Paths, LayersEqualTheirOwnRendersInTheMean) {
    AllLetters scene;
    scene.options.output.path_layers = {{"a", "LDE"}, {"b", "L.*DG.*E"}, {"c", "LS*GE"}, {"d", "Ld.*E"}};
    const std::vector<PathLayerOption> layers = scene.options.output.path_layers;
    const Render layered = scene.render();
    scene.options.output.path_layers.clear();
    scene.options.sampling.seed = 1;
    // In every channel: matte and glossy parts have other colours, which is what a class weighs beside its
    // chance.
    for (const PathLayerOption& layer : layers) {
        const Film film = render_paths(scene, layer.expression).film;
        for (int channel = 0; channel < 3; ++channel) {
            const Estimate alone = film_estimate(film, channel);
            const double value = film_estimate(layered.path_layers[&layer - layers.data()], channel).mean;
            EXPECT_LT(alone.error, 0.02 * alone.mean) << layer.expression;
            EXPECT_NEAR(value, alone.mean, 10 * alone.error) << layer.expression << " channel " << channel;
        }
    }
}

TEST(Paths, ALayerIsAPartOfThePicture) {
    Room room;
    room.options.output.path_layers = {{"rest", "LDD+E"}, {"direct", "LDE"}};
    const Render render = render_paths(room, "LDE");
    EXPECT_EQ(film_estimate(render.path_layers[0]).mean, 0);
    EXPECT_EQ(count_differences(render.path_layers[1].sums, folded(render.film)), 0u);
}

TEST(Paths, RayCastingIsItsLanguage) {
    // Matte and delta lobes; every kind of light.
    AllLetters scene(false);
    scene.options.sampling.spp = 4096;
    scene.options.transport.max_depth = 2;
    const Film paths = render_paths(scene, "LD?E").film;
    scene.options.transport.paths.clear();
    scene.options.transport.integrator = Integrator::RAYCAST;
    const Film rays = scene.render().film;
    for (int channel = 0; channel < 3; channel += 2) {
        const Estimate path = film_estimate(paths, channel), cast = film_estimate(rays, channel);
        const double error = std::hypot(path.error, cast.error);
        EXPECT_LT(error, 5e-3 * path.mean);
        EXPECT_NEAR(path.mean, cast.mean, 5 * error);
    }
}

TEST(Paths, WhittedIsItsLanguage) {
    AllLetters scene(false);
    scene.options.sampling.spp = 4096;
    scene.options.transport.min_contribution = 0;
    for (const int depth : {3, 7}) {
        scene.options.transport.max_depth = depth;
        scene.options.transport.integrator = Integrator::PATH;
        const Estimate path = estimate_paths(scene, "LD?S*E");
        const Estimate all = estimate_paths(scene, "");
        scene.options.transport.paths.clear();
        scene.options.transport.integrator = Integrator::WHITTED;
        const Estimate tree = film_estimate(scene.render().film);
        const double error = std::hypot(path.error, tree.error);
        EXPECT_LT(error, 5e-3 * path.mean);
        EXPECT_NEAR(path.mean, tree.mean, 5 * error) << depth;
        EXPECT_GT(std::abs(all.mean - tree.mean), 10 * error) << "the languages should differ here";
    }
}

TEST(Paths, OpenSkyOnClayIsAmbientOcclusion) {
    // At the distance d from an endless wall of the height h the floor sees (1 + d / sqrt(d^2 + h^2)) / 2 of
    // the sky, by the cosine; lamps and what they light have no part in it.
    for (const double height : {0.5, 2.0, 1e4})
        for (const double distance : {0.4, 1.0}) {
            PathScene scene;
            scene.build.material("red", "Kd 0.7 0.1 0.1").material("lamp", "Kd 0 0 0\nKe 9 9 9");
            scene.build.use("red").floor(1e5);
            scene.build.polygon({{-1e5, 0, 0}, {1e5, 0, 0}, {1e5, height, 0}, {-1e5, height, 0}});
            scene.build.use("lamp").polygon({{2, 0, 3}, {3, 0, 3}, {3, 0.01, 3}, {2, 0.01, 3}});
            scene.options.scene.material_override = MaterialOverride::CLAY;
            scene.options.light.environment = glm::dvec3(1.25); // over the reflectance of clay
            scene.look_at_point({0, 3, distance + 3}, {0, 0, distance});
            const double open = 0.5 + 0.5 * distance / std::hypot(distance, height);
            const Film film = render_paths(scene, "LeDE").film;
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_TRUE(agrees(film_estimate(film, channel), open, 5e-3)) << height << ", " << distance;
        }
}

} // namespace clrt
