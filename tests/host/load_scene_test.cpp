// SPDX-License-Identifier: Apache-2.0
// From files to a scene, and the fallbacks on the way.
#include "scene/load_scene.h"

#include "error.h"
#include "scene_support.h"
#include "support/blender_mtl.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

using namespace clrt;

namespace {

const char* const QUAD = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";

Scene load(Options options) {
    Progress progress(Toggle::OFF, true);
    return load_scene(options, progress);
}

/// Without the studio, whose ground is not of the file.
Scene load(const std::string& path) {
    Options options;
    options.scene.path = path;
    options.light.studio = false;
    return load(options);
}

std::string quad(const std::string& before, const std::string& usemtl) {
    return before + QUAD + usemtl + "f 1 2 3 4\n";
}

} // namespace

TEST(LoadScene, AnObjAloneIsGreyUnderAWhiteSky) {
    const TemporaryFolder folder;
    const Scene scene = load(folder.write("a.obj", quad("", "")));
    EXPECT_EQ(scene.triangles.size(), 2u);
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_FLOAT_EQ(scene.materials[0].matte.x, 0.8f);
    EXPECT_EQ(scene.environment.radiance, glm::dvec3(1));
    EXPECT_TRUE(scene.emitters.empty());
    EXPECT_EQ(scene.emitted_power, 0);
    EXPECT_EQ(scene.texel_words.size(), 256u) << "the sRGB table is always there";
    EXPECT_EQ(count_notices(scene.notices, "no light in the scene"), 1);
    EXPECT_EQ(count_notices(scene.notices, "camera: --eye"), 1);
    EXPECT_EQ(scene.notices.size(), 2u);
    EXPECT_EQ(scene.statistics.obj_bytes, std::filesystem::file_size(folder.path("a.obj")));
}

TEST(LoadScene, EmissionLightsTheSceneInsteadOfTheSky) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl lamp\nKe 2 2 2\n");
    const Scene scene = load(folder.write("a.obj", quad("mtllib a.mtl\n", "usemtl lamp\n")));
    ASSERT_EQ(scene.emitters.size(), 2u);
    EXPECT_EQ(scene.environment.radiance, glm::dvec3(0));
    EXPECT_EQ(count_notices(scene.notices, "no light"), 0);
    EXPECT_EQ(scene.triangles[1].emitter, 1u);
    // pi area L in the normalised frame: the half-diagonal sqrt 2 is in [1, 2) already.
    EXPECT_EQ(scene.normalisation.scale, 1);
    EXPECT_NEAR(scene.emitted_power, M_PI * 4 * 2, 1e-6);
    EXPECT_NEAR(scene.emitters[0].pdf_a, 0.25, 1e-6);
}

TEST(LoadScene, TwoSidedLightsAndCoverageChangeThePower) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl lamp\nKe 2 2 2\nd 0.25\n");
    Options options;
    options.scene.path = folder.write("a.obj", quad("mtllib a.mtl\n", "usemtl lamp\n"));
    EXPECT_NEAR(load(options).emitted_power, M_PI * 4 * 2 * 0.25, 1e-6);
    options.light.two_sided = true;
    EXPECT_NEAR(load(options).emitted_power, M_PI * 4 * 2 * 0.5, 1e-6);
}

TEST(LoadScene, EmissionMapsCountWithTheirMean) {
    const TemporaryFolder folder;
    folder.write_image("half.exr", 2, 1, 3, std::vector<float>{1, 1, 1, 0, 0, 0}, OIIO::TypeDesc::FLOAT);
    folder.write_image("black.png", 1, 1, 1, std::vector<std::uint8_t>{0}, OIIO::TypeDesc::UINT8);
    folder.write("a.mtl", "newmtl lamp\nKe 2\nmap_Ke half.exr\nnewmtl dark\nKe 5\nmap_Ke black.png\n");
    EXPECT_NEAR(load(folder.write("a.obj", quad("mtllib a.mtl\n", "usemtl lamp\n"))).emitted_power, M_PI * 4,
                1e-6);
    const Scene dark = load(folder.write("b.obj", quad("mtllib a.mtl\n", "usemtl dark\n")));
    EXPECT_TRUE(dark.emitters.empty());
    EXPECT_EQ(count_notices(dark.notices, "no light in the scene"), 1);
}

TEST(LoadScene, LightOptionsReplaceTheDefaultSky) {
    const TemporaryFolder folder;
    Options options;
    options.scene.path = folder.write("a.obj", quad("", ""));
    options.light.environment = glm::dvec3(0);
    EXPECT_EQ(count_notices(load(options).notices, "no light"), 0);
    options.light.environment.reset();
    options.light.points.push_back({glm::dvec3(0, 1, 0), glm::dvec3(1)});
    const Scene scene = load(options);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.environment.radiance, glm::dvec3(0));
    EXPECT_NEAR(scene.emitted_power, 4 * M_PI, 1e-6);
}

TEST(LoadScene, MissingLibrariesAndMaterialsAreGreyWithOneNoticeEach) {
    const TemporaryFolder folder;
    const Scene scene =
        load(folder.write("a.obj", std::string("mtllib none.mtl\n") + QUAD +
                                       "usemtl red\nf 1 2 3\nusemtl blue\nf 1 3 4\nusemtl red\nf 2 3 4\n"));
    ASSERT_EQ(scene.materials.size(), 2u);
    EXPECT_FLOAT_EQ(scene.materials[1].matte.y, 0.8f);
    EXPECT_EQ(count_notices(scene.notices, "a.obj:1: mtllib: no file 'none.mtl' found"), 1);
    EXPECT_EQ(count_notices(scene.notices, "a.obj:6: usemtl 'red'"), 1);
    EXPECT_EQ(count_notices(scene.notices, "a.obj:8: usemtl 'blue'"), 1);
    EXPECT_EQ(scene.triangles[2].material, scene.triangles[0].material);
}

TEST(LoadScene, MaterialsKnowWhereTheyWereDefined) {
    const TemporaryFolder folder;
    folder.write("lib/a.mtl", "# c\nnewmtl unused\n\nnewmtl used\nKd 0.5\n");
    const Scene scene = load(folder.write("a.obj", quad("mtllib lib/a.mtl\n", "usemtl used\n")));
    ASSERT_EQ(scene.material_names.size(), 1u) << "unused materials are left out";
    EXPECT_EQ(scene.material_names[0], "used");
    EXPECT_EQ(scene.material_places[0].line, 4u);
    EXPECT_EQ(scene.material_places[0].file, folder.path("lib/a.mtl"));
    EXPECT_EQ(scene.material_rules[0], "illum 1: matte Kd");
}

TEST(LoadScene, TexturesAreFoundBesideTheirLibrary) {
    const TemporaryFolder folder;
    folder.write("lib/a.mtl", "newmtl m\nmap_Kd my wood.png\nmap_d my wood.png\nbump -bm 0.5 my wood.png\n");
    folder.write_image("lib/my wood.png", 2, 2, 4, std::vector<std::uint8_t>(16, 128), OIIO::TypeDesc::UINT8);
    const Scene scene = load(folder.write("a.obj", quad("mtllib lib/a.mtl\n", "usemtl m\n")));
    ASSERT_EQ(scene.textures.size(), 3u);
    EXPECT_EQ(scene.texture_names[0], "my wood.png");
    EXPECT_EQ(scene.texel_words.size(), 256u + 2 * 4) << "colours and mask share their texels";
    EXPECT_EQ(scene.materials[0].map_matte, 0u);
    EXPECT_EQ(scene.materials[0].map_coverage, 1u);
    EXPECT_EQ(scene.materials[0].map_bump, 2u);
}

TEST(LoadScene, BumpHeightsFollowTheScale) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\nbump -bm 0.5 b.png\n");
    folder.write_image("b.png", 1, 1, 1, std::vector<std::uint8_t>{9}, OIIO::TypeDesc::UINT8);
    const Scene scene =
        load(folder.write("a.obj", "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 64 0 0\nv 0 64 0\nf 1 2 3\n"));
    EXPECT_EQ(scene.normalisation.scale, 1. / 32);
    EXPECT_EQ(scene.materials[0].bump_scale, 0.5f / 32);
}

TEST(LoadScene, LibrariesAreReadAsTheirWritersMeanThem) {
    const TemporaryFolder folder;
    folder.write("a.mtl", BLENDER_PBR_MTL);
    for (const char* name :
         {"colour.png", "level.png", "metal.png", "roughness.png", "mask.png", "relief.png"})
        folder.write_image(name, 1, 1, 3, std::vector<std::uint8_t>{128, 128, 255}, OIIO::TypeDesc::UINT8);
    Options options;
    options.scene.path = folder.write("a.obj", quad("mtllib a.mtl\n", "usemtl glass\n") +
                                                   "usemtl mapped\nf 1 2 3\nusemtl coated\nf 1 2 3\n");
    const Scene scene = load(options);
    EXPECT_EQ(scene.materials[0].lobes, LOBE_DIELECTRIC);
    const Material& mapped = scene.materials[1];
    EXPECT_EQ(scene.texture_names[mapped.map_normal], "relief.png");
    EXPECT_EQ(scene.texture_names[mapped.map_specular], "level.png");
    EXPECT_EQ(scene.textures.size(), 6u);
    EXPECT_EQ(count_notices(scene.notices, "a.mtl: written by Blender 5.0.1"), 1);
    EXPECT_EQ(count_notices(scene.notices, "Blender's Ks is a specular level: F0 from it and Ni; illum 6 and "
                                           "9 mean d (and 2 more)"),
              1)
        << "one line a repair";
    EXPECT_TRUE(scene.materials[2].lobes & LOBE_COAT);
    ASSERT_EQ(scene.extensions.size(), scene.materials.size()) << "one for each material";
    EXPECT_EQ(scene.extensions[2].coat, 1);
    EXPECT_EQ(scene.extensions[0].coat, 0);

    options.scene.mtl = MtlReading::PLAIN;
    const Scene plain = load(options);
    EXPECT_EQ(plain.materials[0].lobes, LOBE_MATTE | LOBE_MIRROR);
    EXPECT_EQ(plain.materials[1].map_normal, NO_INDEX);
    EXPECT_EQ(plain.texture_names[plain.materials[1].map_bump], "relief.png");
    EXPECT_EQ(count_notices(plain.notices, "Blender"), 0);
}

TEST(LoadScene, ABumpMapOfUnitVectorsIsANormalMapAndAMissingOneIsSaidOnce) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\nKd 0.5\nbump -bm 2 n.png\nnewmtl none\nbump none.png\nKd 0 0 0\nmap_Kd "
                          "none.png\n");
    folder.write_image("n.png", 1, 1, 3, std::vector<std::uint8_t>{128, 128, 255}, OIIO::TypeDesc::UINT8);
    const Scene scene =
        load(folder.write("a.obj", quad("mtllib a.mtl\n", "usemtl m\n") + "usemtl none\nf 1 2 3\n"));
    EXPECT_EQ(scene.materials[0].map_bump, NO_INDEX);
    EXPECT_EQ(scene.texture_names[scene.materials[0].map_normal], "n.png");
    EXPECT_EQ(scene.materials[0].bump_scale, 2);
    EXPECT_EQ(count_notices(scene.notices, "a.mtl:3: map_Bump is a normal map"), 1);
    EXPECT_EQ(count_notices(scene.notices, "no file 'none.png' found"), 1);
    EXPECT_EQ(count_notices(scene.notices, "more)"), 0);
}

TEST(LoadScene, DegenerateTrianglesNeverShine) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl lamp\nKe 1 1 1\n");
    const Scene scene =
        load(folder.write("a.obj", std::string("mtllib a.mtl\nusemtl lamp\n") + QUAD + "f 1 2 2\nf 1 2 3\n"));
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.statistics.degenerate_triangles, 1u);
    ASSERT_EQ(scene.emitters.size(), 1u);
    EXPECT_EQ(scene.emitters[0].triangle, 1u);
    EXPECT_EQ(scene.triangles[0].emitter, NO_INDEX);
}

TEST(LoadScene, ScalingTheFileByAPowerOfTwoGivesTheSameScene) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl lamp\nKe 1 2 3\n");
    const Scene one = load(folder.write(
        "a.obj", "mtllib a.mtl\nusemtl lamp\nv 0.1 0.2 0.3\nv 1.7 0.4 0.9\nv 0.3 2.1 0.7\nf 1 2 3\n"));
    const Scene big = load(folder.write(
        "b.obj", "mtllib a.mtl\nusemtl lamp\nv 0.4 0.8 1.2\nv 6.8 1.6 3.6\nv 1.2 8.4 2.8\nf 1 2 3\n"));
    EXPECT_EQ(0, std::memcmp(one.positions.data(), big.positions.data(), 3 * sizeof(vec4)));
    EXPECT_EQ(0, std::memcmp(one.emitters.data(), big.emitters.data(), sizeof(Emitter)));
    EXPECT_EQ(one.emitted_power, big.emitted_power);
    EXPECT_EQ(one.camera.eye * 4., big.camera.eye);
}

TEST(LoadScene, ErrorsNameFileAndLine) {
    const TemporaryFolder folder;
    folder.write("a.mtl", "newmtl m\nKd red\n");
    try {
        load(folder.write("a.obj", quad("mtllib a.mtl\n", "usemtl m\n")));
        FAIL() << "expected an error";
    } catch (const SceneError& error) {
        EXPECT_EQ(std::string(error.what()),
                  folder.path("a.mtl") + ":2: Kd: expected a finite number, found 'red'");
    }
    EXPECT_THROW(load(folder.path("none.obj")), SceneError);
}
