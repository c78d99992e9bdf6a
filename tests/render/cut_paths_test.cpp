// SPDX-License-Identifier: Apache-2.0
// Paths that --max-depth cuts: closed rooms in which long paths carry the light, and what is said about those
// that are cut. In a closed room of one material, Ke over 1 - Kd shines from everywhere.
#include "render/cut_paths.h"
#include "render/render_params.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr int NO_ROULETTE = 65535;

class ClosedRoom : public TestScene {
public:
    explicit ClosedRoom(double kd, double ke) {
        build.material("wall", "Kd " + std::to_string(kd) + "\nKe " + std::to_string(ke)).use("wall");
        build.box({-1, -1, -1}, {1, 1, 1}, Facing::INWARD);
        look({0.1, 0.2, 0.7}, {0.2, -0.1, -0.5}, 70);
        options.film.size = {8, 8};
        options.sampling.replicates = 16;
        options.effects.all = false; // long paths: the small program is the fast one
    }
    std::uint64_t samples() const {
        return std::uint64_t(options.film.size.x) * std::uint64_t(options.film.size.y) *
               *options.sampling.spp;
    }
    CutPaths cut(const Render& render) const {
        const Scene scene = load();
        const BiasSources bias = bias_sources(scene, plan_paths(scene, options), render, options.transport.integrator);
        return cut_paths(render, bias.cut_radiance);
    }
};

} // namespace

TEST(CutPaths, ByDefaultLongPathsLoseNoLight) {
    for (const double kd : {0.98, 0.99}) {
        ClosedRoom room(kd, 1 - kd);
        const Render render = room.render();
        EXPECT_TRUE(agrees(film_estimate(render.film), 1, 1e-2)) << kd;
        EXPECT_EQ(room.cut(render).light_bound, 0.0) << kd;
    }
}

TEST(CutPaths, WhatAForcedDepthLosesIsInTheBound) {
    constexpr int DEPTH = 128;
    constexpr double THRESHOLD = 0.25; // paths of this weight and more are never ended
    for (const int roulette : {5, NO_ROULETTE}) {
        ClosedRoom room(0.98, 0.02);
        room.options.transport.max_depth = DEPTH;
        room.options.transport.roulette_depth = roulette;
        const Render render = room.render();
        const double loss = std::pow(0.98, DEPTH);
        EXPECT_TRUE(agrees(film_estimate(render.film), 1 - loss, 1e-2)) << roulette;
        const CutPaths cut = room.cut(render);
        // Here every place is as bright as the bound says, so that the bound is the loss: exactly where no
        // roulette plays, else with the noise of the number of paths that are left.
        const double noise = roulette == NO_ROULETTE ? 0 : 6 / std::sqrt(double(cut.paths));
        EXPECT_GE(cut.light_bound.value(), loss * (1 - noise));
        EXPECT_LE(cut.light_bound.value(), loss * (1 + 1e-4 + noise));
        EXPECT_NEAR(cut.relative_bound.value(), loss / (1 - loss), (1e-4 + noise) * loss / (1 - loss) * 2);
        if (roulette == NO_ROULETTE)
            EXPECT_EQ(cut.paths, room.samples()) << "all of them";
        else
            EXPECT_NEAR(double(cut.paths) / double(room.samples()), loss / THRESHOLD, 0.05);
    }
}

TEST(CutPaths, TheLossStaysBelowTheBoundWhereLightIsUneven) {
    // One wall of six shines: the bound takes all for as bright as the brightest place could be.
    ClosedRoom room(0.9, 0);
    room.build.material("lamp", "Kd 0.5 0.5 0.5\nKe 1 1 1").use("lamp");
    room.build.polygon({{-0.5, 0.99, -0.5}, {0.5, 0.99, -0.5}, {0.5, 0.99, 0.5}, {-0.5, 0.99, 0.5}});
    for (const bool point : {false, true}) {
        if (point)
            room.options.light.points = {{{0, 0.2, 0}, glm::dvec3(0.5)}};
        room.options.transport.max_depth.reset();
        const Estimate whole = film_estimate(room.render().film);
        for (const int depth : {1, 2, 8}) {
            room.options.transport.max_depth = depth;
            const Render render = room.render();
            const Estimate part = film_estimate(render.film);
            const double noise = 6 * std::hypot(whole.error, part.error);
            const double bound = room.cut(render).light_bound.value();
            EXPECT_LT(whole.mean - part.mean, bound + noise) << depth << ", point " << point;
            EXPECT_GT(whole.mean - part.mean, noise) << "or there is no loss to bound";
        }
    }
}

TEST(CutPaths, WhiteWallsHaveNoBound) {
    ClosedRoom room(1, 0.01);
    room.options.sampling.spp = 16;
    room.options.transport.max_depth = 50;
    const Render render = room.render();
    const CutPaths cut = room.cut(render);
    EXPECT_EQ(cut.paths, room.samples()) << "nothing ends a path in a white room";
    EXPECT_EQ(cut.light_bound, std::nullopt);
    EXPECT_TRUE(agrees(film_estimate(render.film), 0.5, 1e-2, 1e-4));
}

TEST(CutPaths, EndsOfPathsAreNoCuts) {
    // Black walls and the sky end paths by themselves.
    TestScene scene;
    scene.build.material("black", "Kd 0 0 0\nKe 1 1 1").use("black").floor(1);
    scene.options.light.environment = glm::dvec3(1);
    scene.look({0, 1, 2}, {0, 0, 0}, 60);
    scene.options.effects.all = false;
    for (const Integrator integrator :
         {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED, Integrator::RAYCAST}) {
        scene.options.transport.integrator = integrator;
        scene.options.transport.max_depth = 1;
        EXPECT_EQ(scene.render().counts.cut_paths, 0u);
    }
}

TEST(CutPaths, WhittedCountsTheRaysOfItsTree) {
    TestScene scene;
    scene.build.material("mirror", "Kd 0 0 0\nKs 0.5 0.5 0.5\nillum 3\nKe 1 1 1").use("mirror");
    scene.build.polygon({{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}});
    scene.build.polygon({{-9, 9, 1}, {9, 9, 1}, {9, -9, 1}, {-9, -9, 1}});
    scene.look_at_point({0, 0, 0.5}, {0, 0, -1});
    scene.options.effects.all = false;
    scene.options.transport.integrator = Integrator::WHITTED;
    scene.options.transport.min_contribution = 0;
    scene.options.transport.max_depth = 4;
    scene.options.sampling.spp = 16;
    const Render render = scene.render();
    EXPECT_EQ(render.counts.cut_paths, std::uint64_t(16 * 16 * 16));
    const CutPaths cut = cut_paths(render, cut_radiance(scene.load(), 15u));
    EXPECT_GE(cut.light_bound.value(), 2 - 1.875) << "what is lost";
    EXPECT_NEAR(cut.light_bound.value(), 0.25, 1e-4) << "the weight of the last ray, times 1 / (1 - 0.5)";
}

TEST(CutPaths, OnlyPathsThatAreAskedForAreCut) {
    ClosedRoom room(0.5, 0.5);
    room.options.sampling.spp = 64;
    room.options.transport.max_depth = 3;
    const auto cut = [&](const char* paths) {
        room.options.transport.paths = paths;
        return room.render().counts.cut_paths;
    };
    EXPECT_EQ(cut("LE|LDE|LDDE"), 0u) << "all within three segments";
    const std::uint64_t all = cut("LD*E");
    EXPECT_GT(all, 0u);
    EXPECT_EQ(cut("LDDDE|LE"), all) << "at the first surface already: three more cannot come";
    EXPECT_EQ(cut(""), all);
}

TEST(CutPaths, TheCountDoesNotDependOnLaunches) {
    ClosedRoom room(0.9, 0.1);
    room.options.transport.max_depth = 6;
    room.options.sampling.spp = 24;
    room.options.sampling.replicates = 8;
    const RenderCounts whole = room.render().counts;
    EXPECT_GT(whole.cut_paths, 0u);
    RenderCounts parts;
    for (const std::uint32_t first : {0u, 8u}) {
        room.options.sampling.first_sample = first;
        room.options.sampling.spp = first == 0 ? 8 : 16;
        parts.add(room.render().counts);
    }
    EXPECT_EQ(parts.cut_paths, whole.cut_paths);
    EXPECT_EQ(parts.cut_weight, whole.cut_weight);
}

TEST(CutPaths, DoNotChangeThePictureUpToTheirDepth) {
    // Segment 65 and later are the only difference: the expression's bound on the length, or --max-depth.
    ClosedRoom room(0.98, 0.02);
    room.options.sampling.spp = 32;
    room.options.transport.max_depth = 64;
    const Film at_64 = room.render().film;
    room.options.transport.max_depth = 4096;
    std::string up_to_64 = "LE";
    for (int i = 0; i < 63; ++i)
        up_to_64 = i == 0 ? "D" : "D(" + up_to_64 + ")?";
    room.options.transport.paths = "L(" + up_to_64 + ")?E";
    room.options.sampling.adaptive.reset();
    EXPECT_TRUE(room.render().film.sums == at_64.sums);
}

} // namespace clrt
