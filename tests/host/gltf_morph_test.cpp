// SPDX-License-Identifier: Apache-2.0
// Morph targets of glTF files: what their weights add to a mesh, and where the weights come from.
#include "scene/readers/gltf_morph.h"

#include "gltf_support.h"

#include <gtest/gtest.h>
#include <string>

namespace clrt {

namespace {

void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 1e-6) << c;
}

/// A triangle with two targets: one lifts its third corner by 4, the other bends all normals and moves
/// nothing.
struct MorphedFile : GltfBuilder {
    MorphedFile() {
        Json& primitive = add_mesh(TRIANGLE_POSITIONS);
        primitive["attributes"]["NORMAL"] = add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", 3);
        primitive["targets"] = Json::array();
        primitive["targets"].push_back({{"POSITION", add<float>({0, 0, 0, 0, 0, 0, 0, 0, 4}, "VEC3", 3)}});
        primitive["targets"].push_back({{"NORMAL", add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3", 3)}});
    }
    Json& node() { return json["nodes"][0]; }
    Json& mesh() { return json["meshes"][0]; }
    ReadGltf read(std::optional<double> time = {}) {
        GltfReading reading;
        reading.time = time;
        return ReadGltf(glb(), reading);
    }
};

} // namespace

TEST(GltfMorph, WeightsAreThoseOfMeshNodeOrAnimation) {
    MorphedFile file;
    expect_near(file.read().corner(0, 2), {0, 1, 0});
    file.mesh()["weights"] = {0.5, 0};
    expect_near(file.read().corner(0, 2), {0, 1, 2});
    expect_near(file.read().corner(0, 1), {1, 0, 0});
    file.node()["weights"] = {-1, 0};
    expect_near(file.read().corner(0, 2), {0, 1, -4});
    file.json["animations"] = Json::parse(
        R"([{"channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}], "samplers": [{}]}])");
    Json& sampler = file.json["animations"][0]["samplers"][0];
    sampler["input"] = file.add<float>({0, 2}, "SCALAR", 1);
    sampler["output"] = file.add<float>({0, 0, 1, 0}, "SCALAR", 1);
    expect_near(file.read().corner(0, 2), {0, 1, -4});
    expect_near(file.read(0.5).corner(0, 2), {0, 1, 1});
    sampler["interpolation"] = "CUBICSPLINE"; // of two weights: tangents 2 and 0, value, tangents
    sampler["output"] = file.add<float>({0, 0, 1, 0, 0, 0, 0, 0, 3, 0, 0, 0}, "SCALAR", 1);
    expect_near(file.read(1).corner(0, 2), {0, 1, 8});
    sampler["output"] = file.add<float>({0, 0, 1}, "SCALAR", 1);
    GltfReading moment;
    moment.time = 0;
    try {
        ReadGltf(file.glb(), moment);
        ADD_FAILURE();
    } catch (const SceneError& fault) {
        EXPECT_NE(
            std::string(fault.what()).find("output: expected a multiple of 6 values for 2 times, found 3"),
            std::string::npos)
            << fault.what();
    }
}

TEST(GltfMorph, NormalsAreBentToo) {
    MorphedFile file;
    file.node()["weights"] = {0, 1};
    const ReadGltf read(file.glb());
    const MeshTriangle& triangle = read.mesh().triangles.at(0);
    const glm::dvec3 normal(read.mesh().normals.at(triangle.n[0]));
    expect_near(normal / normal.z, {1, 0, 1});
    expect_near(read.corner(0, 2), {0, 1, 0});
}

TEST(GltfMorph, MeshesOfOneShapeMayDiffer) {
    MorphedFile file;
    file.json["nodes"].push_back({{"mesh", 0}, {"weights", {1, 0}}});
    file.json["scenes"][0]["nodes"] = {0, 1};
    const ReadGltf read(file.glb());
    expect_near(read.corner(0, 2), {0, 1, 0});
    expect_near(read.corner(1, 2), {0, 1, 4});
}

TEST(GltfMorph, FaultsNameTheirPlace) {
    MorphedFile file;
    file.node()["weights"] = {1};
    EXPECT_NE(gltf_error(file.glb())
                  .find("nodes[0]: expected as many weights as the mesh has morph targets, 2, found 1"),
              std::string::npos)
        << gltf_error(file.glb());
    MorphedFile other;
    other.mesh()["primitives"][0]["targets"][0]["POSITION"] = other.add<float>({0, 0, 0}, "VEC3", 3);
    EXPECT_NE(
        gltf_error(other.glb()).find("targets[0].POSITION: expected 3 elements as in POSITION, found 1"),
        std::string::npos)
        << gltf_error(other.glb());
}

} // namespace clrt
