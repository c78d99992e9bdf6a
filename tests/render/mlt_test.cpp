// SPDX-License-Identifier: Apache-2.0
// Metropolis light transport: its mean is that of `path` under every kind of light and however short its
// chains are, its bits are those of its samples, and nothing breaks where there is little light or none.
#include "film/film_error.h"
#include "probes/film_estimate.h"
#include "probes/statistics.h"
#include "render/chain_starts.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace clrt {

namespace {

/// A room with a lamp, a mirror and a ball of glass; a caustic on the floor.
struct CausticRoom : TestScene {
    CausticRoom() {
        build.material("matte", "Kd 0.6 0.5 0.4").material("mirror", "Ks 0.9 0.8 0.7\nillum 3");
        build.material("glass", "Ni 1.5\nillum 7").material("lamp", "Kd 0 0 0\nKe 12 10 8");
        build.use("matte").floor(3);
        build.polygon({{-3, 0, -2}, {3, 0, -2}, {3, 3, -2}, {-3, 3, -2}});
        build.use("mirror").box({-1.2, 0.01, -1.2}, {-0.7, 1.1, -0.8});
        build.use("glass").icosphere({0.5, 0.6, 0.3}, 0.4, 2);
        build.use("lamp").raw("o lamp").polygon(
            {{-0.3, 2, -0.3}, {0.3, 2, -0.3}, {0.3, 2, 0.3}, {-0.3, 2, 0.3}});
        look({0, 1.6, 4}, {0, 0.7, 0}, 50);
        options.film.size = {32, 32};
        options.sampling.spp = 1024;
        options.sampling.replicates = 8;
        options.transport.integrator = Integrator::MLT;
        options.transport.max_depth = 6;
        options.light.environment = glm::dvec3(0);
    }
};

/// Whether chains bring what `other` does, in every tile, to `sharpness` of the picture's mean.
void expect_chains_agree(const TestScene& scene, Integrator other, double sharpness) {
    const TileMeans a = tile_means(scene, scene.options, Integrator::MLT, ""),
                    b = tile_means(scene, scene.options, other, "");
    double mean = 0, noise = 0;
    for (size_t i = 0; i < a.mean.size(); ++i) {
        mean += b.mean[i] / double(b.mean.size());
        const double variance = a.variance[i] + b.variance[i];
        noise += variance / double(b.mean.size());
        if (variance == 0)
            EXPECT_NEAR(a.mean[i], b.mean[i], 1e-5 * b.mean[i]) << "tile " << i;
        else
            EXPECT_LT(std::abs(a.mean[i] - b.mean[i]) / std::sqrt(variance), LARGEST_Z)
                << "tile " << i << ": " << a.mean[i] << ", expected " << b.mean[i];
    }
    EXPECT_LT(std::sqrt(noise), sharpness * mean) << "too noisy to tell them apart";
}

/// Means of the whole picture over many seeds, each with its own start.
Moments means_over_seeds(const TestScene& scene, int seeds) {
    Options options = scene.options;
    const Scene loaded = scene.load();
    std::vector<double> means;
    for (int seed = 0; seed < seeds; ++seed) {
        options.sampling.seed = std::uint32_t(seed);
        means.push_back(film_estimate(render_loaded(loaded, options).film).mean);
    }
    return moments_of(means);
}

} // namespace

TEST(Mlt, ChangesNoMeanUnderAnyKindOfLight) {
    const std::pair<const char*, void (*)(CausticRoom&)> lightings[] = {
        {"lamp", [](CausticRoom&) {}},
        {"sky", [](CausticRoom& room) { room.options.light.environment = glm::dvec3(0.5, 1, 1.5); }},
        {"disc",
         [](CausticRoom& room) {
             room.options.light.suns.push_back({{-1, 2, 1.5}, {3, 2, 1}, 20});
         }},
        {"map", [](CausticRoom& room) {
             std::vector<float> texels;
             for (int i = 0; i < 8 * 4 * 3; ++i)
                 texels.push_back(i / 3 == 12 ? 30.0f : 0.2f + 0.1f * float(i * 7 % 5));
             room.texture("sky.exr", 8, 4, 3, texels);
             room.options.light.environment.reset();
             room.options.light.environment_file = room.folder.file("sky.exr");
         }}};
    for (const auto& [name, add] : lightings) {
        SCOPED_TRACE(name);
        CausticRoom room;
        add(room);
        expect_chains_agree(room, Integrator::PATH, 0.15);
    }
}

TEST(Mlt, FindsWhatPathsFromTheEyeCannot) {
    CausticRoom room; // point lights behind glass
    room.options.light.points.push_back({{0.5, 1.8, 0.3}, {4, 5, 6}});
    expect_chains_agree(room, Integrator::PATH_LIGHT, 0.15);
}

TEST(Mlt, ThroughLensAndFilterAndInAWindow) {
    CausticRoom room;
    room.options.film.filter = Filter::GAUSSIAN;
    room.options.film.filter_radius = 1.5;
    room.options.camera.aperture = 0.05;
    room.options.film.size = {48, 40};
    room.options.film.crop = Crop{8, 4, 40, 36};
    expect_chains_agree(room, Integrator::PATH, 0.15);
}

// What short chains get wrong if they start anywhere, or if their scale is that of other replicates.
TEST(Mlt, HasNoStartUpBiasHoweverFewItsSteps) {
    CausticRoom room;
    room.options.film.size = {16, 16};
    room.options.sampling.replicates = 4;
    room.options.transport.max_depth = 4;
    room.options.sampling.spp = 4; // each chain walks one sample
    const Moments mlt = means_over_seeds(room, 160);
    room.options.transport.integrator = Integrator::PATH;
    room.options.sampling.spp = 1024;
    const Moments path = means_over_seeds(room, 4);
    const double error = std::sqrt(mlt.variance_of_mean() + path.variance_of_mean());
    EXPECT_LT(error, 0.02 * path.mean);
    EXPECT_NEAR(mlt.mean, path.mean, 3.5 * error);
}

TEST(Mlt, ABlackSceneIsBlack) {
    TestScene dark;
    dark.build.material("matte", "Kd 0.6 0.5 0.4").use("matte").floor(3);
    dark.options.light.points.push_back({{0, -5, 0}, {4, 4, 4}}); // below the floor
    dark.options.light.environment = glm::dvec3(0);
    dark.options.transport.integrator = Integrator::MLT;
    dark.options.film.size = {16, 16};
    dark.options.sampling.spp = 16;
    dark.look({0, 1.6, 4}, {0, 0, 0}, 30);
    const Render render = dark.render();
    EXPECT_EQ(render.counts.bad(), 0u);
    EXPECT_EQ(render.chains.small + render.chains.large, 0u);
    EXPECT_EQ(std::count(render.film.sums.begin(), render.film.sums.end(), 0), long(render.film.sums.size()));
}

// A picture in which one narrow path is all the light.
TEST(Mlt, KeepsToOneBrightPath) {
    TestScene scene;
    scene.build.material("matte", "Kd 0.6 0.6 0.6").use("matte").floor(3);
    scene.build.polygon({{-3, 0.5, -3}, {-3, 0.5, 3}, {-0.05, 0.5, 3}, {-0.05, 0.5, -3}});
    scene.build.polygon({{0.05, 0.5, -3}, {0.05, 0.5, 3}, {3, 0.5, 3}, {3, 0.5, -3}});
    scene.options.light.suns.push_back({{0, 1, 0}, {3, 3, 3}, 0});
    scene.options.light.environment = glm::dvec3(0);
    scene.options.transport.integrator = Integrator::MLT;
    scene.options.transport.max_depth = 3;
    scene.options.film.size = {16, 16};
    scene.options.sampling.spp = 256;
    scene.look({0, 0.3, 2.5}, {0, 0, 0}, 60);
    expect_chains_agree(scene, Integrator::PATH, 0.15);
    const Render render = scene.render();
    const auto rate = [](std::uint64_t taken, std::uint64_t of) { return double(taken) / double(of); };
    EXPECT_GT(rate(render.chains.taken_small, render.chains.small), 0.3);
    EXPECT_LT(rate(render.chains.taken_large, render.chains.large),
              rate(render.chains.taken_small, render.chains.small));
}

TEST(Mlt, LightStaysWhereItIs) {
    TestScene scene;
    scene.build.material("red", "Kd 0.8 0 0").material("blue", "Kd 0 0 0.05");
    scene.build.use("red").polygon({{-2, 0, 2}, {0, 0, 2}, {0, 0, -2}, {-2, 0, -2}});
    scene.build.use("blue").polygon({{0, 0, 2}, {2, 0, 2}, {2, 0, -2}, {0, 0, -2}});
    scene.options.light.environment = glm::dvec3(1);
    scene.options.transport.integrator = Integrator::MLT;
    scene.options.transport.max_depth = 2;
    scene.options.film.size = {16, 16};
    scene.options.sampling.spp = 64;
    scene.options.sampling.replicates = 4;
    scene.look({0, 3, 0.01}, {0, 0, 0}, 50);
    const Film film = scene.render().film;
    const Crop left{0, 0, 7, 16}, right{9, 0, 16, 16};
    EXPECT_GT(film_estimate(film, 0, left).mean, 0.5);
    EXPECT_GT(film_estimate(film, 2, right).mean, 0.03);
    EXPECT_EQ(film_estimate(film, 2, left).mean, 0);
    EXPECT_EQ(film_estimate(film, 0, right).mean, 0);
}

// What is found by few of the new paths has an uncertain mean score, though chains show it smoothly.
TEST(Mlt, TheErrorKnowsTheMeanScore) {
    TestScene scene;
    scene.build.material("matte", "Kd 0.6 0.6 0.6").use("matte").floor(3);
    scene.build.polygon({{-3, 0.5, -3}, {-3, 0.5, 3}, {-0.005, 0.5, 3}, {-0.005, 0.5, -3}});
    scene.build.polygon({{0.005, 0.5, -3}, {0.005, 0.5, 3}, {3, 0.5, 3}, {3, 0.5, -3}});
    scene.options.light.suns.push_back({{0, 1, 0}, {3, 3, 3}, 0});
    scene.options.light.environment = glm::dvec3(0);
    scene.options.transport.integrator = Integrator::MLT;
    scene.options.transport.max_depth = 2;
    scene.options.film.size = {16, 16};
    scene.options.sampling.replicates = 4;
    scene.options.sampling.spp = 64;
    scene.look({0, 0.3, 2.5}, {0, 0, 0}, 60);
    const Scene loaded = scene.load();
    std::vector<double> means, variances;
    for (std::uint32_t seed = 0; seed < 64; ++seed) {
        scene.options.sampling.seed = seed;
        const Estimate picture = film_estimate(render_loaded(loaded, scene.options).film);
        means.push_back(picture.mean);
        variances.push_back(picture.error * picture.error);
    }
    const double ratio = moments_of(variances).mean / moments_of(means).variance;
    std::printf("variance estimated over true %.2f, error %.2f %%\n", ratio,
                100 * std::sqrt(moments_of(means).variance) / moments_of(means).mean);
    EXPECT_GT(ratio, 0.6);
    EXPECT_LT(ratio, 1.7);
}

TEST(Mlt, OneSegmentIsWhatTheCameraSees) {
    CausticRoom room;
    room.options.transport.max_depth = 1;
    room.options.sampling.spp = 8;
    const Render mlt = room.render();
    room.options.transport.integrator = Integrator::PATH;
    room.options.transport.emission_rays = 1;
    EXPECT_TRUE(mlt.film.sums == room.render().film.sums);
}

TEST(Mlt, TheSameSamplesAreTheSameBits) {
    CausticRoom room;
    room.options.sampling.spp = 48;
    EXPECT_TRUE(room.render().film.sums == room.render().film.sums);
    const Film film = room.render().film;
    room.options.sampling.seed = 1;
    EXPECT_FALSE(room.render().film.sums == film.sums);
}

// Chains are not kept in a film: a render that goes on begins new ones.
TEST(Mlt, GoesOnWithNewChains) {
    CausticRoom room;
    room.options.film.size = {16, 16};
    room.options.sampling.replicates = 4;
    room.options.transport.max_depth = 4;
    const Scene loaded = room.load();
    const auto resumed = [&](std::uint32_t seed, std::uint32_t first, std::uint32_t end) {
        room.options.sampling.seed = seed;
        room.options.sampling.spp = first;
        const RenderProgress part = render_loaded(loaded, room.options);
        room.options.sampling.spp = end;
        RenderHooks hooks;
        hooks.resume = &part;
        Progress progress(Toggle::OFF, true);
        return render(prepare_loaded(test_device(), loaded, room.options), progress, hooks);
    };
    const Render once = resumed(1, 6, 16);
    EXPECT_EQ(film_samples(once.film), 16u);
    EXPECT_TRUE(once.film.sums == resumed(1, 6, 16).film.sums);
    EXPECT_FALSE(once.film.sums == resumed(1, 8, 16).film.sums);

    std::vector<double> means;
    for (std::uint32_t seed = 0; seed < 48; ++seed)
        means.push_back(film_estimate(resumed(seed, 6, 24).film).mean);
    const Moments mlt = moments_of(means);
    room.options.transport.integrator = Integrator::PATH;
    room.options.sampling.spp = 1024;
    const Moments path = means_over_seeds(room, 4);
    const double error = std::sqrt(mlt.variance_of_mean() + path.variance_of_mean());
    EXPECT_LT(error, 0.02 * path.mean);
    EXPECT_NEAR(mlt.mean, path.mean, 3.5 * error);
}

TEST(Mlt, SamplesOfOtherNumbersAreOthers) {
    CausticRoom room;
    room.options.sampling.spp = 16;
    const Film film = room.render().film;
    room.options.sampling.first_sample = 16;
    EXPECT_FALSE(room.render().film.sums == film.sums);
}

TEST(Mlt, TellsThatMaxDepthCutsPaths) {
    CausticRoom room;
    room.options.sampling.spp = 16;
    EXPECT_GT(room.render().counts.cut_paths, 0u);
}

TEST(ChainStarts, AreDrawnInProportionToScores) {
    const std::vector<float> scores = {0, 1, 0, 3, 4, 0};
    const ChainStarts starts = choose_starts(scores.data(), scores.size(), 8, 0.5);
    EXPECT_EQ(starts.sum, 8);
    EXPECT_EQ(starts.numbers, (std::vector<u32>{1, 3, 3, 3, 4, 4, 4, 4}));
    const std::vector<float> one = {0, 0, 7};
    EXPECT_EQ(choose_starts(one.data(), 3, 2, 0.999999).numbers, (std::vector<u32>{2, 2}));
    EXPECT_EQ(choose_starts(one.data(), 2, 2, 0).numbers, (std::vector<u32>{NO_INDEX, NO_INDEX}));
    // Each of ten paths of the same score is drawn in three of ten offsets' worth.
    const std::vector<float> even(10, 0.1f);
    std::vector<int> drawn(10);
    for (int i = 0; i < 100; ++i)
        for (const u32 number : choose_starts(even.data(), 10, 3, (i + 0.5) / 100).numbers)
            ++drawn[number];
    for (const int times : drawn)
        EXPECT_NEAR(times, 30, 1);
}

} // namespace clrt
