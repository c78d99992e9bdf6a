// SPDX-License-Identifier: Apache-2.0
// What the writers of material libraries mean, in pictures; --mtl plain shows what they wrote.
#include "probes/closed_forms.h"
#include "support/blender_mtl.h"
#include "support/film_agrees.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A square in the plane z = 0 under light of radiance 1 from everywhere, seen head-on at its middle.
class Square : public TestScene {
public:
    explicit Square(const std::string& keys, const std::string& header = "") {
        build.header(header).material("m", keys).use("m");
        build.textured_quad({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
        look_at_point({0, 0, 1}, {0, 0, 0});
        options.light.environment = glm::dvec3(1);
        options.sampling.spp = 64;
    }
    glm::dvec3 seen(MtlReading reading) {
        options.scene.mtl = reading;
        const Film film = render().film;
        return {film_estimate(film, 0).mean, film_estimate(film, 1).mean, film_estimate(film, 2).mean};
    }
};

void expect_colour(const glm::dvec3& found, const glm::dvec3& expected, double tolerance, const char* what) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << what << ", channel " << c;
}

} // namespace

TEST(MtlDialects, OpaqueMaterialsOfMayaAndOfScanToolsAreVisible) {
    Square maya("illum 4\nKd 0.50 0.25 0.75\nKa 0.00 0.00 0.00\nTf 1.00 1.00 1.00\nNi 1.00");
    expect_colour(maya.seen(MtlReading::AUTO), {0.5, 0.25, 0.75}, 1e-5, "Maya");
    expect_colour(maya.seen(MtlReading::PLAIN), {1, 1, 1}, 1e-5, "what lies behind it");
    Square scan("Ka 1 1 1\nKd 0.50 0.25 0.75\nKs 0 0 0\nTr 1.000000\nillum 1\nNs 0.000000");
    expect_colour(scan.seen(MtlReading::AUTO), {0.5, 0.25, 0.75}, 1e-5, "scan");
    expect_colour(scan.seen(MtlReading::PLAIN), {1, 1, 1}, 1e-5, "what lies behind it");
}

TEST(MtlDialects, BlendersMetalReflectsItsBaseColour) {
    Square gold("Ns 1000\nKa 1 1 1\nKd 0.9 0.6 0.2\nKs 0.5 0.5 0.5\nNi 1.5\nd 1\nillum 3", BLENDER_HEADER);
    expect_colour(gold.seen(MtlReading::AUTO), {0.9, 0.6, 0.2}, 1e-5, "gold");
    // Kd and Ks together, divided by their largest sum.
    expect_colour(gold.seen(MtlReading::PLAIN), {1, 1.1 / 1.4, 0.7 / 1.4}, 1e-2, "by the table");
}

TEST(MtlDialects, BlendersVeilCoversAndDoesNotRefract) {
    Square veil("Ns 1000\nKa 1 1 1\nKd 0.8 0.4 0.2\nKs 0.5 0.5 0.5\nNi 1.5\nd 0.5\nillum 6", BLENDER_HEADER);
    veil.options.sampling.spp = 4096;
    expect_colour(veil.seen(MtlReading::AUTO), {0.9, 0.7, 0.6}, 0.01, "half metal, half sky");
}

TEST(MtlDialects, BlendersGlassRefractsAndTints) {
    TestScene scene;
    scene.build.header(BLENDER_HEADER)
        .material("glass",
                  "Kd 0.64 0.25 1\nKs 0.5 0.5 0.5\nNi 1.5\nd 1\nillum 2\nPr 0\nPm 0\nPs 0\nPc 0\nPcr "
                  "0.03\naniso 0\nanisor 0\nTf 1 1 1")
        .material("lamp", "Kd 0 0 0\nKe 1 1 1");
    scene.build.use("glass").box({-60, -60, -0.5}, {60, 60, 0.5});
    scene.build.use("lamp").polygon({{-50, -50, -2}, {50, -50, -2}, {50, 50, -2}, {-50, 50, -2}});
    scene.look_at_point({0, 0, 5}, {0, 0, -2});
    scene.options.transport.max_depth = 30;
    scene.options.sampling.spp = 256;
    // A slab of index 1.5 lets through T^2 / (1 - R^2 Kd^2) with R = 0.04 and T = 0.96, times Kd.
    const Film film = scene.render().film;
    for (int c = 0; c < 3; ++c) {
        const double kd = c == 0 ? 0.64 : c == 1 ? 0.25 : 1;
        EXPECT_TRUE(agrees(film_estimate(film, c), kd * 0.96 * 0.96 / (1 - 0.0016 * kd * kd))) << c;
    }
}

TEST(MtlDialects, ANormalMapInMapBumpTilts) {
    for (const auto& [keys, expected] :
         {std::pair<const char*, double>{"map_Bump n.exr", 1}, // the sun stands on the mapped normal
          {"map_Bump -bm 0.5 n.exr", 0.82 / std::sqrt(0.73)},  // (0.3, 0, 0.8)
          {"map_Bump -bm -1 n.exr", 0.28}}) {
        Square scene(std::string("Kd 0.5 0.5 0.5\n") + keys);
        scene.texture("n.exr", 1, 1, 3, {0.8f, 0.5f, 0.9f});
        scene.options.light.environment = glm::dvec3(0);
        scene.options.light.suns.push_back({{0.6, 0, 0.8}, glm::dvec3(PI), 0});
        expect_colour(scene.seen(MtlReading::AUTO), glm::dvec3(0.5 * expected), 1e-4, keys);
        expect_colour(scene.seen(MtlReading::PLAIN), glm::dvec3(0.5 * 0.8), 1e-4, "flat heights");
    }
}

} // namespace clrt
