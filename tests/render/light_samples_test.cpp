// SPDX-License-Identifier: Apache-2.0
// Several light samples at a path's first vertex: the picture keeps its light, whoever finds it; the noise of
// many lights falls; the number is chosen where it pays.
#include "film/film_error.h"
#include "film/film_file.h"
#include "film/film_identity.h"
#include "render/light_samples_choice.h"
#include "render/render_params.h"
#include "render/reuse_choice.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A row of bays between walls, a lamp in each, seen from the aisle before them.
struct Bays : TestScene {
    explicit Bays(int lamps, const char* floor = "Kd 0.5 0.5 0.5", double smallest = 0.05) {
        build.material("white", "Kd 0.3 0.3 0.3").material("floor", floor);
        build.material("lamp", "Kd 0 0 0\nKe 20 20 20").use("floor").floor(lamps);
        build.use("white");
        for (int i = 0; i <= lamps; ++i)
            build.box({i - lamps / 2. - 0.05, 0, -1}, {i - lamps / 2. + 0.05, 1, 0});
        build.use("lamp");
        for (int i = 0; i < lamps; ++i) {
            const double x = i - lamps / 2. + 0.4, size = smallest + 0.02 * (i % 5);
            // It shines downwards.
            build.polygon(
                {{x, 0.7, -0.8}, {x + size, 0.7, -0.8}, {x + size, 0.7, -0.8 + size}, {x, 0.7, -0.8 + size}});
        }
        look({0, 1.6, 3}, {0, 0, -0.3}, 60);
        options.transport.guide = Toggle::OFF;
        options.transport.path_reuse = Toggle::OFF;
        options.film.size = {48, 32};
        options.sampling.spp = 64;
        options.sampling.replicates = 4;
        options.effects.all = false;
    }
    Render render_by(int samples, std::uint32_t seed = 0) {
        options.transport.light_samples = samples;
        options.sampling.seed = seed;
        return render();
    }
    /// The number that is chosen.
    int chosen() {
        const auto planned = plan_loaded(test_device(), load(), options);
        Progress silent(Toggle::OFF, true);
        PreparedParts parts;
        const auto pilot = choose_path_reuse(test_device(), planned, parts, silent);
        choose_light_samples(test_device(), planned, parts, pilot, silent);
        return planned->options.transport.light_samples;
    }
};

} // namespace

TEST(LightSamples, ChangeNoMean) {
    // Lamps that light samples find, large ones that paths find as well, and a gloss in which they do alone.
    struct Case {
        const char* floor;
        double smallest_lamp;
        Toggle reuse;
    };
    const char* const matte = "Kd 0.5 0.5 0.5";
    const char* const gloss = "Kd 0.1 0.1 0.1\nKs 0.8 0.8 0.8\nNs 200\nillum 2";
    for (const auto& [floor, lamp, reuse] : {Case{matte, 0.05, Toggle::OFF}, Case{matte, 0.05, Toggle::ON},
                                             Case{matte, 0.4, Toggle::OFF}, Case{gloss, 0.05, Toggle::OFF}}) {
        Bays bays(6, floor, lamp);
        bays.options.sampling.spp = 1024;
        bays.options.transport.path_reuse = reuse;
        const Film one = bays.render_by(1).film;
        for (const int samples : {2, 8})
            expect_equal_means(one, bays.render_by(samples, std::uint32_t(samples)).film,
                               std::string(floor) + ", " + std::to_string(samples));
    }
}

TEST(LightSamples, ChangeNoMeanBehindAMirror) {
    Bays bays(6);
    bays.build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3").use("mirror");
    bays.build.polygon({{-3, 0, 1}, {-3, 3, 1}, {3, 3, 1}, {3, 0, 1}});
    bays.look({0, 1.5, -3}, {0, 0.5, 1}, 60);
    bays.options.sampling.spp = 1024;
    bays.options.transport.max_depth = 3;
    const Film one = bays.render_by(1).film, many = bays.render_by(8, 1).film;
    expect_equal_means(one, many, "mirror");
    bays.options.sampling.spp = 64;
    EXPECT_LT(2 * sample_error(bays.render_by(8).film, ErrorMeasure::RELATIVE),
              sample_error(bays.render_by(1).film, ErrorMeasure::RELATIVE));
}

// Sky and sun come through a pane that covers the bays: paths that leave through it are weighted as those
// from the vertex below.
TEST(LightSamples, ChangeNoMeanBelowAPaneUnderSunAndSky) {
    Bays bays(6);
    bays.build.material("pane", "Ni 1.5\nillum 7\nKs 1 1 1\nTf 1 1 1").use("pane");
    bays.build.box({-8, 2, -8}, {8, 2.1, 8});
    bays.options.light.environment = glm::dvec3(1, 1.5, 2);
    bays.options.light.suns.push_back({{0.3, 0.8, 0.4}, {2, 2, 2}, 20});
    bays.options.sampling.spp = 4096;
    bays.options.film.size = {24, 16};
    const Film one = bays.render_by(1).film;
    expect_equal_means(one, bays.render_by(8, 1).film, "pane");
}

TEST(LightSamples, LayersLeaveThePictureAloneAndPilots) {
    Bays bays(12);
    const Film plain = bays.render_by(8).film;
    bays.options.output.path_layers = {{"all", "L(D|S)*E"}, {"direct", "L(D|S)E"}, {"rest", "L(D|S)(D|S)+E"}};
    const Render layered = bays.render_by(8);
    EXPECT_EQ(layered.film.sums, plain.sums);
    const std::vector<Film>& layers = layered.path_layers;
    ASSERT_EQ(layers.size(), 3u);
    const double all = film_estimate(layers[0], 0).mean;
    EXPECT_NEAR(all, film_estimate(plain, 0).mean, 1e-5 * all);
    EXPECT_GT(film_estimate(layers[1], 0).mean, 0.5 * all);
    // The lamps' backs are black.
    EXPECT_NEAR(film_estimate(layers[1], 0).mean + film_estimate(layers[2], 0).mean, all, 1e-5 * all);
    bays.options.film.size = {128, 96};
    bays.options.transport.max_depth = 2;
    bays.options.transport.light_samples = 0;
    const int chosen = bays.chosen();
    bays.options.output.path_layers.clear();
    EXPECT_EQ(chosen, bays.chosen());
}

TEST(LightSamples, LowerTheNoiseOfManyLights) {
    Bays bays(12);
    bays.options.transport.max_depth = 2;
    const double one = sample_error(bays.render_by(1).film, ErrorMeasure::RELATIVE);
    const double two = sample_error(bays.render_by(2).film, ErrorMeasure::RELATIVE);
    const double eight = sample_error(bays.render_by(8).film, ErrorMeasure::RELATIVE);
    EXPECT_LT(1.5 * two, one);
    EXPECT_LT(6 * eight, one);
}

TEST(LightSamples, AreTakenAtTheFirstVertexAlone) {
    Bays bays(6);
    bays.options.transport.max_depth = 2;
    const auto first = [&](int samples) { return bays.render_by(samples).counts.shadow; };
    const std::uint64_t one = first(1), eight = first(8);
    EXPECT_NEAR(double(eight) / double(one), 8, 0.5);
    bays.options.transport.max_depth = 6;
    const RenderCounts few = bays.render_by(1).counts, many = bays.render_by(8).counts;
    EXPECT_EQ(few.secondary, many.secondary);
    EXPECT_EQ(many.shadow - few.shadow, eight - one);
}

TEST(LightSamples, OneLightTakesOne) {
    TestScene single;
    single.build.material("white", "Kd 0.3 0.3 0.3").material("lamp", "Kd 0 0 0\nKe 20 20 20").use("white");
    single.build.floor(2).use("lamp").polygon({{-1, 1, -1}, {1, 1, -1}, {0, 1, 1}});
    single.look({0, 2, 3}, {0, 0, 0}, 60);
    single.options.effects.all = false;
    single.options.transport.light_samples = 8;
    const Render many = single.render();
    single.options.transport.light_samples = 1;
    EXPECT_EQ(many.film.sums, single.render().film.sums);
    single.options.transport.light_samples = 8;
    const auto planned = plan_loaded(test_device(), single.load(), single.options);
    EXPECT_EQ(light_samples(planned->scene, planned->options), 1);
}

TEST(LightSamples, TheBestNumberIsThatOfBothPartsOfTheNoise) {
    // All of it is of lights: as many as there may be.
    EXPECT_EQ(best_light_samples(4, 6, 1, 7, 4).samples, 8);
    // None is, or so little that it does not pay.
    EXPECT_EQ(best_light_samples(1, 6, 1, 7, 4).samples, 1);
    EXPECT_EQ(best_light_samples(1, 6, 0.9, 7, 4).samples, 1);
    EXPECT_EQ(best_light_samples(1, 6, 2, 7, 4).samples, 1);
    // Half of it: errors 1, .75, .625, .5625 of a sample; work 1, 1.05, 1.15, 1.35 where a sample costs a
    // twentieth.
    const LightSamplesGain half = best_light_samples(1, 6, 0.625, 6 + 3 * 0.2, 4);
    EXPECT_EQ(half.samples, 4);
    EXPECT_NEAR(half.gain, 1 / (0.625 * 1.15), 1e-9);
    // Black pilots.
    EXPECT_EQ(best_light_samples(HUGE_VAL, 6, HUGE_VAL, 7, 4).samples, 1);
}

TEST(LightSamples, AreChosenWhereWallsHideLights) {
    Bays bays(12);
    bays.options.film.size = {128, 96};
    bays.options.transport.light_samples = 0;
    // Noise of reflected light remains where paths are not reused, unless there is none.
    EXPECT_EQ(bays.chosen(), 1);
    bays.options.transport.max_depth = 2;
    EXPECT_GT(bays.chosen(), 1);
    bays.options.transport.max_depth.reset();
    bays.options.transport.path_reuse = Toggle::AUTO;
    EXPECT_GT(bays.chosen(), 1);
    bays.options.transport.light_samples = 2;
    EXPECT_EQ(bays.chosen(), 2);
    // Part of a picture, and too few samples for a pilot.
    bays.options.transport.light_samples = 0;
    bays.options.run.given["--first-sample"] = "";
    EXPECT_EQ(bays.chosen(), 1);
    bays.options.run.given.clear();
    bays.options.sampling.spp = 4;
    EXPECT_EQ(bays.chosen(), 1);
}

TEST(LightSamples, AFilmGoesOnWithItsNumber) {
    Bays bays(12);
    bays.options.transport.light_samples = 4;
    const auto planned = plan_loaded(test_device(), bays.load(), bays.options);
    FilmIdentity identity = film_identity(planned->scene, planned->options, launch_params(*planned), {});
    EXPECT_EQ(film_light_samples(identity), 4);
    for (const int unheard : {0, 5, 16, 1 << 30}) {
        identity["light_samples"] = unheard;
        EXPECT_EQ(film_light_samples(identity), 1);
    }
    identity.erase("light_samples");
    EXPECT_EQ(film_light_samples(identity), 1);
    identity["light_samples"] = "many";
    EXPECT_EQ(film_light_samples(identity), 1);
}

} // namespace clrt
