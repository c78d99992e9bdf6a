// SPDX-License-Identifier: Apache-2.0
// glTF meshes packed by Draco and meshoptimizer: a square of two triangles, packed by their own encoders.
#include "codecs/mesh_codecs.h"
#include "gltf_support.h"

#include <gtest/gtest.h>
#include <stdexcept>

namespace clrt {

namespace {

std::vector<std::uint8_t> bytes_of(const std::string& hex) {
    std::vector<std::uint8_t> bytes;
    for (size_t i = 0; i < hex.size(); i += 2)
        bytes.push_back(std::uint8_t(std::stoi(hex.substr(i, 2), nullptr, 16)));
    return bytes;
}

/// Four vertices of 16 bytes: x, y, z and a pad.
const char* const PACKED_VERTICES =
    "a00000013f000000ffffff013f0000007e7d7e0000010c000000ff010c0000007e000000000000000000"
    "00000000000000000000000000000000000000000000000000000000000000";
const char* const PACKED_INDICES = "e0f010007687566778a9866589689801690000";
const char* const PACKED_MESH =
    "445241434f0202010000000204010001020201030101000903000000000000000000000000000000000080"
    "3f0000000000000000000000000000803f000000000000803f0000803f00000000";

GltfBuilder square_by_meshopt() {
    GltfBuilder file;
    file.add_mesh({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    file.json["meshes"][0]["primitives"][0]["indices"] =
        file.add<std::uint32_t>({0, 0, 0, 0, 0, 0}, "SCALAR", 1);
    const auto pack = [&](size_t view, const char* hex, const char* mode, size_t count, size_t stride) {
        const size_t packed = file.add_view(bytes_of(hex));
        Json packing = file.json["bufferViews"][packed];
        packing["mode"] = mode;
        packing["count"] = count;
        packing["byteStride"] = stride;
        file.json["bufferViews"][view]["extensions"]["EXT_meshopt_compression"] = packing;
    };
    pack(0, PACKED_VERTICES, "ATTRIBUTES", 4, 16);
    pack(1, PACKED_INDICES, "TRIANGLES", 6, 4);
    return file;
}

GltfBuilder square_by_draco() {
    GltfBuilder file;
    file.add_mesh({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    Json packing = Json::object();
    packing["bufferView"] = file.add_view(bytes_of(PACKED_MESH));
    packing["attributes"]["POSITION"] = 0;
    file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = packing;
    return file;
}

/// Whether this build unpacks a mesh: each library is optional.
bool lacks_library(const std::string& error) {
    return error.find("which this clrt was built without") != error.npos;
}

void expect_square(GltfBuilder file) {
    const std::string bytes = file.glb();
    if (lacks_library(gltf_error(bytes)))
        GTEST_SKIP();
    const ReadGltf read(bytes);
    ASSERT_EQ(read.mesh().triangles.size(), 2u);
    double area = 0;
    for (size_t t = 0; t < 2; ++t) {
        const glm::dvec3 e1 = read.corner(t, 1) - read.corner(t, 0),
                         e2 = read.corner(t, 2) - read.corner(t, 0);
        area += (e1.x * e2.y - e1.y * e2.x) / 2;
    }
    EXPECT_EQ(area, 1);
}

} // namespace

TEST(GltfPacked, MeshoptimizerGivesTheSquare) {
    expect_square(square_by_meshopt());
}

TEST(GltfPacked, DracoGivesTheSquare) {
    expect_square(square_by_draco());
}

TEST(GltfPacked, DamageIsAnErrorThatSaysWhere) {
    GltfBuilder meshopt = square_by_meshopt(), draco = square_by_draco();
    if (lacks_library(gltf_error(square_by_meshopt().glb())) ||
        lacks_library(gltf_error(square_by_draco().glb())))
        GTEST_SKIP();
    Json& packing = meshopt.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
    const Json whole = packing;
    const auto error_with = [&](const char* key, const Json& value) {
        packing = whole;
        packing[key] = value;
        return gltf_error(meshopt.glb());
    };
    const std::string where = "a.glb: bufferViews[0].extensions.EXT_meshopt_compression: expected ";
    EXPECT_EQ(error_with("byteLength", 40), where + "bytes packed by meshoptimizer, found damaged bytes");
    EXPECT_EQ(error_with("byteStride", 6),
              where + "bytes packed by meshoptimizer, found mode ATTRIBUTES with a stride of 6");
    EXPECT_EQ(error_with("mode", "OTHER").find(where + "bytes packed"), 0u);
    EXPECT_EQ(error_with("filter", "OCTAHEDRAL"),
              where + "bytes packed by meshoptimizer, found filter OCTAHEDRAL with a stride of 16");
    EXPECT_EQ(error_with("count", 1e14).find(where + "at most 65536 bytes in 73 packed ones"), 0u);
    draco.bytes.resize(draco.bytes.size() - 30);
    draco.json["bufferViews"][1]["byteLength"] = 46;
    EXPECT_EQ(
        gltf_error(draco.glb())
            .find("a.glb: meshes[0].primitives[0].extensions.KHR_draco_mesh_compression: expected a mesh "
                  "packed by Draco, found a damaged Draco mesh"),
        0u);
}

} // namespace clrt
