// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/ply_reader.h"

#include "colour.h"
#include "error.h"
#include "scene/readers/ply_header.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace clrt {

namespace {

struct ReadPly {
    NoticeList notices;
    SceneDescription scene;

    explicit ReadPly(const std::string& bytes) {
        Progress silent(Toggle::OFF, true);
        scene = read_ply_scene({"a.ply", bytes}, {silent, notices, {}, MtlReading::AUTO, {}});
    }
    const Mesh& mesh() const { return scene.mesh; }
    std::vector<u32> corners() const {
        std::vector<u32> all;
        for (const MeshTriangle& triangle : mesh().triangles)
            all.insert(all.end(), triangle.v, triangle.v + 3);
        return all;
    }
};

std::string error_of(const std::string& bytes) {
    try {
        const ReadPly read(bytes);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

const std::string VERTICES = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n",
                  FACES = "element face 1\nproperty list uchar int vertex_indices\n",
                  SQUARE = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

std::string ascii(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\ncomment made here\n" + header + "end_header\n" + body;
}

/// Appends a number's bytes, reversed for big-endian files.
template <typename T>
void append(std::string& bytes, T value, bool big) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (big)
        std::reverse(raw, raw + sizeof value);
    bytes.append(raw, sizeof value);
}

/// The square with a list and a number that are to be skipped.
std::string binary(bool big) {
    std::string bytes =
        "ply\r\nformat binary_" + std::string(big ? "big" : "little") +
        "_endian 1.0\r\nelement camera 1\nproperty double t\nelement vertex 4\nproperty double x\n"
        "property list ushort short odd\nproperty float y\nproperty int z\nelement face 1\n"
        "property list uint uint vertex_index\nproperty uchar flags\nend_header\n";
    append(bytes, 7.0, big);
    const float square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (const auto& p : square) {
        append(bytes, double(p[0]), big);
        append(bytes, std::uint16_t(2), big);
        append(bytes, std::int16_t(-1), big);
        append(bytes, std::int16_t(300), big);
        append(bytes, p[1], big);
        append(bytes, std::int32_t(-5), big);
    }
    append(bytes, std::uint32_t(4), big);
    for (std::uint32_t v = 0; v < 4; ++v)
        append(bytes, v, big);
    return bytes + '\1';
}

} // namespace

TEST(PlyReader, TextsAndBothByteOrdersGiveTheSame) {
    EXPECT_TRUE(is_ply("ply\n") && is_ply("ply\r\n") && !is_ply("plya") && !is_ply("pl"));
    const ReadPly text(ascii(VERTICES + FACES, SQUARE + "4 0 1 2 3\n"));
    EXPECT_EQ(text.mesh().triangles.size(), 2u);
    EXPECT_EQ(text.mesh().positions.at(2), glm::dvec3(1, 1, 0));
    for (const bool big : {false, true}) {
        const ReadPly read(binary(big));
        EXPECT_EQ(read.corners(), text.corners()) << big;
        EXPECT_EQ(read.mesh().positions.at(2), glm::dvec3(1, 1, -5)) << big;
    }
}

TEST(PlyReader, AttributesOfVerticesAreRead) {
    const ReadPly read(
        ascii("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n"
              "property uchar green\nproperty uchar blue\nproperty float s\nproperty float t\n" +
                  FACES,
              "0 0 0 0 0 1 255 128 0 0.5 0.25\n1 0 0 0 0 1 0 0 0 0 0\n0 1 0 0 0 1 0 0 0 0 0\n"
              "3 0 1 2\n"));
    EXPECT_EQ(read.mesh().normals.at(0), glm::vec3(0, 0, 1));
    EXPECT_EQ(read.mesh().uvs.at(0), glm::vec2(0.5, 0.25));
    EXPECT_EQ(read.mesh().colours.at(0), glm::vec3(1, float(srgb_to_linear(128 / 255.)), 0));
    EXPECT_TRUE(read.scene.materials.at(0).base.map->by_vertex);
    EXPECT_FALSE(ReadPly(ascii(VERTICES + FACES, SQUARE + "3 0 1 2\n")).scene.materials.at(0).base.map);
}

TEST(PlyReader, StripsTurnEverySecondTriangle) {
    const ReadPly read(ascii(VERTICES + "element tristrips 1\nproperty list int int vertex_indices\n",
                             SQUARE + "8 0 1 3 2 -1 0 1 2\n"));
    EXPECT_EQ(read.corners(), (std::vector<u32>{0, 1, 3, 1, 2, 3, 0, 1, 2}));
}

TEST(PlyReader, FacesThatAreNoneAreLeftOut) {
    const std::string faces = "element face 3\nproperty list uchar int vertex_indices\n";
    const ReadPly read(ascii(VERTICES + faces, "nan 0 0\n1 0 0\n1 1 0\n0 1 0\n3 1 2 3\n2 1 2\n3 0 1 2\n"));
    EXPECT_EQ(read.mesh().triangles.size(), 1u);
    EXPECT_EQ(read.scene.dropped_faces, 2u);
}

TEST(PlyReader, FaultsAreErrorsThatSayWhere) {
    EXPECT_EQ(error_of(ascii(VERTICES + FACES, SQUARE + "3 0 1 4\n")),
              "a.ply:15: expected the index of one of 4 vertices, found 4");
    EXPECT_EQ(error_of(ascii(VERTICES + FACES, "0 0 x\n")), "a.ply:11: expected a number, found 'x'");
    EXPECT_EQ(error_of(ascii(VERTICES + FACES, SQUARE + "3 0 1")),
              "a.ply:15: expected a number, found the end of the file");
    EXPECT_EQ(error_of(ascii("element vertex many\n", "")),
              "a.ply:4: expected a number of elements, found 'many'");
    EXPECT_EQ(error_of(ascii("property float x\n", "")).find("a.ply:4: expected format, element"), 0u);
    EXPECT_EQ(error_of(ascii("element vertex 1\nproperty half x\n", "")),
              "a.ply:5: expected the type of a number, found 'half'");
    EXPECT_EQ(error_of("ply\nformat ascii 1.0\n").find("a.ply:3: expected end_header"), 0u);
    EXPECT_NE(error_of(ascii(VERTICES, SQUARE)).find("no faces to render"), std::string::npos);
    const std::string whole = binary(false);
    for (size_t length = 4; length + 1 < whole.size(); ++length)
        EXPECT_NE(error_of(whole.substr(0, length)), "") << length;
}

} // namespace clrt
