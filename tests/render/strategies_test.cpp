// SPDX-License-Identifier: Apache-2.0
// --aov strategies: the layers are the picture, to the last bit, and each holds what its strategy finds.
#include "options/summed_layers.h"
#include "render/layers_that_sum.h"
#include "render/picture.h"
#include "support/drawn.h"
#include "support/film_agrees.h"
#include "support/lit_rooms.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace clrt {

namespace {

/// A room rendered with layers of strategies.
struct Strategies : Room {
    explicit Strategies(int segments) {
        options.transport.integrator = Integrator::BDPT;
        options.output.strategies = segments;
        options.output.aovs.emplace();
        options.film.size = {24, 16};
        options.sampling.spp = 64;
    }
};

/// Means of a pixel and channel, summed over the layers that a predicate of s and t takes.
template <class Takes>
Film layers_where(const Render& render, const Options& options, Takes&& takes) {
    Film sum = film_layer(render.film);
    sum.sums.assign(film_plane(sum), 0);
    const int longest = strategy_segments(options);
    size_t layer = 0;
    for (int segments = 1; segments <= longest; ++segments)
        for (int s = 0; s <= (segments == 1 ? 0 : segments); ++s, ++layer)
            if (takes(s, segments + 1 - s))
                EXPECT_TRUE(add_sums(sum.sums, render.path_layers.at(layer).sums));
    EXPECT_EQ(layer + 1, render.path_layers.size()) << "and what is longer";
    return sum;
}

double total(const Film& film) {
    double sum = 0;
    for (const std::int64_t quanta : film.sums)
        sum += double(quanta);
    return sum;
}

} // namespace

TEST(Strategies, AddUpToThePictureToTheLastQuantum) {
    for (const Lighting& lighting : lightings()) {
        SCOPED_TRACE(lighting.name);
        for (const int segments : drawn<int>({1, 3, 8}, 2)) {
            Strategies room(segments);
            lighting.add(room);
            room.add_caustics();
            const Render render = room.render();
            const size_t plane = film_plane(render.film);
            std::vector<std::int64_t> picture(plane, 0), layers(plane, 0);
            for (size_t i = 0; i < render.film.sums.size(); ++i)
                picture[i % plane] += render.film.sums[i];
            for (const Film& layer : render.path_layers) {
                for (const std::int64_t quanta : layer.sums)
                    ASSERT_GE(quanta, 0);
                ASSERT_TRUE(add_sums(layers, layer.sums));
            }
            EXPECT_TRUE(picture == layers);
        }
    }
}

TEST(Strategies, LeaveThePictureAsItIs) {
    Strategies room(4);
    room.add_lamp();
    room.add_caustics();
    const Film with = room.render().film;
    room.options.output.strategies.reset();
    EXPECT_TRUE(with.sums == room.render().film.sums);
}

TEST(Strategies, AddUpInFiles) {
    Strategies room(3);
    room.add_lamp();
    room.add_caustics();
    const Scene scene = room.load();
    const Picture picture = make_picture(render_loaded(scene, room.options), scene, room.options);
    ASSERT_EQ(picture.layers.size(), 1 + 8 + 1u);
    EXPECT_EQ(picture.layers[1].name, "strategy.s0.t2");
    EXPECT_EQ(picture.layers[3].name, "strategy.s1.t2");
    EXPECT_EQ(picture.layers[8].name, "strategy.s3.t1");
    EXPECT_EQ(picture.layers[9].name, "strategy.longer");
    for (size_t i = 0; i < picture.layers[0].values.size(); ++i) {
        double sum = 0;
        for (size_t layer = 1; layer < picture.layers.size(); ++layer)
            sum += double(picture.layers[layer].values[i]);
        ASSERT_EQ(float(sum), picture.layers[0].values[i]) << "value " << i;
    }
}

TEST(Strategies, RoundToTheirSum) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0, 1);
    const size_t count = 20000;
    std::vector<float> whole(count);
    std::vector<std::vector<float>> layers(6, std::vector<float>(count));
    size_t missed = 0;
    for (size_t i = 0; i < count; ++i) {
        double sum = 0, rounded = 0;
        for (std::vector<float>& layer : layers) {
            const double value = unit(random) < 0.4 ? 0 : std::pow(unit(random), 8);
            sum += value;
            layer[i] = float(value);
            rounded += double(layer[i]);
        }
        whole[i] = float(sum);
        missed += float(rounded) != whole[i] ? 1 : 0;
    }
    EXPECT_GT(missed, count / 100) << "there is something to do";
    const auto before = layers;
    round_to_sum(whole, layers);
    for (size_t i = 0; i < count; ++i) {
        double sum = 0;
        for (size_t layer = 0; layer < layers.size(); ++layer) {
            sum += double(layers[layer][i]);
            EXPECT_NEAR(layers[layer][i], before[layer][i], 1.2e-7 * whole[i]);
            EXPECT_TRUE(before[layer][i] > 0 || layers[layer][i] == 0);
        }
        ASSERT_EQ(float(sum), whole[i]);
    }
}

TEST(Strategies, HoldTheLengthsThatTheySay) {
    // All strategies of up to n segments together are the picture that --max-depth n ends.
    Strategies room(4);
    room.add_lamp();
    room.add_caustics();
    room.options.sampling.spp = 512;
    const Render render = room.render();
    for (const int longest : {1, 2, 3, 4}) {
        const Film film =
            layers_where(render, room.options, [&](int s, int t) { return s + t - 1 <= longest; });
        Options ended = room.options;
        ended.output.strategies.reset();
        ended.transport.max_depth = longest;
        const Estimate expected = film_estimate(render_loaded(room.load(), ended).film);
        EXPECT_NEAR(film_estimate(film).mean / expected.mean, 1, 0.01 + 5 * expected.error / expected.mean)
            << longest;
    }
}

TEST(Strategies, EachFindsWhatItCan) {
    const auto light = [](const Strategies& room, const auto& takes) {
        return total(layers_where(room.render(), room.options, takes));
    };
    Strategies lamp(4);
    lamp.add_lamp();
    lamp.add_caustics();
    for (int s = 0; s <= 4; ++s)
        EXPECT_GT(light(lamp, [&](int of_light, int) { return of_light == s; }), 0) << s;

    Strategies point(4); // which no path from the eye meets
    point.options.light.points.push_back({{0.5, 1.8, 1}, {4, 5, 6}});
    EXPECT_EQ(light(point, [](int s, int) { return s == 0; }), 0);
    EXPECT_GT(light(point, [](int s, int) { return s == 1; }), 0);

    Strategies mirror(4); // fills the view, so that no vertex can be connected to the eye
    mirror.add_lamp();
    mirror.build.use("mirror").polygon({{-9, -9, 3}, {-9, 9, 3}, {9, 9, 3}, {9, -9, 3}});
    mirror.look({0, 1.6, 2.6}, {0, 1.3, 4}, 50);
    EXPECT_EQ(light(mirror, [](int, int t) { return t <= 2; }), 0);
    EXPECT_GT(light(mirror, [](int s, int t) { return s == 1 && t == 3; }), 0);
}

} // namespace clrt
