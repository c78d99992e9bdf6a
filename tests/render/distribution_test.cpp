// SPDX-License-Identifier: Apache-2.0
// The tree of `distribution`: how many rays it has, and that its light is that of `path` for the same paths,
// tile by tile, and of `whitted` where that sees the same.
#include "probes/film_estimate.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <vector>

namespace clrt {

namespace {

/// What `distribution` simulates, in the notation of --paths.
const char* const SIMULATED = "LD?(G|S)*E";

std::uint64_t samples(const TestScene& scene) {
    return std::uint64_t(scene.options.film.size.x) * std::uint64_t(scene.options.film.size.y) *
           *scene.options.sampling.spp;
}

/// A scene of this file: numbers of rays and expressions make programs of their own, which nothing shares, so
/// that the small one is the fast one.
class TreeScene : public TestScene {
public:
    TreeScene() {
        options.effects.all = false;
        options.transport.integrator = Integrator::DISTRIBUTION;
        options.transport.min_contribution = 0;
        options.sampling.spp = 16;
    }
    void branches(int shadow, int gloss, int translucent) {
        options.transport.shadow_rays = shadow;
        options.transport.gloss_rays = gloss;
        options.transport.translucent_rays = translucent;
    }
};

/// A floor of one material under a lamp, a sun with a disc, a point and a constant sky.
class LitFloor : public TreeScene {
public:
    explicit LitFloor(const std::string& keys) {
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1").material("floor", keys).use("floor").floor(9);
        build.use("lamp").polygon({{-1, 3, -1}, {1, 3, -1}, {1, 3, 1}, {-1, 3, 1}});
        options.light.suns.push_back({{0.3, 1, 0}, glm::dvec3(1), 2});
        options.light.points.push_back({{0, 2, 1}, glm::dvec3(1)});
        options.light.environment = glm::dvec3(1);
        look_at_point({0.5, 0.5, 0}, {0, 0, 0});
    }
};

/// Plates and balls of every kind of surface, seen in each other, and a lamp that the picture shows; other
/// lights are the caller's.
class Room : public TreeScene {
public:
    Room() {
        build.material("matte", "Kd 0.6 0.5 0.4").material("metal", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.35");
        build.material("varnish", "Kd 0.5 0.2 0.1\nPm 0\nPr 0.25").material("mirror", "Ks .9 .9 .9\nillum 3");
        build.material("rough", "Ni 1.5\nillum 7\nPr 0.4").material("glass", "Ni 1.5\nillum 7");
        build.material("lamp", "Kd 0 0 0\nKe 6 5 4").use("matte").floor(3);
        build.use("varnish").polygon({{-3, 0, -2}, {3, 0, -2}, {3, 3, -2}, {-3, 3, -2}});
        build.use("metal").polygon(
            {{-1.5, 0.1, 0.6}, {-0.4, 0.1, 0.6}, {-0.4, 0.5, -0.5}, {-1.5, 0.5, -0.5}});
        build.use("rough").icosphere({0.8, 0.5, 0}, 0.5, 2, Facing::OUTWARD, Shading::SMOOTH);
        build.use("mirror").icosphere({-0.9, 1.2, -0.8}, 0.4, 1);
        build.use("glass").box({-0.3, 0.05, 0.5}, {0.2, 0.6, 0.8});
        for (const double x : {-1.5, 0.0, 1.2})
            build.use("lamp").polygon({{x, 2, -1}, {x + 0.4, 2, -1}, {x + 0.4, 2, -0.5}, {x, 2, -0.5}});
        look({0, 1.6, 4}, {0, 0.7, 0}, 50);
        options.film.size = {32, 32};
        options.sampling.spp = 256;
        options.sampling.replicates = 64;
        options.transport.max_depth = 5;
    }
    /// `path`, with as many samples more as noise asks for.
    void follow_paths(const char* expression) {
        options.transport.integrator = Integrator::PATH;
        options.transport.paths = expression;
        options.sampling.spp = 1024;
    }
};

/// The largest |z| and the mean z^2 of the differences of two films' tiles of 8 x 8 pixels.
struct TileDifference {
    double largest = 0, mean_square = 0;
};

TileDifference tile_difference(const Film& a, const Film& b) {
    TileDifference difference;
    double squares = 0;
    int count = 0;
    for (int y = 0; y < a.height; y += 8)
        for (int x = 0; x < a.width; x += 8)
            for (int channel = 0; channel < 3; ++channel) {
                const Estimate one = film_estimate(a, channel, {x, y, x + 8, y + 8});
                const Estimate other = film_estimate(b, channel, {x, y, x + 8, y + 8});
                const double error = std::hypot(one.error, other.error);
                const double z = error > 0 ? (one.mean - other.mean) / error : 0; // both black
                difference.largest = std::max(difference.largest, std::abs(z));
                squares += z * z;
                ++count;
            }
    difference.mean_square = squares / count;
    return difference;
}

void expect_same_light(const Film& a, const Film& b, const std::string& what) {
    const TileDifference difference = tile_difference(a, b);
    EXPECT_LT(difference.largest, 6) << what;
    // Tiles and channels depend on each other: the sum of squares spreads more than that of as many.
    EXPECT_LT(difference.mean_square, 1.9) << what;
}

} // namespace

TEST(Distribution, AMatteFloorSendsShadowRaysAlone) {
    LitFloor scene("Kd 0.5 0.5 0.5");
    for (const int rays : {1, 4, 7}) {
        scene.branches(rays, 9, 9);
        const Render render = scene.render();
        // Lamp, sun and sky have an extent, the point has none.
        EXPECT_EQ(render.counts.shadow, std::uint64_t(3 * rays + 1) * samples(scene)) << rays;
        EXPECT_EQ(render.counts.secondary, 0u) << rays;
    }
}

TEST(Distribution, RoughSurfacesBranchOnceAndGoOnSingly) {
    // Between two rough walls, which close the view together, every vertex sends rays on.
    TreeScene scene;
    scene.build.material("wall", "Kd 1 1 1\nPm 1\nPr 0.9").use("wall");
    scene.build.polygon({{-99, -99, -1}, {99, -99, -1}, {99, 99, -1}, {-99, 99, -1}});
    scene.build.polygon({{-99, 99, 1}, {99, 99, 1}, {99, -99, 1}, {-99, -99, 1}});
    scene.options.light.points.push_back({{0, 0, 0.9}, glm::dvec3(1)});
    scene.look_at_point({0, 0, 0.5}, {0, 0, -1});
    for (const auto& [rays, depth] : {std::pair{1, 5}, {8, 2}, {8, 5}, {64, 3}}) {
        scene.branches(1, rays, 1);
        scene.options.transport.max_depth = depth;
        const double all = double(rays * (depth - 1)) * double(samples(scene));
        const double traced = double(scene.render().counts.secondary);
        EXPECT_LE(traced, all) << rays << ", depth " << depth;
        EXPECT_GT(traced, 0.5 * all) << rays << ", depth " << depth << ": some facets send light inwards";
    }
}

TEST(Distribution, BranchesBehindAMirrorAreWhole) {
    TreeScene scene;
    scene.build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3").material("wall", "Kd 1 1 1\nPm 1\nPr 0.02");
    scene.build.use("mirror").polygon({{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}});
    scene.build.use("wall").polygon({{-9, 9, 1}, {9, 9, 1}, {9, -9, 1}, {-9, -9, 1}});
    scene.options.light.environment = glm::dvec3(1);
    scene.look_at_point({0, 0, 0.5}, {0, 0, -1});
    scene.options.transport.max_depth = 3;
    scene.branches(1, 8, 1);
    EXPECT_EQ(scene.render().counts.secondary, (1 + 8) * samples(scene));
}

TEST(Distribution, ItEqualsPathsOfTheSameClasses) {
    Room room;
    room.options.light.points.push_back({{1.5, 1, 1}, {0.4, 0.4, 0.5}});
    room.options.light.suns.push_back({{-1, 2, 1}, {0.6, 0.5, 0.4}, 4});
    room.options.light.environment = glm::dvec3(0.1, 0.12, 0.15);
    std::vector<Film> trees;
    for (const auto& shadow_and_others : {std::array{1, 1, 1}, std::array{4, 4, 4}, std::array{3, 2, 8}}) {
        room.branches(shadow_and_others[0], shadow_and_others[1], shadow_and_others[2]);
        trees.push_back(room.render().film);
    }
    room.follow_paths(SIMULATED);
    const Film simulated = room.render().film;
    room.follow_paths("");
    const Film all = room.render().film;
    for (const Film& tree : trees) {
        expect_same_light(tree, simulated, "tree " + std::to_string(&tree - trees.data()));
        EXPECT_GT(tile_difference(tree, all).largest, 20) << "matte surfaces light each other";
    }
}

TEST(Distribution, ItEqualsPathsUnderAMapAndWithTheTableOfLamps) {
    Room room;
    std::vector<float> sky;
    for (int i = 0; i < 16 * 8 * 3; ++i)
        sky.push_back(i / 3 == 37 ? 20.0f : 0.05f * float(i % 11));
    room.texture("sky.exr", 16, 8, 3, sky);
    room.options.light.environment_file = room.folder.file("sky.exr");
    for (const LightSampler sampler : {LightSampler::TREE, LightSampler::MIXTURE}) {
        room.options.sampling.light_sampler = sampler;
        room.options.transport.integrator = Integrator::DISTRIBUTION;
        room.options.transport.paths.clear();
        room.options.sampling.spp = 256;
        const Film tree = room.render().film;
        room.follow_paths(SIMULATED);
        expect_same_light(tree, room.render().film, name_of(sampler));
    }
}

TEST(Distribution, RaysAndShadowRaysShareALightByTheirNumbers) {
    // Where a rough floor mirrors the edge of a lamp, and the lamp's size is that of the lobe.
    for (const char* const keys : {"Kd 1 1 1\nPm 1\nPr 0.5", "Ni 1.5\nillum 7\nPr 0.6"}) {
        TreeScene scene;
        scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").material("floor", keys).use("floor").floor(9);
        scene.build.use("lamp").polygon({{-1.5, 1, -0.6}, {-0.5, 1, -0.6}, {-0.5, 1, 0.6}, {-1.5, 1, 0.6}});
        scene.options.light.suns.push_back({{-1, 1.2, 1.1}, glm::dvec3(0.2), 20});
        scene.look_at_point({1, 1, 0}, {0, 0, 0});
        scene.options.transport.max_depth = 2;
        scene.options.sampling.spp = 2048;
        // A table would choose this one nearly always, the tree does not.
        scene.build.material("far", "Kd 0 0 0\nKe 40 40 40").use("far");
        scene.build.polygon({{-30, 9, -2}, {-30, 9, 2}, {-30, 13, 2}, {-30, 13, -2}});
        scene.options.transport.integrator = Integrator::PATH;
        scene.options.transport.paths = SIMULATED;
        const Estimate path = film_estimate(scene.render().film);
        scene.options.transport.integrator = Integrator::DISTRIBUTION;
        scene.options.transport.paths.clear();
        for (const auto& [shadow, others] : {std::pair{1, 1}, {1, 4}, {4, 1}}) {
            scene.branches(shadow, others, others);
            const Estimate tree = film_estimate(scene.render().film);
            EXPECT_LT(std::hypot(path.error, tree.error), 3e-3 * path.mean);
            EXPECT_LT(std::abs(tree.mean - path.mean), 6 * std::hypot(path.error, tree.error))
                << keys << ", " << shadow << " and " << others << ": " << tree.mean << ", " << path.mean;
        }
    }
}

TEST(Distribution, EndingRaysByChanceKeepsTheMean) {
    Room room;
    const Film whole = room.render().film;
    room.options.transport.min_contribution = 0.2;
    const Render ended = room.render();
    expect_same_light(whole, ended.film, "a fifth");
    room.options.transport.min_contribution = 0;
    EXPECT_LT(ended.counts.secondary, room.render().counts.secondary / 2);
}

TEST(Distribution, ExpressionsAddUpToThePicture) {
    Room room;
    room.options.light.points.push_back({{1.5, 1, 1}, {0.4, 0.4, 0.5}});
    room.options.light.environment = glm::dvec3(0.1, 0.12, 0.15);
    room.options.sampling.spp = 64;
    const char* const parts[] = {"LD(G|S)*E", "LG(G|S)*E", "LS(G|S)*E", "LE"};
    room.options.output.path_layers.clear();
    for (const char* part : parts)
        room.options.output.path_layers.push_back({std::string("part") + part[1], part});
    const Render render = room.render();
    ASSERT_EQ(render.path_layers.size(), 4u);
    double brightness = 0;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const double whole = film_pixel(render.film, x, y).x;
            double sum = 0;
            for (const Film& layer : render.path_layers)
                sum += film_pixel(layer, x, y).x;
            EXPECT_NEAR(sum, whole, 1e-5 * (1 + whole)) << x << ", " << y;
            brightness += whole;
        }
    EXPECT_GT(brightness, 0);
    room.options.output.path_layers.clear();
    for (const char* part : parts) { // and each is the picture of its paths alone
        room.options.transport.paths = part;
        const Film alone = room.render().film;
        room.options.transport.integrator = Integrator::PATH;
        room.options.sampling.spp = 256;
        expect_same_light(alone, room.render().film, part);
        room.options.transport.integrator = Integrator::DISTRIBUTION;
        room.options.sampling.spp = 64;
    }
}

TEST(Distribution, ItIsWhittedWhereThatSeesTheSame) {
    TreeScene scene;
    scene.build.material("mirror", "Kd 0 0 0\nKs 0.8 0.7 0.6\nillum 3").material("matte", "Kd 0.5 0.5 0.5");
    scene.build.material("glass", "Ni 1.5\nillum 7").use("matte").floor(3);
    scene.build.use("mirror").polygon({{-2, 0.1, -2}, {2, 0.1, -2}, {2, 3, -2}, {-2, 3, -2}});
    scene.build.use("glass").icosphere({0.3, 0.5, -0.5}, 0.45, 2, Facing::OUTWARD, Shading::SMOOTH);
    scene.options.light.points = {{{1, 2, 0}, glm::dvec3(4)}, {{-1, 1, 1}, glm::dvec3(1)}};
    scene.look({0, 1, 2}, {0, 0.5, 0}, 50);
    scene.options.film.size = {32, 32};
    const Render tree = scene.render();
    scene.options.transport.integrator = Integrator::WHITTED;
    const Render whitted = scene.render();
    EXPECT_EQ(tree.counts.secondary, whitted.counts.secondary);
    EXPECT_EQ(tree.counts.shadow, whitted.counts.shadow);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_NEAR(film_pixel(tree.film, x, y).y, film_pixel(whitted.film, x, y).y, 2e-5)
                << x << ", " << y;
}

TEST(Distribution, EveryRayOfADeepTreeHasRandomNumbersOfItsOwn) {
    // As of whitted's tree: each ray passes a screen that lets 98 % through by chance.
    TreeScene scene;
    scene.build.material("mirror", "Kd 0 0 0\nillum 3\nKs 1 1 1\nKe 0.01 0.01 0.01").use("mirror");
    scene.build.polygon({{-9, -9, -1}, {9, -9, -1}, {9, 9, -1}, {-9, 9, -1}});
    scene.build.polygon({{-9, 9, 1}, {9, 9, 1}, {9, -9, 1}, {-9, -9, 1}});
    scene.build.material("screen", "Kd 0 0 0\nd 0.02").use("screen");
    scene.build.polygon({{-9, -9, 0.25}, {9, -9, 0.25}, {9, 9, 0.25}, {-9, 9, 0.25}});
    scene.look_at_point({0, 0, 0.5}, {0, 0, -1});
    scene.options.sampling.spp = 256;
    for (const int depth : {14, 64}) {
        scene.options.transport.max_depth = depth;
        const double expected = 0.01 * 0.98 * (1 - std::pow(0.98, depth)) / (1 - 0.98);
        EXPECT_TRUE(agrees(film_estimate(scene.render().film), expected, 4e-3)) << depth;
    }
}

TEST(Distribution, ShadowRaysOfASampleAreEvenOverTheLamp) {
    // Sixteen rays of one sample leave less noise than sixteen samples of white noise would: one in four.
    LitFloor scene("Kd 0.5 0.5 0.5");
    scene.options.light = {};
    scene.options.light.environment = glm::dvec3(0);
    scene.options.film.size = {32, 32};
    scene.options.sampling.spp = 64;
    scene.options.sampling.replicates = 64; // a sample each
    const auto error = [&](int rays) {
        scene.branches(rays, 1, 1);
        return film_estimate(scene.render().film).error;
    };
    EXPECT_LT(error(16), error(1) / 8);
}

} // namespace clrt
