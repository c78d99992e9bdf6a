// SPDX-License-Identifier: Apache-2.0
// glTF files: containers, nodes, instances, cameras, lights, and the same scene as an OBJ.
#include "scene/readers/gltf_reader.h"

#include "gltf_support.h"
#include "scene/load_scene.h"
#include "scene/readers/gltf_extensions.h"
#include "scene/readers/gltf_file.h"
#include "scene_support.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

namespace clrt {

using namespace std::string_literals;

namespace {

GltfBuilder one_triangle() {
    GltfBuilder file;
    file.add_mesh(TRIANGLE_POSITIONS);
    return file;
}

/// Corner c of the one triangle under a node of this text.
glm::dvec3 corner_under(const char* node, int c) {
    GltfBuilder file = one_triangle();
    file.json["nodes"][0] = Json::parse(node);
    return ReadGltf(file.glb()).corner(0, c);
}

void expect_near(const glm::dvec3& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 1e-12) << c;
}

} // namespace

TEST(GltfFile, ContainersAreKnownByTheirBytes) {
    EXPECT_TRUE(is_gltf("glTF\2"));
    EXPECT_TRUE(is_gltf(" {\"asset\": 1}"));
    EXPECT_TRUE(is_gltf("{" + std::string(10000, ' ') + "\"asset\": 1}")) << "keys may be sorted";
    for (const char* other : {"", "{}", "[\"asset\"]", "v 0 0 0\n# {\"asset\"", "glT"})
        EXPECT_FALSE(is_gltf(other)) << other;
}

TEST(GltfFile, CutAndStrangeContainersAreErrors) {
    const std::string whole = one_triangle().glb();
    EXPECT_EQ(gltf_error(whole), "");
    for (size_t length = 4; length < whole.size(); ++length)
        EXPECT_NE(gltf_error(whole.substr(0, length)), "") << length;
    std::string other = whole;
    other[4] = 1;
    EXPECT_EQ(gltf_error(other), "a.glb: byte 4: expected version 2 of GLB, found 1");
    EXPECT_NE(gltf_error("{\"asset\": {\"version\": \"1.0\"}}")
                  .find("asset.version: expected version 2.x, found '1.0'"),
              std::string::npos);
    EXPECT_NE(gltf_error("{\"asset\": {\"version\": 2}}").find("asset.version: expected a string, found 2"),
              std::string::npos);
    EXPECT_NE(gltf_error("{\"asset\": {}").find("byte 13 of its JSON: expected a JSON document"),
              std::string::npos);
    EXPECT_NE(gltf_error("{\"asset\": {\"version\": \"2.0\"}}").find("no triangles to render"),
              std::string::npos);
}

TEST(GltfFile, BuffersMayBeDataOrFilesInTheFolder) {
    GltfBuilder file = one_triangle();
    file.glb();
    const auto text_with = [&](const std::string& uri) {
        file.json["buffers"][0]["uri"] = uri;
        return file.json.dump();
    };
    // Zeros and ones as floats: 0, 0, 0, 1, 0, 0, 0, 1, 0.
    EXPECT_EQ(gltf_error(text_with("data:application/octet-stream;base64,"
                                   "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA")),
              "");
    EXPECT_NE(gltf_error(text_with("data:;base64,AAAA"))
                  .find("buffers[0].byteLength: expected at most the 3 bytes"),
              std::string::npos);
    EXPECT_NE(gltf_error(text_with("data:;base64,A*==")).find("buffers[0].uri: expected base64"),
              std::string::npos);
    const TemporaryFolder folder;
    folder.write("in it/a b.bin", file.bytes);
    EXPECT_EQ(gltf_error(text_with("in%20it/a%20b.bin"), folder.path("a.gltf")), "");
    EXPECT_NE(
        gltf_error(text_with("missing.bin"), folder.path("a.gltf")).find("expected a file that can be read"),
        std::string::npos);
    const std::string inside = folder.path("in it/a b.bin");
    for (const std::string& uri : {inside, "../x/a.bin"s, "in it/../../a.bin"s, "file:///etc/passwd"s,
                                   "http://a.b/c"s, "C:\\a.bin"s, "..\\a.bin"s, "%2e%2e/a.bin"s, ""s})
        EXPECT_NE(gltf_error(text_with(uri), folder.path("a.gltf"))
                      .find("buffers[0].uri: expected a file in the folder of this one"),
                  std::string::npos)
            << uri;
}

TEST(GltfNodes, TransformsAreMatricesOrPartsFromTheRoot) {
    EXPECT_EQ(corner_under(R"({"mesh": 0})", 1), glm::dvec3(1, 0, 0));
    EXPECT_EQ(corner_under(R"({"mesh": 0, "matrix": [2,0,0,0, 0,3,0,0, 0,0,4,0, 5,6,7,1]})", 2),
              glm::dvec3(5, 9, 7));
    // Scaled, then a quarter turn about z, then moved.
    expect_near(corner_under(R"({"mesh": 0, "scale": [2,3,4], "translation": [5,6,7],
                                 "rotation": [0, 0, 0.70710678118654757, 0.70710678118654757]})",
                             1),
                {5, 8, 7});
    GltfBuilder file = one_triangle();
    file.json["nodes"] =
        Json::parse(R"([{"children": [1], "scale": [2,2,2]}, {"mesh": 0, "translation": [1,0,0]}])");
    EXPECT_EQ(ReadGltf(file.glb()).corner(0, 1), glm::dvec3(4, 0, 0));
}

TEST(GltfNodes, OnlyTheScenesNodesAreShownAndNoneTwice) {
    GltfBuilder file = one_triangle();
    file.json["nodes"] = Json::parse(R"([{"mesh": 0, "name": "first"}, {"mesh": 0, "name": "second"}])");
    EXPECT_EQ(ReadGltf(file.glb()).mesh().object_names, std::vector<std::string>{"first"});
    file.json.erase("scene");
    file.json.erase("scenes");
    EXPECT_EQ(ReadGltf(file.glb()).mesh().object_names.size(), 2u) << "without scenes all are";
    file.json["nodes"] =
        Json::parse(R"([{"mesh": 0, "children": [1]}, {"children": [2]}, {"children": [1]}])");
    file.json["scenes"] = Json::parse(R"([{"nodes": [0]}])");
    EXPECT_EQ(gltf_error(file.glb()),
              "a.glb: nodes[2].children[0]: expected a node that nothing else leads to: the "
              "nodes are a forest, found node 1, reached before");
    file.json["nodes"] = Json::parse(R"([{"children": [3]}])");
    EXPECT_NE(gltf_error(file.glb()).find("nodes[0].children[0]: expected an index into nodes"),
              std::string::npos);
    file.json["nodes"] = Json::parse(R"([{"mesh": 0, "scale": [1, 2]}])");
    EXPECT_NE(gltf_error(file.glb()).find("nodes[0].scale: expected 3 numbers, found an array of 2"),
              std::string::npos);
}

TEST(GltfNodes, MirrorsReverseTheWindingAndNormalsFollow) {
    GltfBuilder file = one_triangle();
    file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        file.add<float>({0, 1, 1, 0, 1, 1, 0, 1, 1}, "VEC3", 3);
    file.json["nodes"][0]["scale"] = {-1, 2, 1};
    const ReadGltf read(file.glb());
    const glm::dvec3 e1 = read.corner(0, 1) - read.corner(0, 0), e2 = read.corner(0, 2) - read.corner(0, 0);
    EXPECT_GT(e1.x * e2.y - e1.y * e2.x, 0) << "seen from +z as before";
    const glm::vec3 n = read.mesh().normals.at(0);
    EXPECT_EQ(n.x, 0);
    EXPECT_FLOAT_EQ(n.y / n.z, 0.5f) << "stretched along y it leans towards z";
    EXPECT_GT(n.z, 0);
}

TEST(GltfNodes, InstancesAreCopiesAndCounted) {
    GltfBuilder file = one_triangle();
    file.json["extensionsRequired"] = Json::array({"EXT_mesh_gpu_instancing"});
    Json& places = file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    places["TRANSLATION"] = file.add<float>({1, 0, 0, 2, 0, 0, 3, 0, 0}, "VEC3", 3);
    places["SCALE"] = file.add<float>({1, 1, 1, 2, 2, 2, 3, 3, 3}, "VEC3", 3);
    const ReadGltf read(file.glb());
    ASSERT_EQ(read.mesh().triangles.size(), 3u);
    EXPECT_EQ(read.corner(1, 1), glm::dvec3(4, 0, 0));
    EXPECT_EQ(read.corner(2, 2), glm::dvec3(3, 3, 0));
    EXPECT_TRUE(read.notes("3 instances of 1 meshes, a copy for each: 3 triangles"));
    places["SCALE"] = file.add<float>({1, 1, 1}, "VEC3", 3);
    EXPECT_NE(gltf_error(file.glb()).find("expected 3 elements each, found 1"), std::string::npos);
}

TEST(GltfPrimitives, StripsAndFansKeepTheirWinding) {
    const auto corners = [](size_t mode) {
        GltfBuilder file;
        Json& primitive = file.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
        primitive["mode"] = mode;
        if (mode == 4)
            file.json["meshes"][0]["primitives"][0]["indices"] =
                file.add<std::uint8_t>({0, 1, 2, 2, 1, 3}, "SCALAR", 1);
        std::vector<u32> all;
        const ReadGltf read(file.glb());
        for (const MeshTriangle& triangle : read.mesh().triangles)
            all.insert(all.end(), triangle.v, triangle.v + 3);
        return all;
    };
    EXPECT_EQ(corners(4), (std::vector<u32>{0, 1, 2, 2, 1, 3}));
    EXPECT_EQ(corners(5), (std::vector<u32>{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    EXPECT_EQ(corners(6), (std::vector<u32>{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(GltfPrimitives, WhatIsNoTriangleIsLeftOut) {
    GltfBuilder file = one_triangle();
    Json lines = file.json["meshes"][0]["primitives"][0], nothing = Json::object();
    lines["mode"] = 1;
    nothing["attributes"] = Json::object();
    file.json["meshes"][0]["primitives"].push_back(lines);
    file.json["meshes"][0]["primitives"].push_back(nothing);
    const ReadGltf read(file.glb());
    EXPECT_EQ(read.mesh().triangles.size(), 1u);
    EXPECT_TRUE(read.notes("points and lines are ignored"));
    EXPECT_TRUE(read.notes("primitives without POSITION are ignored"));
    EXPECT_TRUE(read.mesh().normals.empty()) << "no NORMAL is flat";
    EXPECT_EQ(read.mesh().triangles[0].n[0], NO_INDEX);
}

TEST(GltfExtensions, ThoseThatAreReadAreInOrderAndKnown) {
    const std::vector<std::string>& names = gltf_extensions();
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end())) << "they are looked up by bisection";
    GltfBuilder file = one_triangle();
    for (const std::string& name : names)
        file.json["extensionsRequired"].push_back(name);
    file.json["extensionsUsed"] = Json::array({"KHR_materials_clearcoat", "KHR_materials_volume"});
    EXPECT_FALSE(ReadGltf(file.glb()).notes("extensions that are ignored"));
}

TEST(GltfExtensions, RequiredOnesMustBeKnownAndUsedOnesAreOneNotice) {
    GltfBuilder file = one_triangle();
    file.json["extensionsUsed"] = Json::array({"A_b", "KHR_materials_ior", "C_d"});
    EXPECT_TRUE(ReadGltf(file.glb()).notes("extensions that are ignored: A_b, C_d"));
    file.json["extensionsRequired"] = Json::array({"KHR_texture_transform", "A_b"});
    EXPECT_NE(gltf_error(file.glb()).find("extensionsRequired[1]: expected an extension that can be read ("),
              std::string::npos);
}

TEST(GltfCameras, StandAtTheirNodes) {
    GltfBuilder file = one_triangle();
    file.json["cameras"] = Json::parse(R"([
        {"type": "perspective", "name": "eye", "perspective": {"yfov": 0.5, "aspectRatio": 1.5, "znear": 0.1}},
        {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "zfar": 9, "znear": 0}}])");
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.json["nodes"].push_back(Json::parse(R"({"camera": 0, "translation": [1,2,3], "scale": [7,7,7]})"));
    file.json["nodes"].push_back(Json::parse(R"({"camera": 1, "name": "plan", "rotation": [-1, 0, 0, 1]})"));
    const ReadGltf read(file.glb());
    ASSERT_EQ(read.scene.cameras.size(), 2u);
    const FileCamera &eye = read.scene.cameras[0], &plan = read.scene.cameras[1];
    EXPECT_EQ(eye.name, "eye");
    EXPECT_EQ(eye.camera.eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(eye.camera.at, glm::dvec3(1, 2, 2));
    EXPECT_NEAR(eye.camera.fov_degrees, 28.64788975654116, 1e-12);
    EXPECT_EQ(eye.aspect, 1.5);
    EXPECT_EQ(plan.name, "plan") << "the node's where the camera has none";
    EXPECT_EQ(plan.camera.projection, PROJECTION_ORTHOGRAPHIC);
    EXPECT_EQ(plan.camera.ortho_height, 4);
    EXPECT_EQ(plan.aspect, 1.5);
    expect_near(plan.camera.at - plan.camera.eye, {0, -1, 0});
    expect_near(plan.camera.up, {0, 0, -1});
    const Json place = file.json["nodes"][1]["translation"];
    file.json["nodes"][1]["translation"] = {0, 0, 1e20};
    EXPECT_NE(gltf_error(file.glb()).find("nodes[1]: expected a camera so near the origin that a step of 1"),
              std::string::npos)
        << gltf_error(file.glb());
    file.json["nodes"][1]["translation"] = place;
    file.json["cameras"][0]["perspective"]["yfov"] = 0;
    EXPECT_NE(gltf_error(file.glb()).find("cameras[0].perspective.yfov: expected a number above 0, found 0"),
              std::string::npos);
}

TEST(GltfCameras, OneTakesThePictureUnlessOptionsSayOtherwise) {
    GltfBuilder file = one_triangle();
    file.json["cameras"] = Json::parse(R"([
        {"type": "perspective", "name": "a", "perspective": {"yfov": 0.5, "aspectRatio": 2}},
        {"type": "perspective", "name": "b", "perspective": {"yfov": 1, "aspectRatio": 0.5}}])");
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.json["nodes"].push_back(Json::parse(R"({"camera": 0, "translation": [0.2,0.2,3]})"));
    file.json["nodes"].push_back(Json::parse(R"({"camera": 1, "translation": [0.2,0.2,4]})"));
    const TemporaryFolder folder;
    Options options;
    options.scene.path = folder.write("a.glb", file.glb());
    Progress silent(Toggle::OFF, true);
    const auto loaded = [&] { return load_scene(options, silent); };
    EXPECT_EQ(loaded().camera.eye.z, 3);
    EXPECT_EQ(loaded().picture_size, glm::ivec2(800, 400));
    EXPECT_EQ(loaded().camera.at, glm::dvec3(0.2, 0.2, 0)) << "in the depth of what is seen";
    for (const char* name : {"b", "2"}) {
        options.camera.file_camera = name;
        EXPECT_EQ(loaded().camera.eye.z, 4) << name;
        EXPECT_EQ(loaded().picture_size, glm::ivec2(300, 600));
    }
    options.run.given["--size"] = "";
    EXPECT_EQ(loaded().picture_size, std::nullopt);
    options.camera.fov_degrees = 20;
    EXPECT_EQ(loaded().camera.fov_degrees, 20);
    options.camera.file_camera = "c";
    try {
        loaded();
        ADD_FAILURE();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "option --camera: expected one of 1 'a', 2 'b', found 'c'");
    }
    options.camera.file_camera.clear();
    options.camera.view = View::TOP;
    EXPECT_NE(loaded().camera.eye.z, 3) << "--view is fitted";
}

TEST(GltfLights, AreInBlendersUnitsUnlessRaw) {
    GltfBuilder file = one_triangle();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(R"([
        {"type": "point", "intensity": 683, "color": [1, 0.5, 0]}, {"type": "directional", "intensity": 1366}])");
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    file.json["nodes"].push_back(
        Json::parse(R"({"translation": [1,2,3], "extensions": {"KHR_lights_punctual": {"light": 0}}})"));
    file.json["nodes"].push_back(
        Json::parse(R"({"rotation": [-1,0,0,1], "extensions": {"KHR_lights_punctual": {"light": 1}}})"));
    const ReadGltf read(file.glb());
    ASSERT_EQ(read.scene.points.size(), 1u);
    ASSERT_EQ(read.scene.suns.size(), 1u);
    EXPECT_EQ(read.scene.points[0].position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(read.scene.points[0].intensity, glm::dvec3(1, 0.5, 0));
    expect_near(read.scene.suns[0].towards, {0, 1, 0});
    EXPECT_EQ(read.scene.suns[0].irradiance, glm::dvec3(2));
    EXPECT_TRUE(read.notes("divided by 683"));
    EXPECT_EQ(ReadGltf(file.glb(), {GltfLights::RAW, false}).scene.points[0].intensity.x, 683);
    file.json["nodes"][1]["extensions"]["KHR_lights_punctual"]["light"] = 2;
    EXPECT_NE(gltf_error(file.glb()).find("KHR_lights_punctual.light: expected an index of one of 2 lights"),
              std::string::npos);
}

TEST(GltfLights, SpotsShineAlongTheirNodesMinusZ) {
    GltfBuilder file = one_triangle();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = Json::parse(
        R"([{"type": "spot", "intensity": 6.83, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}}])");
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["nodes"].push_back(
        Json::parse(R"({"rotation": [-1,0,0,1], "extensions": {"KHR_lights_punctual": {"light": 0}}})"));
    const ReadGltf read(file.glb());
    ASSERT_TRUE(read.scene.points.at(0).cone);
    expect_near(read.scene.points[0].cone->direction, {0, -1, 0});
    EXPECT_NEAR(read.scene.points[0].cone->outer_degrees, 28.64788975654116, 1e-12);
    EXPECT_NEAR(read.scene.points[0].cone->inner_degrees, 14.32394487827058, 1e-12);
    EXPECT_NEAR(read.scene.points[0].intensity.x, 0.01, 1e-15);
    file.json["extensions"]["KHR_lights_punctual"]["lights"][0]["spot"]["innerConeAngle"] = 0.6;
    EXPECT_NE(
        gltf_error(file.glb()).find("spot: expected angles with 0 <= innerConeAngle <= outerConeAngle <= pi"),
        std::string::npos);
}

/// What is the same picture: geometry, materials, lights.
TEST(GltfScene, IsTheSameAsItsObj) {
    const TemporaryFolder folder;
    folder.write("m.mtl",
                 "newmtl red\nKd 0.75 0.25 0.125\nPr 0.5\nPm 0\nnewmtl gold\nKd 1 0.75 0.25\nPr 0.25\nPm 1\n"
                 "newmtl lamp\nKd 0 0 0\nKe 4 4 2\nPm 0\nPr 1\n");
    const std::string obj = folder.write(
        "a.obj",
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 0 2 0\nv 0 2 1\nv 1 2 0\n"
        "vn 0 0 1\nvn 0 0.6 0.8\nvn 0 0 1\nusemtl red\nf 1//1 2//2 3//3\nusemtl gold\nf 4 5 6\n"
        "usemtl lamp\nf 7 8 9\n");
    GltfBuilder file;
    file.json["materials"] = Json::parse(R"([
        {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.75,0.25,0.125,1], "roughnessFactor": 0.5,
                                                 "metallicFactor": 0}},
        {"name": "gold", "pbrMetallicRoughness": {"baseColorFactor": [1,0.75,0.25,1], "roughnessFactor": 0.25}},
        {"name": "lamp", "pbrMetallicRoughness": {"baseColorFactor": [0,0,0,1], "metallicFactor": 0},
         "emissiveFactor": [1, 1, 0.5], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}}}])");
    file.add_mesh(TRIANGLE_POSITIONS)["material"] = 0;
    file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        file.add<float>({0, 0, 1, 0, 0.6f, 0.8f, 0, 0, 1}, "VEC3", 3);
    file.add_mesh({0, 0, 1, 1, 0, 1, 0, 1, 1})["material"] = 1;
    file.add_mesh({0, 2, 0, 0, 2, 1, 1, 2, 0})["material"] = 2;
    file.json["nodes"] = Json::parse(R"([{"mesh": 0}, {"mesh": 1}, {"mesh": 2}])");
    file.json["scenes"][0]["nodes"] = {0, 1, 2};
    Options options;
    Progress silent(Toggle::OFF, true);
    options.scene.path = obj;
    options.camera.up = glm::dvec3(0, 1, 0);
    const Scene a = load_scene(options, silent);
    options.scene.path = folder.write("a.glb", file.glb());
    const Scene b = load_scene(options, silent);
    const auto same = [](const auto& x, const auto& y) {
        return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]) == 0;
    };
    EXPECT_TRUE(same(a.positions, b.positions));
    EXPECT_TRUE(same(a.normals, b.normals));
    EXPECT_TRUE(same(a.materials, b.materials));
    EXPECT_TRUE(same(a.emitters, b.emitters));
    ASSERT_EQ(a.triangles.size(), b.triangles.size());
    for (size_t i = 0; i < a.triangles.size(); ++i) {
        EXPECT_EQ(a.triangles[i].v1, b.triangles[i].v1);
        EXPECT_EQ(a.triangles[i].material, b.triangles[i].material);
        EXPECT_EQ(a.triangles[i].n2, b.triangles[i].n2);
    }
    EXPECT_EQ(a.camera.eye, b.camera.eye);
}

} // namespace clrt
