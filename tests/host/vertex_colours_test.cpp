// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/obj_colours.h"

#include "colour.h"
#include "scene/load_scene.h"
#include "scene_support.h"

#include <cstring>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A triangle whose vertices have these numbers behind their positions.
std::string triangle(const std::string& a, const std::string& b, const std::string& c) {
    return "v 0 0 0 " + a + "\nv 1 0 0 " + b + "\nv 0 1 0 " + c + "\n";
}

Scene load(const TemporaryFolder& folder, const std::string& obj) {
    Options options;
    options.scene.path = folder.write("a.obj", obj);
    options.light.studio = false; // its ground is not of the file
    Progress silent(Toggle::OFF, true);
    return load_scene(options, silent);
}

glm::vec3 stored(const Scene& scene, u32 vertex) {
    glm::vec3 colour(-1);
    for (const Texture& texture : scene.textures)
        if (texture.format == TEXEL_VERTEX)
            std::memcpy(&colour, &scene.texel_words.at(texture.vertex_word + 3 * vertex), sizeof colour);
    return colour;
}

glm::vec3 linear(double r, double g, double b) {
    return {float(srgb_to_linear(r)), float(srgb_to_linear(g)), float(srgb_to_linear(b))};
}

} // namespace

TEST(VertexColours, BecomeTexelsOfTheKdMap) {
    const TemporaryFolder folder;
    const Scene scene = load(folder, triangle("1 0.5 0", "", "0.2 0.2 0.2") + "f 1 2 3\n");
    EXPECT_EQ(stored(scene, 0), linear(1, 0.5, 0));
    EXPECT_EQ(stored(scene, 1), glm::vec3(1)) << "a vertex without a colour";
    EXPECT_EQ(stored(scene, 2), linear(0.2, 0.2, 0.2));
    EXPECT_EQ(scene.materials[0].matte.x, 1);
    EXPECT_EQ(scene.textures[scene.materials[0].map_matte].format, TEXEL_VERTEX);
    EXPECT_EQ(scene.material_rules[0], "no material: matte, Kd of the vertices");
    EXPECT_EQ(scene.texture_places[0].line, 1u);
    EXPECT_TRUE(scene.vertex_colours.empty());
    EXPECT_EQ(count_notices(scene.notices, "a.obj:1: vertex colours (v x y z r g b), sRGB"), 1);
}

TEST(VertexColours, WholeNumbersTo255AreBytes) {
    const TemporaryFolder folder;
    EXPECT_EQ(stored(load(folder, triangle("255 128 0", "0 0 0", "1 1 1") + "f 1 2 3\n"), 0),
              linear(1, 128 / 255., 0));
    EXPECT_EQ(stored(load(folder, triangle("1 1 0", "0 0 0", "1 1 1") + "f 1 2 3\n"), 0), linear(1, 1, 0));
    const Scene above = load(folder, triangle("1.5 0.5 0", "0 0 0", "1 1 1") + "f 1 2 3\n");
    EXPECT_EQ(stored(above, 0), linear(1, 0.5, 0));
    EXPECT_EQ(count_notices(above.notices, "above 1 are clamped"), 1);
}

TEST(VertexColours, WhatIsNoColourIsLeftAlone) {
    const TemporaryFolder folder;
    for (const char* numbers : {"-0.5 0 1", "256 0 0", "inf 0 0", "0 nan 0"}) {
        const Scene scene = load(folder, triangle(numbers, "0 0 0", "0 0 0") + "f 1 2 3\n");
        EXPECT_TRUE(scene.textures.empty()) << numbers;
        EXPECT_EQ(count_notices(scene.notices, "that are no colours are ignored"), 1) << numbers;
    }
    for (const char* numbers : {"1", "1 0", "1 0 x", "# 1 0 0"})
        EXPECT_TRUE(load(folder, triangle(numbers, "", "") + "f 1 2 3\n").textures.empty()) << numbers;
}

TEST(VertexColours, OnlyMaterialsOfColouredTrianglesWithoutAMapTakeThem) {
    const TemporaryFolder folder;
    folder.write_image("map.png", 1, 1, 3, std::vector<std::uint8_t>{10, 20, 30}, OIIO::TypeDesc::UINT8);
    folder.write("m.mtl", "newmtl key\nKd 0.5 0.5 0.5\nnewmtl mapped\nmap_Kd map.png\nnewmtl plain\nKd 0.3\n"
                          "newmtl metal\nKd 0.9\nPm 1\nPr 0.2\n");
    const Scene scene =
        load(folder, "mtllib m.mtl\n" + triangle("1 0 0", "", "") +
                         "v 0 0 1\nv 1 0 1\nv 0 1 1\nusemtl key\nf 1 2 3\nusemtl mapped\nf 1 2 3\n"
                         "usemtl plain\nf 4 5 6\nusemtl metal\nf 1 5 6\n");
    const auto format = [&](u32 map) { return map == NO_INDEX ? NO_INDEX : scene.textures[map].format; };
    EXPECT_EQ(format(scene.materials[0].map_matte), TEXEL_VERTEX);
    EXPECT_EQ(scene.materials[0].matte.x, 0.5f);
    EXPECT_EQ(format(scene.materials[1].map_matte), TEXEL_SRGB8);
    EXPECT_EQ(format(scene.materials[2].map_matte), NO_INDEX);
    EXPECT_EQ(format(scene.materials[3].map_specular), TEXEL_VERTEX) << "of a metal Kd is the reflection";
    EXPECT_EQ(count_notices(scene.notices, "map_Kd is taken, the vertex colours have no effect"), 1);
}

TEST(VertexColours, CutTrianglesKeepThem) {
    // A ground beside a small thing is cut at the middles of its edges.
    const TemporaryFolder folder;
    const Scene scene =
        load(folder, "v -1e6 0 -1e6 0 0 0\nv 1e6 0 -1e6 1 1 1\nv 1e6 0 1e6 1 1 1\nv -1e6 0 1e6 0 0 0\n"
                     "f 1 4 3 2\nv 0 1 0\nv 1 1 0\nv 0 1 1\nf 5 6 7\n");
    ASSERT_GT(scene.positions.size(), 20u);
    for (u32 v = 0; v < scene.positions.size(); ++v)
        if (v < 4 || v > 6) {
            EXPECT_NEAR(stored(scene, v).x, (scene.positions[v].x / scene.positions[1].x + 1) / 2, 1e-6);
        }
}

} // namespace clrt
