// SPDX-License-Identifier: Apache-2.0
// Accessors: every type, and every way in which one can be broken.
#include "gltf_support.h"

#include <gtest/gtest.h>
#include <limits>

namespace clrt {

namespace {

/// A file with one triangle, which `change` breaks.
template <typename Change>
std::string error_after(const Change& change) {
    GltfBuilder file;
    file.add_mesh(TRIANGLE_POSITIONS);
    file.json["meshes"][0]["primitives"][0]["indices"] = file.add<std::uint16_t>({0, 1, 2}, "SCALAR", 1);
    change(file);
    return gltf_error(file.glb());
}

/// Positions of a triangle whose corners are given in some integer type.
template <typename T>
std::vector<glm::dvec3> quantised(const std::vector<T>& values, bool normalised) {
    GltfBuilder file;
    file.add_mesh(TRIANGLE_POSITIONS)["attributes"]["POSITION"] = 1;
    file.add(values, "VEC3", 3, normalised);
    const ReadGltf read(file.glb());
    return {read.corner(0, 0), read.corner(0, 1), read.corner(0, 2)};
}

} // namespace

TEST(GltfAccessors, IntegersAreNumbersOrNormalised) {
    using V = glm::dvec3;
    EXPECT_EQ(quantised<std::int8_t>({-128, 127, 0, 5, 0, 0, 0, 5, 0}, false)[0], V(-128, 127, 0));
    EXPECT_EQ(quantised<std::int8_t>({-128, 127, 0, 5, 0, 0, 0, 5, 0}, true)[0], V(-1, 1, 0)) << "-128 is -1";
    EXPECT_EQ(quantised<std::uint8_t>({255, 51, 0, 5, 0, 0, 0, 5, 0}, true)[0], V(1, 0.2f, 0));
    EXPECT_EQ(quantised<std::int16_t>({-32768, 32767, 0, 5, 0, 0, 0, 5, 0}, true)[0], V(-1, 1, 0));
    EXPECT_EQ(quantised<std::uint16_t>({65535, 13107, 0, 5, 0, 0, 0, 5, 0}, true)[0], V(1, 0.2f, 0));
    EXPECT_EQ(quantised<std::uint16_t>({65535, 13107, 0, 5, 0, 0, 0, 5, 0}, false)[0], V(65535, 13107, 0));
}

TEST(GltfAccessors, IndicesAreOfThreeTypes) {
    const auto corners = [](auto indices) {
        GltfBuilder file;
        file.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
        file.json["meshes"][0]["primitives"][0]["indices"] = file.add(indices, "SCALAR", 1);
        const ReadGltf read(file.glb());
        return read.corner(0, 0) + 10. * read.corner(0, 1) + 100. * read.corner(0, 2);
    };
    const glm::dvec3 expected(110, 101, 0); // corners 3, 1, 2 have x, y = 1,1, 1,0 and 0,1
    EXPECT_EQ(corners(std::vector<std::uint8_t>{3, 1, 2}), glm::dvec3(11, 101, 0));
    EXPECT_EQ(corners(std::vector<std::uint16_t>{3, 1, 2}), glm::dvec3(11, 101, 0));
    EXPECT_EQ(corners(std::vector<std::uint32_t>{2, 1, 3}), expected);
}

TEST(GltfAccessors, StridesAndOffsetsSkipBytes) {
    GltfBuilder file;
    file.add_mesh(TRIANGLE_POSITIONS);
    // Elements of three floats and a pad, behind four bytes that are not theirs.
    file.json["accessors"][0]["bufferView"] =
        file.add_view<float>({99, 1, 2, 3, 98, 4, 5, 6, 97, 7, 8, 10, 96});
    file.json["accessors"][0]["byteOffset"] = 4;
    file.json["bufferViews"].back()["byteStride"] = 16;
    const ReadGltf read(file.glb());
    EXPECT_EQ(read.corner(0, 0), glm::dvec3(1, 2, 3));
    EXPECT_EQ(read.corner(0, 1), glm::dvec3(4, 5, 6));
    EXPECT_EQ(read.corner(0, 2), glm::dvec3(7, 8, 10));
}

TEST(GltfAccessors, SparseOnesReplaceElements) {
    for (const bool has_view : {true, false}) {
        GltfBuilder file;
        file.add_mesh(TRIANGLE_POSITIONS);
        Json sparse;
        sparse["count"] = 2;
        sparse["indices"]["bufferView"] = file.add_view<std::uint8_t>({1, 2});
        sparse["indices"]["componentType"] = 5121;
        sparse["values"]["bufferView"] = file.add_view<float>({7, 0, 0, 0, 8, 0});
        file.json["accessors"][0]["sparse"] = sparse;
        if (!has_view)
            file.json["accessors"][0].erase("bufferView");
        const ReadGltf read(file.glb());
        EXPECT_EQ(read.corner(0, 0), glm::dvec3(0)) << "zero without a view";
        EXPECT_EQ(read.corner(0, 1), glm::dvec3(7, 0, 0));
        EXPECT_EQ(read.corner(0, 2), glm::dvec3(0, 8, 0));
    }
}

TEST(GltfAccessors, BrokenOnesAreErrorsThatSayWhere) {
    using B = GltfBuilder;
    struct Case {
        void (*change)(B&);
        const char* message;
    };
    const Case cases[] = {
        {[](B& f) { f.json["accessors"][0]["count"] = 4; },
         "accessors[0]: expected elements within the 36 bytes of its view, found 4 elements of 12 bytes, 12 "
         "apart, "
         "from byte 0"},
        {[](B& f) { f.json["accessors"][0]["byteOffset"] = 4; }, "accessors[0]: expected elements within"},
        {[](B& f) {
             f.json["accessors"][0]["count"] = 1;
             f.json["accessors"][0]["byteOffset"] = 28;
         },
         "1 elements of 12 bytes, 12 apart, from byte 28"},
        {[](B& f) { f.json["accessors"][0]["byteOffset"] = 9007199254740992; }, "expected elements within"},
        {[](B& f) { f.json["accessors"][0]["count"] = 9007199254740992; }, "expected elements within"},
        {[](B& f) { f.json["accessors"][0]["count"] = -3; },
         "accessors[0].count: expected a whole number from 0, found -3"},
        {[](B& f) { f.json["accessors"][0]["count"] = "three"; },
         "accessors[0].count: expected a whole number from 0, found 'three'"},
        {[](B& f) { f.json["accessors"][0]["count"] = 2.5; }, "expected a whole number from 0, found 2.5"},
        {[](B& f) { f.json["accessors"][0].erase("count"); },
         "accessors[0]: expected an object with count, found no count"},
        {[](B& f) { f.json["accessors"][0]["componentType"] = 5124; },
         "accessors[0].componentType: expected a component type"},
        {[](B& f) {
             f.json["accessors"][0]["componentType"] = 5125;
             f.json["accessors"][0]["normalized"] = true;
         },
         "accessors[0].normalized: expected integers of 1 or 2 bytes to normalise, found true"},
        {[](B& f) { f.json["accessors"][0]["type"] = "VEC2"; },
         "accessors[0].type: expected VEC3, found 'VEC2'"},
        {[](B& f) { f.json["accessors"][1]["componentType"] = 5122; },
         "accessors[1].componentType: expected an unsigned type, for indices, found 5122"},
        {[](B& f) {
             f.json["accessors"][0].erase("bufferView");
             f.json["accessors"][0]["count"] = 1e12;
         },
         "accessors[0].count: expected at most 16777216 elements without a bufferView"},
        {[](B& f) { f.json["bufferViews"][0]["byteStride"] = 1e15; },
         "accessors[0]: expected elements within"},
        {[](B& f) { f.json["bufferViews"][0]["byteLength"] = 4000; },
         "bufferViews[0]: expected a range within its buffer of 42 bytes, found 4000 bytes from byte 0"},
        {[](B& f) { f.json["bufferViews"][0]["byteOffset"] = 1e15; }, "expected a range within its buffer"},
        {[](B& f) { f.json["bufferViews"][0]["buffer"] = 1; },
         "bufferViews[0].buffer: expected an index into buffers, which has 1 elements, found 1"},
        {[](B& f) { f.json["accessors"][0]["bufferView"] = 7; },
         "accessors[0].bufferView: expected an index into bufferViews, which has 2 elements, found 7"},
        {[](B& f) { f.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = "0"; },
         "meshes[0].primitives[0].attributes.POSITION: expected a whole number from 0, found '0'"},
        {[](B& f) {
             f.json["meshes"][0]["primitives"][0]["indices"] = f.add<std::uint8_t>({0, 1, 3}, "SCALAR", 1);
         },
         "meshes[0].primitives[0].indices: expected indices below 3, the number of vertices, found 3 as "
         "number 2"},
        {[](B& f) {
             f.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
                 f.add<float>({0, 0, 1}, "VEC3", 3);
         },
         "meshes[0].primitives[0].attributes.NORMAL: expected 3 elements as in POSITION, found 1"},
        {[](B& f) {
             f.json["accessors"][0]["sparse"] = {
                 {"count", 4}, {"indices", Json::object()}, {"values", Json::object()}};
         },
         "accessors[0].sparse.count: expected at most the 3 elements of the accessor, found 4"},
    };
    for (const Case& broken : cases) {
        const std::string error = error_after(broken.change);
        EXPECT_EQ(error.find("a.glb: "), 0u) << broken.message;
        EXPECT_NE(error.find(broken.message), std::string::npos) << broken.message << "\n  but " << error;
    }
}

TEST(GltfAccessors, ASparseIndexBeyondTheEndIsAnError) {
    const std::string error = error_after([](GltfBuilder& file) {
        Json sparse;
        sparse["count"] = 1;
        sparse["indices"]["bufferView"] = file.add_view<std::uint8_t>({3});
        sparse["indices"]["componentType"] = 5121;
        sparse["values"]["bufferView"] = file.add_view<float>({7, 0, 0});
        file.json["accessors"][0]["sparse"] = sparse;
    });
    EXPECT_NE(error.find("accessors[0].sparse.indices: expected indices below 3, found 3"), std::string::npos)
        << error;
}

TEST(GltfAccessors, TrianglesWithACornerThatIsNotFiniteAreLeftOut) {
    GltfBuilder file;
    file.add_mesh({0, 0, 0, 1, 0, 0, 0, 1, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0});
    file.json["meshes"][0]["primitives"][0]["indices"] =
        file.add<std::uint16_t>({0, 1, 2, 0, 1, 3}, "SCALAR", 1);
    const ReadGltf read(file.glb());
    EXPECT_EQ(read.mesh().triangles.size(), 1u);
    EXPECT_EQ(read.scene.dropped_faces, 1u);
}

} // namespace clrt
