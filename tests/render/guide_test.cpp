// SPDX-License-Identifier: Apache-2.0
// --guide: guided paths bring the same light, with less noise where it is hard to find; the picture keeps its
// bits however its samples are dealt out; a film goes on where it was; auto leaves easy scenes alone.
#include "film/film_error.h"
#include "options/path_refusals.h"
#include "probes/film_estimate.h"
#include "render/guiding.h"
#include "support/adjoining_rooms.h"
#include "support/drawn.h"
#include "support/saved_render.h"
#include "support/sunlit_basin.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A lamp over a floor.
void add_lit_floor(TestScene& scene) {
    scene.build.material("white", "Kd 0.7 0.7 0.7").material("lamp", "Kd 0 0 0\nKe 9 8 6");
    scene.build.use("white").floor(2);
    scene.build.use("lamp").polygon({{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}});
    scene.look({0, 2, 3}, {0, 0, 0}, 40);
    scene.options.film.size = {32, 24};
    scene.options.effects.all = false;
}

Render render_guided(TestScene& scene, Toggle guide, u32 spp, int replicates) {
    scene.options.transport.guide = guide;
    scene.options.sampling.spp = spp;
    scene.options.sampling.replicates = replicates;
    return scene.render();
}

/// A room with a lamp, which guides cannot make easier, and a block in it.
struct BrightRoom : TestScene {
    BrightRoom(const std::string& walls, const std::string& block) {
        build.material("wall", walls).material("block", block).material("lamp", "Kd 0 0 0\nKe 9 9 9");
        build.use("wall")
            .box({-2, 0, -2}, {2, 2.5, 2}, Facing::INWARD)
            .box({-0.6, 0.3, -0.6}, {0.2, 0.6, 0.2});
        build.use("block").box({-1.5, 0.1, -1.5}, {1, 1, 1});
        build.use("lamp").polygon({{-1, 2.4, -1}, {0, 2.4, -1}, {0, 2.4, 0}, {-1, 2.4, 0}});
        look({1.8, 1.6, 1.8}, {0, 0.8, 0}, 60);
        options.film.size = {24, 24};
        options.effects.all = false;
    }
    /// Squared error of a guided sample over that of one without a guide.
    double cost_of_guide() {
        const Film alone = render_guided(*this, Toggle::OFF, 1024, 32).film;
        const Film guided = render_guided(*this, Toggle::ON, 1024, 32).film;
        return sample_error(guided, ErrorMeasure::MSE) / sample_error(alone, ErrorMeasure::MSE);
    }
};

/// Mean and squared standard error of a tile of 8 x 8 pixels and channel, over the replicates.
std::vector<Estimate> tile_means(const Film& film) {
    std::vector<Estimate> tiles;
    for (int y = 0; y < film.height; y += 8)
        for (int x = 0; x < film.width; x += 8)
            for (int channel = 0; channel < 3; ++channel)
                tiles.push_back(film_estimate(film, channel, {x, y, x + 8, y + 8}));
    return tiles;
}

double squares(const std::vector<Estimate>& tiles) {
    double sum = 0;
    for (const Estimate& tile : tiles)
        sum += tile.error * tile.error;
    return sum;
}

// Sixty-four replicates of which each is a mean of the truth, though all learn together: where they were
// biased by what they share, tiles would be off by more than their spread says.
void expect_same_light_with_less_noise(TestScene& scene) {
    const std::vector<Estimate> plain = tile_means(render_guided(scene, Toggle::OFF, 2048, 64).film);
    const Render render = render_guided(scene, Toggle::ON, 2048, 64);
    const std::vector<Estimate> guided = tile_means(render.film);
    ASSERT_TRUE(render.guide.guide);
    EXPECT_GT(render.guide.guide->lore().size(), 100u);
    double sum = 0;
    for (size_t i = 0; i < plain.size(); ++i) {
        const double z = (guided[i].mean - plain[i].mean) / std::hypot(guided[i].error, plain[i].error);
        EXPECT_LT(std::abs(z), 5) << "tile and channel " << i;
        sum += z * z;
    }
    EXPECT_LT(sum / double(plain.size()), 1.9);
    EXPECT_LT(squares(guided), 0.5 * squares(plain));
}

} // namespace

TEST(Guide, BringsTheSameLightWithLessNoise) {
    TestScene scene;
    add_adjoining_rooms(scene);
    expect_same_light_with_less_noise(scene);
}

// What a path has found serves other pixels, by the density with which each of them is guided.
TEST(Guide, BringsTheSameLightToPathsThatServeOthers) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.options.transport.path_reuse = Toggle::ON;
    expect_same_light_with_less_noise(scene);
}

// A mirror under the lamp throws its light at the slit: caustics, which splats bring beside guided paths.
TEST(Guide, BringsTheSameLightBesideSplats) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.build.material("mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3").use("mirror");
    scene.build.icosphere({-1.6, 1.2, 0.2}, 0.5, 2, Facing::OUTWARD, Shading::SMOOTH);
    scene.options.transport.integrator = Integrator::PATH_LIGHT;
    expect_same_light_with_less_noise(scene);
}

TEST(Guide, LightPathsTellBdptOfLightBehindWater) {
    TestScene basin;
    add_sunlit_basin(basin, 4);
    expect_same_light_with_less_noise(basin);
    // Hardly any path finds a smaller sun, but light paths find the floor.
    basin.options.light.suns[0].diameter_degrees = 0.5;
    const auto error = [&](Toggle guide) {
        return sample_error(render_guided(basin, guide, 512, 16).film, ErrorMeasure::MSE);
    };
    EXPECT_LT(error(Toggle::ON), 0.05 * error(Toggle::OFF));
}

// No path can be guided to a sun without a disc.
TEST(Guide, LightThatNoRayMeetsTeachesNothing) {
    TestScene basin;
    add_sunlit_basin(basin, 0);
    const auto records = [&] { return Guide::records(render_guided(basin, Toggle::ON, 64, 4).guide.sums); };
    const double without = records();
    basin.options.light.suns[0].diameter_degrees = 0.5;
    EXPECT_GT(records(), 1.2 * without);
    basin.options.light.suns.clear();
    EXPECT_NEAR(records() / without, 1, 0.02);
}

/// Whether a picture is the same in one run as in two, by way of a film file.
void expect_same_bits_in_pieces(TestScene& scene) {
    const Render whole = render_guided(scene, Toggle::ON, 24, 4);
    const Render again = render_guided(scene, Toggle::ON, 24, 4);
    EXPECT_EQ(whole.film.sums, again.film.sums);

    // Within an epoch, and where one ends.
    for (const u32 spp : {6u, 8u, 13u}) {
        const RenderProgress part = through_a_file(render_guided(scene, Toggle::ON, spp, 4), scene);
        scene.options.sampling.spp = 24;
        RenderHooks hooks;
        hooks.resume = &part;
        const PreparedScene prepared = prepare_loaded(test_device(), scene.load(), scene.options);
        Progress progress(Toggle::OFF, true);
        EXPECT_EQ(render(prepared, progress, hooks).film.sums, whole.film.sums) << spp;
    }
}

TEST(Guide, KeepsItsBitsInPieces) {
    for (const Toggle path_reuse : {Toggle::OFF, Toggle::ON}) {
        TestScene scene;
        add_adjoining_rooms(scene);
        scene.options.transport.path_reuse = path_reuse;
        expect_same_bits_in_pieces(scene);
    }
    TestScene basin;
    add_sunlit_basin(basin, 4);
    expect_same_bits_in_pieces(basin);
}

// Whether bdpt is guided is decided before the picture.
TEST(Guide, BdptIsNotGuidedUnasked) {
    TestScene basin;
    add_sunlit_basin(basin, 4);
    basin.options.transport.guide_after_rays = 1;
    const Render render = render_guided(basin, Toggle::AUTO, 64, 4);
    EXPECT_EQ(render.guide.stage, GuideStage::OFF);
    EXPECT_EQ(render.film.sums, render_guided(basin, Toggle::OFF, 64, 4).film.sums);
}

TEST(Guide, AutoLeavesEasyScenesAlone) {
    TestScene scene;
    add_lit_floor(scene);
    scene.options.transport.guide_after_rays = 1;
    const Render plain = render_guided(scene, Toggle::OFF, 64, 4);
    const Render render = render_guided(scene, Toggle::AUTO, 64, 4);
    EXPECT_EQ(render.film.sums, plain.film.sums);
    EXPECT_EQ(render.guide.stage, GuideStage::OFF);
    EXPECT_FALSE(render.guide.guided_from);
    ASSERT_TRUE(render.guide.pilot_error);
    EXPECT_LT(*render.guide.pilot_error, 4);
}

TEST(Guide, AutoLeavesShortRendersAlone) {
    TestScene scene;
    add_adjoining_rooms(scene);
    const Render render = render_guided(scene, Toggle::AUTO, 64, 4);
    EXPECT_EQ(render.film.sums, render_guided(scene, Toggle::OFF, 64, 4).film.sums);
    EXPECT_EQ(render.guide.stage, GuideStage::PILOT);
}

// The guided samples of the last epoch that is judged tell what the variance would be without their guide;
// where paths serve other pixels, it is measured.
TEST(Guide, AutoHelpsWhereLightIsHardToFind) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.options.transport.max_depth = 8;
    for (const auto& [roulette_depth, path_reuse] : drawn<std::pair<int, Toggle>>(
             {{9, Toggle::OFF},
              {2, Toggle::OFF}, // densities of directions alone differ, or survival, too
              {9, Toggle::ON}},
             2)) {
        scene.options.transport.roulette_depth = roulette_depth;
        scene.options.transport.path_reuse = path_reuse;
        scene.options.transport.guide_after_rays = 3e6;
        const GuideProgress guide = render_guided(scene, Toggle::AUTO, 4096, 16).guide;
        EXPECT_EQ(guide.stage, GuideStage::ON);
        const auto pilot = u32(guide.pilot_end), begin = 3 * pilot,
                   end = 5 * pilot; // of the second judgement
        EXPECT_EQ(guide.guided_from, pilot / 2 * 3);
        EXPECT_EQ(guide.judgements, 2u);
        ASSERT_TRUE(guide.error);
        EXPECT_LT(*guide.error * *guide.work, 1);
        Film film = render_guided(scene, Toggle::AUTO, end, 16).film;
        const Film before = render_guided(scene, Toggle::AUTO, begin, 16).film;
        for (size_t i = 0; i < film.sums.size(); ++i)
            film.sums[i] -= before.sums[i];
        film.ranges = {{begin, end}};
        const Film plain = render_guided(scene, Toggle::OFF, end - begin, 16).film;
        const auto error = [](const Film& of) {
            return film_error(of, ErrorPixels::SCENE, ErrorMeasure::RELATIVE)->relative_rmse;
        };
        const double measured = std::pow(error(film) / error(plain), 2);
        EXPECT_NEAR(*guide.error / measured, 1, 0.25);
    }
}

// Paths of many vertices: what a guide makes of the weight at each of them multiplies.
TEST(Guide, WeightsOfLongPathsStayBounded) {
    BrightRoom room("Kd 0.95 0.95 0.95", "Kd 0.95 0.95 0.95");
    EXPECT_LT(room.cost_of_guide(), 12);
}

TEST(Guide, LeavesRoughGlassAlone) {
    BrightRoom room("Kd 0.75 0.75 0.75", "Ni 1.5\nillum 7\nPr 0.4");
    EXPECT_LT(room.cost_of_guide(), 2);
}

// In the middle of an epoch, and in one of a single sample of each replicate.
TEST(Guide, OnlySomeSamplesTeach) {
    TestScene scene;
    add_adjoining_rooms(scene);
    const auto vertices = [&](u32 begin, u32 end, u32 teachers) {
        RenderProgress part = through_a_file(render_guided(scene, Toggle::ON, begin, 4), scene);
        part.guide.teachers = teachers;
        std::fill(part.guide.sums.begin(), part.guide.sums.end(), 0);
        scene.options.sampling.spp = end;
        RenderHooks hooks;
        hooks.resume = &part;
        const PreparedScene prepared = prepare_loaded(test_device(), scene.load(), scene.options);
        Progress progress(Toggle::OFF, true);
        const Render render = clrt::render(prepared, progress, hooks);
        std::uint64_t sum = 0;
        for (size_t cell = 0; cell < render.guide.sums.size(); cell += GUIDE_SUMS)
            sum += render.guide.sums[cell + GUIDE_SUM_VERTICES];
        return double(sum);
    };
    EXPECT_NEAR(vertices(40, 56, NO_INDEX >> 1) / vertices(40, 56, NO_INDEX), 0.5, 0.05);
    EXPECT_NEAR(vertices(6, 8, NO_INDEX >> 2) / vertices(6, 8, NO_INDEX), 0.25, 0.05);
}

TEST(Guide, SamplesOfARangeAreNotGuided) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.options.transport.guide_after_rays = 1;
    scene.options.sampling.first_sample = 64;
    EXPECT_FALSE(may_guide(scene.options));
    EXPECT_EQ(render_guided(scene, Toggle::AUTO, 32, 4).guide.end, 0u);
}

} // namespace clrt
