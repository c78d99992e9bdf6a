// SPDX-License-Identifier: Apache-2.0
// --light-sampler: every choice gives the same light, tile by tile; where one far lamp has nearly all the
// power, choices by position bring it with less noise.
#include "probes/film_estimate.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A room's corner with plates of every kind of BSDF, lit by lamps of one side and of two, from behind, by
/// points, a sun and a sky.
void add_room(TestScene& scene) {
    scene.build.material("matte", "Kd 0.6 0.5 0.4").material("metal", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.4");
    scene.build.material("glass", "Ni 1.5\nillum 7\nPr 0.4").material("lamp", "Kd 0 0 0\nKe 6 5 4");
    scene.build.material("weak", "Kd 0 0 0\nKe 2 2 3");
    scene.build.use("matte").floor(3);
    scene.build.polygon({{-3, 0, -2}, {3, 0, -2}, {3, 3, -2}, {-3, 3, -2}});
    scene.build.use("metal").polygon(
        {{-1.5, 0.05, 0.5}, {-0.5, 0.05, 0.5}, {-0.5, 0.5, -0.5}, {-1.5, 0.5, -0.5}});
    scene.build.use("glass").icosphere({0.8, 0.5, 0}, 0.5, 2, Facing::OUTWARD, Shading::SMOOTH);
    for (int i = 0; i < 5; ++i) {
        const double x = 0.9 * i - 1.8;
        scene.build.use(i % 2 ? "lamp" : "weak").raw("o lamp_" + std::to_string(i));
        scene.build.polygon({{x, 2, -1}, {x + 0.3, 2, -1}, {x + 0.3, 2, -0.6}, {x, 2, -0.6}}); // shines down
        scene.build.polygon({{x, 2.5, -1}, {x, 2.5, -0.6}, {x + 0.3, 2.5, -0.6}, {x + 0.3, 2.5, -1}}); // up
    }
    scene.build.use("weak").icosphere({-0.2, 0.3, 0.4}, 0.12, 1);
    scene.options.light.points.push_back({{1.5, 1, 1}, {0.4, 0.4, 0.5}});
    scene.options.light.suns.push_back({{-1, 2, 1}, {0.6, 0.5, 0.4}, 4});
    scene.look({0, 1.6, 4}, {0, 0.7, 0}, 50);
    scene.options.film.size = {32, 32};
    scene.options.sampling.spp = 1024;
    scene.options.sampling.replicates = 64;
}

/// Mean and squared standard error of each tile of 8 x 8 pixels and channel, over the replicates.
struct TileMeans {
    std::vector<double> mean, variance;
};

TileMeans tile_means(TestScene& scene, LightSampler sampler) {
    scene.options.sampling.light_sampler = sampler;
    const Film film = scene.render().film;
    TileMeans tiles;
    for (int y = 0; y < film.height; y += 8)
        for (int x = 0; x < film.width; x += 8)
            for (int channel = 0; channel < 3; ++channel) {
                const Estimate tile = film_estimate(film, channel, {x, y, x + 8, y + 8});
                tiles.mean.push_back(tile.mean);
                tiles.variance.push_back(tile.error * tile.error);
            }
    return tiles;
}

double sum_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum;
}

} // namespace

TEST(LightSampler, EveryChoiceGivesTheSameLightEverywhere) {
    for (const bool two_sided : {false, true}) {
        TestScene scene;
        add_room(scene);
        scene.options.light.two_sided = two_sided;
        const TileMeans power = tile_means(scene, LightSampler::POWER);
        for (const LightSampler sampler : {LightSampler::MIXTURE, LightSampler::TREE}) {
            const TileMeans other = tile_means(scene, sampler);
            double squares = 0;
            for (size_t i = 0; i < power.mean.size(); ++i) {
                const double z =
                    (other.mean[i] - power.mean[i]) / std::sqrt(other.variance[i] + power.variance[i]);
                EXPECT_LT(std::abs(z), 6) << name_of(sampler) << ", tile " << i;
                squares += z * z;
            }
            // Tiles and channels depend on each other: the sum of squares spreads more than that of as many.
            EXPECT_LT(squares / double(power.mean.size()), 1.9) << name_of(sampler);
        }
    }
}

TEST(LightSampler, AStrongLampElsewhereIsNoHindrance) {
    TestScene scene;
    add_room(scene);
    scene.build.material("strong", "Kd 0 0 0\nKe 20000 20000 20000").use("strong").raw("o far");
    scene.build.polygon({{-3, 3, -9}, {3, 3, -9}, {3, 6, -9}, {-3, 6, -9}}).use("matte");
    scene.build.polygon({{-9, 0, -8}, {9, 0, -8}, {9, 9, -8}, {-9, 9, -8}}); // it stands behind a wall
    scene.options.transport.max_depth = 2;
    scene.options.sampling.spp = 256;
    const double power = sum_of(tile_means(scene, LightSampler::POWER).variance);
    EXPECT_LT(sum_of(tile_means(scene, LightSampler::MIXTURE).variance), 0.5 * power);
    EXPECT_LT(sum_of(tile_means(scene, LightSampler::TREE).variance), 0.25 * power);
}

} // namespace clrt
