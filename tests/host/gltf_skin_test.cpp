// SPDX-License-Identifier: Apache-2.0
// Meshes under skins of glTF files: vertices are where their joints are.
#include "scene/readers/gltf_skins.h"

#include "gltf_support.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <string>

namespace clrt {

namespace {

void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 1e-6) << c;
}

std::vector<float> moved_by(float x, float y, float z) {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

/// A triangle on node 0, which is moved, under a skin of nodes 1 and 2: its first corner follows the first,
/// the second the other, the third both by halves.
struct SkinnedFile : GltfBuilder {
    SkinnedFile() {
        Json& attributes = add_mesh(TRIANGLE_POSITIONS)["attributes"];
        attributes["NORMAL"] = add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
        attributes["JOINTS_0"] = add<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", 4);
        attributes["WEIGHTS_0"] = add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", 4);
        std::vector<float> bound = moved_by(0, 0, 0), second = moved_by(0, 0, -1);
        bound.insert(bound.end(), second.begin(), second.end());
        json["skins"] = Json::parse(R"([{"joints": [1, 2]}])");
        json["skins"][0]["inverseBindMatrices"] = add(bound, "MAT4", 16);
        json["nodes"] = Json::parse(R"([{"mesh": 0, "skin": 0, "translation": [50, 0, 0]}, {"children": [2]},
                                        {"translation": [0, 0, 1]}])");
        json["scenes"][0]["nodes"] = {0, 1};
    }
    Json& attributes() { return json["meshes"][0]["primitives"][0]["attributes"]; }

    glm::dvec3 corner(int c) { return ReadGltf(glb()).corner(0, c); }
};

void expect_fault(SkinnedFile file, const std::string& text) {
    const std::string found = gltf_error(file.glb());
    EXPECT_NE(found.find(text), std::string::npos) << found;
}

} // namespace

TEST(GltfSkin, VerticesFollowTheirJointsAndNotTheirNode) {
    SkinnedFile file;
    for (int c = 0; c < 3; ++c)
        expect_near(file.corner(c), {c == 1, c == 2, 0}); // as it was bound
    file.json["nodes"][2]["translation"] = {0, 3, 1};
    expect_near(file.corner(0), {0, 0, 0});
    expect_near(file.corner(1), {1, 3, 0});
    expect_near(file.corner(2), {0, 2.5, 0});
    file.json["nodes"][1]["translation"] = {7, 0, 0};
    expect_near(file.corner(2), {7, 2.5, 0});
}

TEST(GltfSkin, InstancesOfASkinnedMeshAreSaidAndLeftOut) {
    SkinnedFile file;
    EXPECT_FALSE(ReadGltf(file.glb()).notes("EXT_mesh_gpu_instancing"));
    Json& places = file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    places["TRANSLATION"] = file.add<float>({1, 0, 0, 2, 0, 0}, "VEC3", 3);
    const ReadGltf read(file.glb());
    EXPECT_EQ(read.mesh().triangles.size(), 1u);
    EXPECT_TRUE(read.notes("EXT_mesh_gpu_instancing is ignored where a skin places the mesh"));
}

TEST(GltfSkin, NormalsTurnWithTheJoints) {
    SkinnedFile file; // a quarter turn about x, around the place where it was bound: +z becomes -y
    file.json["nodes"][2]["rotation"] = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};
    const ReadGltf read(file.glb());
    const MeshTriangle& triangle = read.mesh().triangles.at(0);
    expect_near(glm::dvec3(read.mesh().normals.at(triangle.n[0])), {0, 0, 1});
    expect_near(glm::dvec3(read.mesh().normals.at(triangle.n[1])), {0, -1, 0});
    expect_near(file.corner(1), {1, 1, 1});
}

TEST(GltfSkin, AnimatedJointsMoveVertices) {
    SkinnedFile file;
    file.json["animations"] = Json::parse(
        R"([{"channels": [{"sampler": 0, "target": {"node": 2, "path": "translation"}}], "samplers": [{}]}])");
    Json& sampler = file.json["animations"][0]["samplers"][0];
    sampler["input"] = file.add<float>({0, 1}, "SCALAR", 1);
    sampler["output"] = file.add<float>({0, 0, 1, 0, 8, 1}, "VEC3", 3);
    GltfReading reading;
    reading.time = 0.5;
    const ReadGltf read(file.glb(), reading);
    expect_near(read.corner(0, 1), {1, 4, 0});
    expect_near(read.corner(0, 2), {0, 3, 0});
}

TEST(GltfSkin, WeightsCountByTheirSum) {
    SkinnedFile file;
    file.json["nodes"][2]["translation"] = {0, 4, 1};
    file.attributes()["WEIGHTS_0"] =
        file.add<std::uint8_t>({0, 0, 0, 0, 85, 0, 0, 0, 51, 153, 0, 0}, "VEC4", 4, true);
    expect_near(file.corner(0), {0, 0, 0}); // none: the first joint has all
    expect_near(file.corner(1), {1, 4, 0});
    expect_near(file.corner(2), {0, 4, 0}); // three quarters
    file.attributes()["JOINTS_1"] = file.add<std::uint8_t>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    file.attributes()["WEIGHTS_1"] = file.add<float>({1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4", 4);
    expect_near(file.corner(0), {0, 4, 0});
}

TEST(GltfSkin, WhatHasNoJointsStaysAtItsNode) {
    SkinnedFile file;
    file.attributes().erase("JOINTS_0");
    const ReadGltf read(file.glb());
    expect_near(read.corner(0, 1), {51, 0, 0});
    EXPECT_TRUE(read.notes("a mesh without joints under a skin stays where its node is"));
    SkinnedFile plain; // bound in the world
    plain.json["skins"][0].erase("inverseBindMatrices");
    expect_near(plain.corner(1), {1, 0, 1});
}

TEST(GltfSkin, MirroredJointsTurnTheWinding) {
    SkinnedFile file;
    file.json["nodes"][1]["scale"] = {-1, 1, 1};
    const ReadGltf read(file.glb());
    const glm::dvec3 a = read.corner(0, 0), across = glm::cross(read.corner(0, 1) - a, read.corner(0, 2) - a);
    EXPECT_GT(across.z, 0) << "as the normals";
    expect_near(glm::dvec3(read.mesh().normals.at(0)), {0, 0, 1});
}

TEST(GltfSkin, JointsWithoutWeightDoNotCount) {
    SkinnedFile file;
    file.attributes()["JOINTS_0"] = file.add<std::uint8_t>({0, 9, 0, 0, 1, 9, 9, 9, 0, 1, 200, 0}, "VEC4", 4);
    expect_near(file.corner(2), {0, 1, 0});
}

TEST(GltfSkin, FaultsNameTheirPlace) {
    SkinnedFile file;
    file.json["skins"][0]["joints"] = {1};
    expect_fault(file, "skins[0].joints: expected joint 1, which a vertex follows, found 1 joints");
    file.json["skins"][0]["joints"] = {1, 2, 0};
    expect_fault(file, "skins[0].inverseBindMatrices: expected at least 3 matrices, one a joint, found 2");
    file = SkinnedFile();
    file.json["nodes"].push_back(Json::object());
    file.json["skins"][0]["joints"] = {1, 3};
    expect_fault(file, "skins[0].joints[1]: expected a node of the scene that is shown");
    file = SkinnedFile();
    file.attributes()["WEIGHTS_0"] = file.add<float>({1, 0, 0, 0}, "VEC4", 4);
    expect_fault(file, "attributes.WEIGHTS_0: expected 3 elements as in POSITION, found 1");
    file = SkinnedFile();
    file.json["nodes"][0]["skin"] = 1;
    expect_fault(file, "nodes[0].skin: expected");
}

} // namespace clrt
