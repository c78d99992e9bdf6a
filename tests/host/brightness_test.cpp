// SPDX-License-Identifier: Apache-2.0
// Bounds of what a scene can shine and reflect, and of what a cut path lost.
#include "scene/brightness.h"

#include "kernels/shared/path_types.h"
#include "kernels/shared/render_types.h"
#include "render/cut_paths.h"
#include "support/render_scene.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double PI = 3.14159265358979323846;

/// A floor of one material.
class Floor : public TestScene {
public:
    explicit Floor(const std::string& keys) { build.material("m", keys).use("m"); }
    Floor& place() {
        build.textured_quad({{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}});
        return *this;
    }
    double albedo() { return largest_albedo(place().load()); }
};

} // namespace

TEST(Brightness, TheLargestAlbedoIsThatOfTheUsedMaterials) {
    EXPECT_FLOAT_EQ(float(Floor("Kd 0.2 0.7 0.1").albedo()), 0.7f);
    EXPECT_FLOAT_EQ(float(Floor("Kd 0.2 0.1 0.1\nKs 0.1 0.1 0.5\nillum 3").albedo()), 0.6f) << "by channel";
    EXPECT_EQ(Floor("Ni 1.5\nillum 7").albedo(), 1);
    EXPECT_EQ(Floor("Kd 0.1 0.1 0.1\nKs 0.2 0.2 0.2\nillum 5").albedo(), 1) << "Schlick's goes to 1";
    EXPECT_EQ(Floor("Kd 0 0 0").albedo(), 0);
    Floor unused("Kd 0.2 0.2 0.2");
    unused.build.material("white", "Kd 1 1 1");
    EXPECT_FLOAT_EQ(float(unused.albedo()), 0.2f);
}

TEST(Brightness, MapsCount) {
    Floor mapped("Kd 0.5 0.5 0.5\nmap_Kd k.exr");
    mapped.texture("k.exr", 2, 1, 3, {0.1f, 0.2f, 0.3f, 0.4f, 1.5f, 0.2f});
    EXPECT_FLOAT_EQ(float(mapped.albedo()), 0.5f) << "values above 1 count as 1, as in the kernels";
    Floor bytes("Kd 0.5 0.5 0.5\nmap_Kd k.png");
    bytes.texture8("k.png", 2, 1, 3, {10, 20, 30, 188, 0, 0}); // sRGB 188 is about 0.503
    EXPECT_NEAR(bytes.albedo(), 0.2515, 0.001);
    Floor lamp("Kd 0 0 0\nKe 2 1 1\nmap_Ke -mm 0.25 1000 k.exr");
    lamp.texture("k.exr", 2, 1, 3, {0.1f, 0.2f, 0.3f, 0.4f, 0, 0.2f});
    EXPECT_NEAR(largest_radiance(lamp.place().load(), KIND_AREA), 2 * 400.25, 0.01);
    EXPECT_EQ(largest_radiance(lamp.load(), KIND_SKY), 0);
}

TEST(Brightness, ARayMeetsTheSkyWithTheSunsInFrontOfIt) {
    Floor scene("Kd 0.5 0.5 0.5\nKe 3 3 3");
    scene.place();
    EXPECT_EQ(largest_radiance(scene.load(), KINDS_ALL), 3);
    scene.options.light.environment = glm::dvec3(1, 2, 1);
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(1), 2}, {{0, 1, 0}, glm::dvec3(5), 0}};
    const double radius = PI / 180, disc = 1 / (PI * std::sin(radius) * std::sin(radius));
    EXPECT_NEAR(largest_radiance(scene.load(), KINDS_ALL), 2 + disc, 1e-4 * disc);
    EXPECT_EQ(largest_radiance(scene.load(), KIND_AREA), 3);
    EXPECT_EQ(largest_delta_irradiance(scene.load(), KINDS_ALL), 5) << "the sun without a disc";
}

TEST(Brightness, PointsShineByTheirDistanceToTheNearestTriangle) {
    const auto irradiance = [](const glm::dvec3& place) {
        Floor scene("Kd 0.5 0.5 0.5");
        scene.options.light.points = {{place, glm::dvec3(4)}};
        return largest_delta_irradiance(scene.place().load(), KINDS_ALL);
    };
    EXPECT_NEAR(irradiance({0.3, 2, 0.1}).value(), 1, 1e-6) << "above a face";
    EXPECT_NEAR(irradiance({4, 0, 0.5}).value(), 4.0 / 9, 1e-6) << "beside an edge";
    EXPECT_NEAR(irradiance({2, 0, 2}).value(), 2, 1e-6) << "at a corner";
    EXPECT_EQ(irradiance({0.3, 0, 0.1}), std::nullopt) << "on the surface";
}

TEST(CutPaths, TheBoundIsAGeometricSeries) {
    Floor scene("Kd 0.75 0.75 0.75\nKe 1 1 1");
    EXPECT_NEAR(cut_radiance(scene.place().load(), KINDS_ALL).value(), 4, 1e-6);
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(PI), 0}};
    EXPECT_NEAR(cut_radiance(scene.load(), KINDS_ALL).value(), 8, 1e-5);
    EXPECT_NEAR(cut_radiance(scene.load(), KIND_AREA).value(), 4, 1e-6);
    EXPECT_EQ(cut_radiance(Floor("Kd 1 1 1\nKe 1 1 1").place().load(), KINDS_ALL), std::nullopt);
}

TEST(CutPaths, HighlightsOfLightsWithoutExtentHaveNoBound) {
    Floor scene("Kd 0.2 0.2 0.2\nKs 0.2 0.2 0.2\nNs 50\nillum 2\nKe 1 1 1");
    EXPECT_NEAR(cut_radiance(scene.place().load(), KINDS_ALL).value(), 1 / 0.6, 1e-6);
    scene.options.light.suns = {{{0, 1, 0}, glm::dvec3(PI), 0}};
    EXPECT_EQ(cut_radiance(scene.load(), KINDS_ALL), std::nullopt);
}

TEST(CutPaths, TheBoundIsTheMeanOverThePicture) {
    RenderProgress render;
    render.film.width = 2;
    render.film.ranges = {{0, 4}};
    render.film.height = 1;
    render.film.sums.assign(6, 8); // mean 2 in quanta of 1
    EXPECT_EQ(cut_paths(render, std::nullopt).light_bound, 0.0) << "nothing was cut";
    EXPECT_EQ(format_cut(cut_paths(render, 1)), "");
    render.counts.cut_paths = 3;
    render.counts.cut_weight = 2 * CUT_WEIGHT_UNITS;
    EXPECT_EQ(cut_paths(render, 10).light_bound, 2.5) << "2 of weight on 8 samples";
    EXPECT_EQ(cut_paths(render, 10).relative_bound, 1.25);
    EXPECT_EQ(cut_paths(render, std::nullopt).light_bound, std::nullopt);
    EXPECT_NE(format_cut(cut_paths(render, 10)).find("3 of 8 paths ended by --max-depth"), std::string::npos);
    // An adaptive film, whose tiles have 2 to 6 samples.
    render.film.replicates = 2;
    render.film.sums.assign(12, 4);
    render.film.tile_samples = {std::vector<std::uint32_t>{1}, std::vector<std::uint32_t>{3}};
    EXPECT_EQ(cut_paths(render, 10).light_bound, 5.0) << "as if both halves had the fewer samples";
}

} // namespace clrt
