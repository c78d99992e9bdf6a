// SPDX-License-Identifier: Apache-2.0
// Materials and textures of glTF files.
#include "gltf_support.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A file with a textured triangle whose material is this text.
GltfBuilder with_material(const std::string& material) {
    GltfBuilder file;
    file.add_mesh(TRIANGLE_POSITIONS)["material"] = 0;
    Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = file.add<float>({0, 0, 1, 0, 0, 1}, "VEC2", 2);
    attributes["TEXCOORD_1"] = file.add<std::uint8_t>({0, 255, 0, 0, 51, 0}, "VEC2", 2, true);
    file.json["materials"] = Json::array();
    file.json["materials"].push_back(Json::parse(material));
    file.json["textures"] = Json::parse(R"([{"source": 0}, {"source": 1, "sampler": 0}, {}])");
    file.json["samplers"] = Json::parse(R"([{"wrapS": 33071, "wrapT": 33648}])");
    file.json["images"] = Json::parse(R"([{"uri": "a%20b.png"}, {"uri": "data:image/png;base64,iVBORw=="}])");
    return file;
}

MaterialDescription described(const std::string& material, GltfReading reading = {}) {
    return ReadGltf(with_material(material).glb(), reading).scene.materials.at(0);
}

std::string error_of(const std::string& material) {
    return gltf_error(with_material(material).glb());
}

} // namespace

TEST(GltfMaterials, FactorsHaveTheStandardsDefaults) {
    const MaterialDescription plain = described("{}");
    EXPECT_EQ(plain.reflection, Reflection::METALLIC);
    EXPECT_EQ(plain.base.value, glm::dvec3(1));
    EXPECT_EQ(plain.metallic.value, 1);
    EXPECT_EQ(plain.roughness.value, 1);
    EXPECT_EQ(plain.coverage.value, 1);
    EXPECT_EQ(plain.emission.value, glm::dvec3(0));
    EXPECT_NEAR(plain.dielectric_f0.value, 0.04, 1e-15);
    const MaterialDescription given = described(
        R"({"name": "n", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 7, 0.5], "metallicFactor": 0.25,
            "roughnessFactor": 0.75}, "emissiveFactor": [1, 0.5, 0], "doubleSided": true,
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 10},
                           "KHR_materials_ior": {"ior": 2}, "KHR_materials_specular": {"specularFactor": 0.5}}})");
    EXPECT_EQ(given.name, "n");
    EXPECT_EQ(given.base.value, glm::dvec3(0.1, 0.2, 1)) << "in range";
    EXPECT_EQ(given.metallic.value, 0.25);
    EXPECT_EQ(given.roughness.value, 0.75);
    EXPECT_EQ(given.emission.value, glm::dvec3(10, 5, 0));
    EXPECT_TRUE(given.emits_both_sides);
    EXPECT_EQ(given.coverage.value, 1) << "OPAQUE ignores alpha";
    EXPECT_NEAR(given.dielectric_f0.value, 0.5 / 9, 1e-15);
    EXPECT_EQ(given.ior, 2);
}

TEST(GltfMaterials, TexturesHaveTheirChannelsWrapsAndTransforms) {
    const MaterialDescription m = described(
        R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
            "normalTexture": {"index": 1, "scale": 0.5}})");
    EXPECT_EQ(m.base.map->file, "a b.png");
    EXPECT_EQ(m.base.map->wrap_u, TextureWrap::REPEAT);
    EXPECT_EQ(m.metallic.map->channel, 2u);
    EXPECT_EQ(m.roughness.map->channel, 1u);
    EXPECT_EQ(m.metallic.map->wrap_u, TextureWrap::EDGE);
    EXPECT_EQ(m.metallic.map->wrap_v, TextureWrap::MIRROR);
    EXPECT_EQ(*m.metallic.map->bytes, "\x89PNG");
    EXPECT_EQ(m.normal_strength, 0.5);
    EXPECT_FALSE(
        ReadGltf(with_material(R"({"emissiveTexture": {"index": 2}})").glb()).scene.materials[0].emission.map)
        << "without a source";
    EXPECT_NE(
        error_of(R"({"emissiveTexture": {"index": 3}})")
            .find(
                "materials[0].emissiveTexture.index: expected an index into textures, which has 3 elements"),
        std::string::npos);
}

TEST(GltfMaterials, TransformsTurnAboutTheUpperLeft) {
    const double angle = 0.3;
    const TextureUse use = *described(
                                R"({"emissiveTexture": {"index": 0, "extensions": {"KHR_texture_transform":
                                    {"offset": [0.1, 0.2], "scale": [2, 3], "rotation": 0.3}}}})")
                                .emission.map;
    for (const glm::dvec2& uv : {glm::dvec2(0, 0), glm::dvec2(1, 0), glm::dvec2(0.25, 0.75)}) {
        // In the file's coordinates, v down, a turn that looks counter-clockwise.
        const glm::dvec2 scaled = uv * glm::dvec2(2, 3);
        const glm::dvec2 expected(std::cos(angle) * scaled.x + std::sin(angle) * scaled.y + 0.1,
                                  -std::sin(angle) * scaled.x + std::cos(angle) * scaled.y + 0.2);
        const double s = uv.x, t = 1 - uv.y;
        EXPECT_NEAR(use.scale.x * s + use.shear.x * t + use.offset.x, expected.x, 1e-14);
        EXPECT_NEAR(1 - (use.shear.y * s + use.scale.y * t + use.offset.y), expected.y, 1e-14);
    }
}

TEST(GltfMaterials, TheSetOfCoordinatesIsThatOfTheTextures) {
    const auto uv = [](const std::string& material) {
        return ReadGltf(with_material(material).glb()).mesh().uvs.at(2);
    };
    EXPECT_EQ(uv(R"({"emissiveTexture": {"index": 0}})"), glm::vec2(0, 0)) << "v from below";
    EXPECT_EQ(uv(R"({"emissiveTexture": {"index": 0, "texCoord": 1}})"), glm::vec2(0.2f, 1));
    EXPECT_EQ(
        uv(R"({"emissiveTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"texCoord": 1}}}})"),
        glm::vec2(0.2f, 1));
    EXPECT_TRUE(ReadGltf(with_material(R"({"emissiveTexture": {"index": 0, "texCoord": 2}})").glb())
                    .notes("textures without TEXCOORD_2"));
}

TEST(GltfMaterials, TheTexturesOfAMaterialReadTwoSetsOfCoordinates) {
    const ReadGltf both(
        with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1},
                                              "metallicRoughnessTexture": {"index": 0}},
                                          "normalTexture": {"index": 0}})")
            .glb());
    const MaterialDescription& m = both.scene.materials.at(0);
    EXPECT_EQ(both.mesh().uvs.at(2), glm::vec2(0, 0)) << "those of the normal map, with its directions";
    EXPECT_EQ(both.mesh().second_uvs.at(2), glm::vec2(0.2f, 1));
    EXPECT_TRUE(m.base.map->by_second_uvs);
    EXPECT_FALSE(m.normal_map->by_second_uvs || m.roughness.map->by_second_uvs ||
                 m.metallic.map->by_second_uvs);
    EXPECT_FALSE(both.notes("sets of coordinates"));
    EXPECT_TRUE(
        ReadGltf(with_material(R"({"emissiveTexture": {"index": 0}})").glb()).mesh().second_uvs.empty());

    const ReadGltf three(with_material(R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                                               "metallicRoughnessTexture": {"index": 0, "texCoord": 1}},
                                           "emissiveTexture": {"index": 0, "texCoord": 2}})")
                             .glb());
    EXPECT_TRUE(three.notes("by two sets of coordinates"));
    EXPECT_FALSE(three.scene.materials[0].emission.map->by_second_uvs);
    EXPECT_TRUE(three.scene.materials[0].roughness.map->by_second_uvs);
}

TEST(GltfMaterials, SetsOfCoordinatesThatAMeshLacksAreZero) {
    const auto with_sets = [](int base, int emission) {
        return with_material(fmt::format(
            R"({{"pbrMetallicRoughness": {{"baseColorTexture": {{"index": 0, "texCoord": {}}}}},
                 "emissiveTexture": {{"index": 0, "texCoord": {}}}}})",
            base, emission));
    };
    const ReadGltf no_first(with_sets(2, 1).glb());
    EXPECT_TRUE(no_first.notes("textures without TEXCOORD_2"));
    EXPECT_EQ(no_first.mesh().uvs, std::vector<glm::vec2>(3, glm::vec2(0)));
    EXPECT_EQ(no_first.mesh().second_uvs.at(2), glm::vec2(0.2f, 1));
    const ReadGltf no_second(with_sets(1, 2).glb());
    EXPECT_EQ(no_second.mesh().uvs.at(2), glm::vec2(0.2f, 1));
    EXPECT_TRUE(no_second.mesh().second_uvs.empty());

    // Between meshes of one set: the second lie beside the first.
    GltfBuilder file = with_sets(0, 1);
    Json mesh = file.json["meshes"][0];
    for (const char* name : {"TEXCOORD_1", "TEXCOORD_0"}) {
        mesh["primitives"][0]["attributes"].erase(name);
        file.json["meshes"].push_back(mesh);
        file.json["nodes"].push_back({{"mesh", file.json["meshes"].size() - 1}});
        file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size() - 1);
    }
    file.json["meshes"].push_back(file.json["meshes"][0]);
    file.json["nodes"].push_back({{"mesh", file.json["meshes"].size() - 1}});
    file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size() - 1);
    const ReadGltf several(file.glb());
    const Mesh& read = several.mesh();
    ASSERT_EQ(read.triangles.size(), 4u);
    EXPECT_EQ(read.second_uvs.size(), read.uvs.size());
    const glm::vec2 expected[] = {{0.2f, 1}, {0, 0}, {}, {0.2f, 1}};
    for (const size_t i : {0u, 1u, 3u})
        EXPECT_EQ(read.second_uvs.at(read.triangles[i].t[2]), expected[i]) << i;
    EXPECT_EQ(read.triangles[2].t[2], NO_INDEX);
}

TEST(GltfMaterials, AlphaIsCoverageOrAThreshold) {
    const auto with_mode = [](const std::string& mode, const std::string& more = "") {
        return described(R"({"alphaMode": ")" + mode + "\"" + more +
                         R"(, "pbrMetallicRoughness": {"baseColorTexture": {"index": 0},
                              "baseColorFactor": [1, 1, 1, 0.5]}})")
            .coverage;
    };
    EXPECT_FALSE(with_mode("OPAQUE").map);
    const Mapped<double> blend = with_mode("BLEND"), mask = with_mode("MASK", R"(, "alphaCutoff": 0.25)");
    EXPECT_EQ(blend.value, 0.5);
    EXPECT_EQ(blend.map->channel, 3u);
    EXPECT_EQ(mask.value, 1);
    // The step is where factor times alpha is the threshold: it counts as inside.
    EXPECT_GE(mask.map->base + mask.map->gain * 0.5, 1);
    EXPECT_LE(mask.map->base + mask.map->gain * 127 / 255, 0);
    const auto flat = [](double alpha) {
        return described(R"({"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, )" +
                         std::to_string(alpha) + "]}}")
            .coverage.value;
    };
    EXPECT_EQ(flat(0.5), 1);
    EXPECT_EQ(flat(0.49), 0);
    EXPECT_NE(error_of(R"({"alphaMode": "GLASS"})")
                  .find("materials[0].alphaMode: expected OPAQUE, MASK or BLEND, found 'GLASS'"),
              std::string::npos);
}

TEST(GltfMaterials, TransmissionIsAThinWallUnlessItHasAVolume) {
    const std::string glass = R"("KHR_materials_transmission": {"transmissionFactor": 0.75,
                                  "transmissionTexture": {"index": 0}})";
    const MaterialDescription thin = described("{\"extensions\": {" + glass + "}}");
    EXPECT_EQ(thin.transmission_weight.value, 0.75);
    EXPECT_EQ(thin.transmission_weight.map->channel, 0u);
    EXPECT_TRUE(thin.is_thin);
    EXPECT_FALSE(described("{\"extensions\": {" + glass + "}}", {GltfLights::BLENDER, true}).is_thin);
    const MaterialDescription solid =
        described("{\"extensions\": {" + glass + R"(, "KHR_materials_volume": {"thicknessFactor": 1,
                   "attenuationDistance": 2, "attenuationColor": [0.5, 1, 0]}}})");
    EXPECT_FALSE(solid.is_thin);
    EXPECT_EQ(solid.attenuation_distance, 2);
    EXPECT_EQ(solid.attenuation_colour, glm::dvec3(0.5, 1, 0));
    EXPECT_EQ(solid.abbe, 0);
    EXPECT_TRUE(described("{\"extensions\": {" + glass + ", \"KHR_materials_volume\": {}}}").is_thin);
    EXPECT_EQ(described("{\"extensions\": {" + glass + R"(, "KHR_materials_volume": {"thicknessFactor": 1},
                        "KHR_materials_dispersion": {"dispersion": 0.5}}})")
                  .abbe,
              40);
}

TEST(GltfMaterials, ReflectanceHeadOnIsColouredAndNotAboveOne) {
    const MaterialDescription m = described(
        R"({"extensions": {"KHR_materials_ior": {"ior": 3}, "KHR_materials_specular": {"specularFactor": 0.5,
            "specularColorFactor": [8, 1, 0]}}})");
    EXPECT_NEAR(m.dielectric_f0.value, 0.5, 1e-15) << "min(0.25 * 8, 1) * 0.5";
    EXPECT_NEAR(m.specular_tint.y, 0.25, 1e-15);
    EXPECT_EQ(m.specular_tint.z, 0);
}

TEST(GltfMaterials, SpecularTexturesAreColoursAndAlphas) {
    const auto with_textures = [](const std::string& textures) {
        return ReadGltf(
            with_material(R"({"extensions": {"KHR_materials_specular": {)" + textures + "}}}").glb());
    };
    const std::string colour = R"("specularColorTexture": {"index": 0})",
                      weight = R"("specularTexture": {"index": 0})";
    const struct {
        std::string textures;
        TextureAlpha alpha;
    } cases[] = {{colour, TextureAlpha::IGNORED},
                 {weight, TextureAlpha::ALONE},
                 {colour + ", " + weight, TextureAlpha::MULTIPLIES}};
    for (const auto& [textures, alpha] : cases) {
        const ReadGltf read = with_textures(textures);
        const MaterialDescription& m = read.scene.materials.at(0);
        EXPECT_EQ(m.dielectric_f0.map->file, "a b.png") << textures;
        EXPECT_EQ(m.dielectric_f0.map->alpha, alpha) << textures;
        EXPECT_EQ(m.dielectric_f0_role, TextureRole::COLOUR);
        EXPECT_FALSE(read.notes("specularTexture is ignored"));
    }
    for (const char* other :
         {R"("specularTexture": {"index": 1})", R"("specularTexture": {"index": 0, "texCoord": 1})"}) {
        const ReadGltf read = with_textures(colour + ", " + other);
        EXPECT_TRUE(read.notes("specularTexture is ignored")) << other;
        EXPECT_EQ(read.scene.materials[0].dielectric_f0.map->alpha, TextureAlpha::IGNORED);
    }
}

TEST(GltfMaterials, GlossinessInAnAlphaIsRoughness) {
    const auto with_texture = [](const std::string& index) {
        return described(
            R"({"extensions": {"KHR_materials_pbrSpecularGlossiness": {"specularFactor": [0.5, 0.25, 1],
                "glossinessFactor": 0.75, "specularGlossinessTexture": {"index": )" +
            index + "}}}}");
    };
    const MaterialDescription m = with_texture("0");
    EXPECT_EQ(m.reflection, Reflection::SCHLICK);
    EXPECT_EQ(m.specular.value, glm::dvec3(0.5, 0.25, 1));
    ASSERT_TRUE(m.roughness.map);
    EXPECT_EQ(m.roughness.map->channel, 3u);
    EXPECT_EQ(m.roughness.value, 1);
    EXPECT_EQ(m.roughness.map->base + m.roughness.map->gain * 0.4, 1 - 0.75 * 0.4);
    EXPECT_EQ(m.roughness.without_map, 0.25);
    const MaterialDescription opaque = with_texture("1");
    EXPECT_FALSE(opaque.roughness.map);
    EXPECT_EQ(opaque.roughness.value, 0.25);
}

TEST(GltfMaterials, CoatsAndSheensHaveTheirChannels) {
    const MaterialDescription m = described(
        R"({"extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.25,
              "clearcoatTexture": {"index": 0}, "clearcoatRoughnessTexture": {"index": 0}},
            "KHR_materials_sheen": {"sheenColorFactor": [0.1, 0.2, 0.3], "sheenRoughnessFactor": 0.75,
              "sheenColorTexture": {"index": 0}, "sheenRoughnessTexture": {"index": 0}}}})");
    EXPECT_EQ(m.coat_weight.value, 0.5);
    EXPECT_EQ(m.coat_weight.map->channel, 0u);
    EXPECT_EQ(m.coat_roughness.value, 0.25);
    EXPECT_EQ(m.coat_roughness.map->channel, 1u);
    EXPECT_EQ(m.sheen.value, glm::dvec3(0.1, 0.2, 0.3));
    EXPECT_FALSE(m.sheen.map->channel);
    EXPECT_EQ(m.sheen_roughness.value, 0.75);
    EXPECT_EQ(m.sheen_roughness.map->channel, 3u);
}

TEST(GltfMaterials, AnisotropyKeepsBothRoughnessesOfTheStandard) {
    const MaterialDescription m = described(
        R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5},
            "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1.5}}})");
    const double aspect = std::sqrt(1 - 0.9 * m.anisotropy), mean = m.roughness.value * m.roughness.value;
    EXPECT_NEAR(mean / aspect, 0.25 + 0.75 * 0.25, 1e-14) << "along: mix(a, 1, s^2)";
    EXPECT_NEAR(mean * aspect, 0.25, 1e-14) << "across";
    EXPECT_NEAR(m.anisotropy_rotation, 1.5 / 6.283185307179586, 1e-15);
}

TEST(GltfMaterials, AnAnisotropyTextureStretchesInThePlaceOfTheConstants) {
    const MaterialDescription m = described(
        R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5}, "extensions": {"KHR_materials_anisotropy":
            {"anisotropyStrength": 0.75, "anisotropyRotation": 1.5, "anisotropyTexture": {"index": 0}}}})");
    EXPECT_EQ(m.anisotropy_map->file, "a b.png");
    EXPECT_EQ(m.anisotropy_strength, 0.75);
    EXPECT_EQ(m.anisotropy, 0);
    EXPECT_EQ(m.roughness.value, 0.5);
    EXPECT_NEAR(m.anisotropy_rotation, 1.5 / 6.283185307179586, 1e-15);
    EXPECT_FALSE(
        described(R"({"extensions": {"KHR_materials_anisotropy": {"anisotropyTexture": {"index": 0}}}})")
            .anisotropy_map)
        << "of no strength";
}

TEST(GltfMaterials, UnlitShinesAndReflectsNothing) {
    const MaterialDescription m = described(R"({"extensions": {"KHR_materials_unlit": {}},
                                                "pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 0, 1]}})");
    EXPECT_EQ(m.reflection, Reflection::NONE);
    EXPECT_EQ(m.base.value, glm::dvec3(0));
    EXPECT_EQ(m.emission.value, glm::dvec3(0.5, 1, 0));
    EXPECT_TRUE(m.emits_both_sides);
}

TEST(GltfMaterials, ColoursOfVerticesMultiplyTheBase) {
    for (const bool textured : {false, true}) {
        GltfBuilder file = with_material(
            textured ? R"({"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})" : "{}");
        file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
            file.add<std::uint8_t>({255, 0, 51, 9, 0, 0, 0, 9, 0, 0, 0, 9}, "VEC4", 4, true);
        const ReadGltf read(file.glb());
        EXPECT_EQ(read.mesh().colours.at(0), glm::vec3(1, 0, 0.2f));
        EXPECT_EQ(read.scene.materials[0].base.map->by_vertex, !textured);
        EXPECT_EQ(read.scene.materials[0].base.map->times_vertex, textured);
    }
}

TEST(GltfMaterials, AMaterialIsDescribedOnceForEachUse) {
    GltfBuilder file = with_material("{}");
    Json plain = file.json["meshes"][0]["primitives"][0], bare = plain;
    plain["attributes"]["COLOR_0"] = file.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1}, "VEC3", 3);
    bare.erase("material");
    for (const Json& primitive : {plain, file.json["meshes"][0]["primitives"][0], bare})
        file.json["meshes"][0]["primitives"].push_back(primitive);
    const ReadGltf read(file.glb());
    EXPECT_EQ(read.scene.materials.size(), 3u) << "as it is, with colours, and none";
    EXPECT_EQ(read.mesh().colours.size(), read.mesh().positions.size());
    EXPECT_EQ(read.mesh().colours[0], glm::vec3(1)) << "where there are none";
}

} // namespace clrt
