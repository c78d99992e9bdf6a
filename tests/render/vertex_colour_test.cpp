// SPDX-License-Identifier: Apache-2.0
// Colours of vertices multiply Kd: linear between the vertices, sRGB in the file.
#include "colour.h"
#include "kernels/shared/effects.h"
#include "probes/film_estimate.h"
#include "support/render_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A triangle (-1,-1) (1,-1) (0,1) under a white sky, its vertices in three colours, seen straight at a
/// point.
struct Coloured : TestScene {
    Coloured(const std::string (&colours)[3], const glm::dvec3& at, const std::string& usemtl = "") {
        const char* const corners[3] = {"-1 -1 0", "1 -1 0", "0 1 0"};
        std::string text;
        for (int k = 0; k < 3; ++k)
            text += fmt::format("v {} {}\n", corners[k], colours[k]);
        build.raw(text + usemtl + "f 1 2 3");
        options.light.environment = glm::dvec3(1);
        options.transport.integrator = Integrator::RAYCAST;
        options.sampling.spp = 16;
        options.sampling.replicates = 1;
        look_at_point(at + glm::dvec3(0, 0, 3), at);
    }
};

/// The radiance in the middle of the picture.
glm::dvec3 colour_of(const TestScene& scene) {
    return film_pixel(scene.render().film, 8, 8);
}

void expect_near(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << c;
}

/// Raycast's light from a constant sky is exact but for rounding: the surface returns its albedo.
constexpr double ROUNDING = 1e-5;

/// Across a picture of 0.003 units colours change by 0.0015 at most; the samples' mean is nearer to the
/// middle.
constexpr double FOOTPRINT = 1e-3;

} // namespace

TEST(VertexColour, VerticesAreReadAsSrgbAndInterpolatedLinearly) {
    const std::string numbers[3] = {"1 0 0", "0 1 0", "0.5 0.5 0.5"},
                      bytes[3] = {"255 0 0", "0 255 0", "51 51 51"};
    const auto expected = [](const glm::dvec3& at, double third) {
        const double b2 = (at.y + 1) / 2, b1 = (at.x + 1 - b2) / 2;
        return (1 - b1 - b2) * glm::dvec3(1, 0, 0) + b1 * glm::dvec3(0, 1, 0) + b2 * glm::dvec3(third);
    };
    for (const glm::dvec3& at :
         {glm::dvec3(0, -0.5, 0), glm::dvec3(-0.97, -0.99, 0), glm::dvec3(0, 0.96, 0)}) {
        expect_near(colour_of(Coloured(numbers, at)), expected(at, srgb_to_linear(0.5)), FOOTPRINT);
        expect_near(colour_of(Coloured(bytes, at)), expected(at, srgb_to_linear(0.2)), FOOTPRINT);
    }
}

TEST(VertexColour, AMaterialIsMultipliedUnlessItHasAMap) {
    const std::string corners[3] = {"1 0.5 1", "1 0.5 1", "1 0.5 1"};
    const glm::dvec3 at(0, -0.2, 0), colour(1, srgb_to_linear(0.5), 1);
    Coloured by_key(corners, at, "usemtl red\n");
    by_key.build.material("red", "Kd 0.5 0.4 0.25");
    expect_near(colour_of(by_key), glm::dvec3(0.5, 0.4, 0.25) * colour, ROUNDING);
    Coloured by_map(corners, at, "usemtl mapped\n");
    by_map.texture("map.exr", 1, 1, 3, {0.5f, 0.25f, 0.75f});
    by_map.build.material("mapped", "map_Kd map.exr");
    by_map.build.raw("vt 0 0");
    expect_near(colour_of(by_map), {0.5, 0.25, 0.75}, ROUNDING);
    Coloured beside(corners, at, "usemtl dark\n");
    beside.build.material("dark", "Ke 0 0 0");
    expect_near(colour_of(beside), colour, ROUNDING);
}

TEST(VertexColour, WhiteVerticesAreTheBitsOfNoColours) {
    const std::string none[3] = {"", "", ""}, white[3] = {"1 1 1", "1 1 1", "1 1 1"};
    for (const Integrator integrator :
         {Integrator::PATH, Integrator::DISTRIBUTION, Integrator::WHITTED, Integrator::RAYCAST})
        for (const bool all : {true, false}) {
            Coloured plain(none, {0, 0, 0}, "usemtl grey\n"), coloured(white, {0, 0, 0}, "usemtl grey\n");
            for (Coloured* scene : {&plain, &coloured}) {
                scene->build.material("grey", "Kd 0.6 0.5 0.4\nPm 1\nPr 0.4");
                scene->options.transport.integrator = integrator;
                scene->options.effects.all = all;
                scene->look({0, 0.4, 3}, {0, 0, 0}, 50);
            }
            EXPECT_TRUE(plain.render().film.sums == coloured.render().film.sums);
            EXPECT_EQ(find_effects(plain.load(), plain.options).needed & EFFECT_TEXTURES, 0u);
            EXPECT_NE(find_effects(coloured.load(), coloured.options).needed & EFFECT_TEXTURES, 0u);
        }
}

TEST(VertexColour, WithoutTexturesTheColoursAreTakenOut) {
    const std::string corners[3] = {"1 0 0", "1 0 0", "1 0 0"};
    Coloured scene(corners, {0, 0, 0});
    scene.options.effects.all = false;
    scene.options.effects.off = EFFECT_TEXTURES;
    expect_near(colour_of(scene), glm::dvec3(1), ROUNDING);
}

} // namespace clrt
