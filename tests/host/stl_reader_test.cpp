// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/stl_reader.h"

#include "error.h"
#include "scene/load_scene.h"
#include "scene_support.h"

#include <cstring>
#include <gtest/gtest.h>
#include <limits>

namespace clrt {

namespace {

using Facet = std::vector<glm::vec3>;

const std::vector<Facet> TETRAHEDRON = {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                                        {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                        {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}},
                                        {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

std::string text_of(const std::vector<Facet>& facets, const std::string& name = "a thing") {
    std::string text = "solid " + name + "\n";
    for (const Facet& facet : facets) {
        text += "  facet normal 0 0 1\n    outer loop\n";
        for (const glm::vec3& p : facet)
            text += "      vertex " + std::to_string(p.x) + " " + std::to_string(p.y) + " " +
                    std::to_string(p.z) + "\n";
        text += "    endloop\n  endfacet\n";
    }
    return text + "endsolid " + name + "\n";
}

template <typename T>
void append(std::string& bytes, T value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
}

std::string binary_of(const std::vector<Facet>& facets, std::string header = "a thing") {
    header.resize(80, '\0');
    append(header, std::uint32_t(facets.size()));
    for (const Facet& facet : facets) {
        for (int i = 0; i < 3; ++i)
            append(header, 0.0f);
        for (const glm::vec3& p : facet)
            for (int c = 0; c < 3; ++c)
                append(header, p[c]);
        append(header, std::uint16_t(0));
    }
    return header;
}

struct Read {
    NoticeList notices;
    SceneDescription scene;

    explicit Read(const std::string& bytes) {
        Progress silent(Toggle::OFF, true);
        scene = read_stl_scene({"a.stl", bytes}, {silent, notices, {}, MtlReading::AUTO});
    }
    const Mesh& mesh() const { return scene.mesh; }
    glm::dvec3 corner(size_t triangle, int c) const {
        return mesh().positions.at(mesh().triangles.at(triangle).v[c]);
    }
};

std::string error_of(const std::string& bytes) {
    try {
        const Read read(bytes);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "";
}

void expect_tetrahedron(const Read& read) {
    ASSERT_EQ(read.mesh().triangles.size(), 4u);
    EXPECT_EQ(read.mesh().positions.size(), 4u) << "equal vertices are one";
    for (size_t t = 0; t < 4; ++t)
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(read.corner(t, c), glm::dvec3(TETRAHEDRON[t][size_t(c)])) << t << " " << c;
}

} // namespace

TEST(StlReader, TextAndBinaryGiveTheSameMesh) {
    for (const std::string& bytes : {text_of(TETRAHEDRON), binary_of(TETRAHEDRON)}) {
        ASSERT_TRUE(is_stl(bytes));
        const Read read(bytes);
        expect_tetrahedron(read);
        EXPECT_TRUE(read.notices.lines().empty());
        ASSERT_EQ(read.scene.materials.size(), 1u);
        EXPECT_EQ(read.scene.materials[0].rule, "no material: matte Kd 0.8");
        EXPECT_EQ(read.scene.materials[0].place.file, "a.stl");
        EXPECT_EQ(read.scene.z_up_reason, "it is an STL file, whose up is z by custom");
    }
    EXPECT_EQ(Read(text_of(TETRAHEDRON)).mesh().object_names, std::vector<std::string>{"a thing"});
    EXPECT_EQ(Read(binary_of(TETRAHEDRON)).mesh().object_names, std::vector<std::string>{""});
}

TEST(StlReader, ABinaryFileIsKnownByItsSizeWhateverItBeginsWith) {
    const std::string solid = binary_of(TETRAHEDRON, "solid facet");
    EXPECT_TRUE(is_stl(solid));
    expect_tetrahedron(Read(solid));
    EXPECT_FALSE(is_stl(solid + "x"));
    EXPECT_FALSE(is_stl(std::string(84, '\0'))) << "no triangles: nothing but zeros";
    EXPECT_FALSE(is_stl("solid\nv 0 0 0\n")) << "an OBJ may hold a statement that nobody knows";
    EXPECT_FALSE(is_stl("g facet\nsolid\n"));
    EXPECT_FALSE(is_stl(""));
}

TEST(StlReader, SolidsAreObjectsAndWordsStandAnywhere) {
    const Read read(
        "\xef\xbb\xbf\r\nSOLID one\r\nFacet Normal 0 0 1 outer loop vertex 0 0 0\tvertex 1 0 0\n"
        "VERTEX 0 1 0 endloop endfacet\nendsolid one more word\n\nsolid\nfacet normal nan nan nan\n"
        "outer loop\nvertex 0 0 1e0\nvertex +1 0 1\nvertex 0 1 1\nendloop\nendfacet\nendsolid");
    ASSERT_EQ(read.mesh().triangles.size(), 2u);
    EXPECT_EQ(read.mesh().object_names, (std::vector<std::string>{"one", ""}));
    EXPECT_EQ(read.mesh().triangles[1].object, 1u);
    EXPECT_EQ(read.corner(1, 1), glm::dvec3(1, 0, 1));
    EXPECT_TRUE(read.notices.lines().empty());
}

TEST(StlReader, FacetsWithMoreVerticesAreCut) {
    const Read read(text_of({{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}}));
    EXPECT_EQ(read.mesh().triangles.size(), 2u);
    EXPECT_EQ(read.mesh().positions.size(), 4u);
}

TEST(StlReader, NegativeZeroIsZero) {
    EXPECT_EQ(Read(binary_of({{{0, -0.0f, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}}}))
                  .mesh()
                  .positions.size(),
              4u);
}

TEST(StlReader, FacetsThatCannotBeRenderedAreLeftOutAndCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Facet good{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, bad{{0, 0, 0}, {nan, 0, 0}, {0, 1, 0}};
    const Read binary(binary_of({bad, good, bad}));
    EXPECT_EQ(binary.mesh().triangles.size(), 1u);
    EXPECT_EQ(binary.scene.dropped_faces, 2u);
    EXPECT_EQ(count_notices(binary.notices,
                            "a.stl: a facet with a vertex that is not finite is left out (and 1 more)"),
              1);
    const Read text(text_of({good, {{0, 0, 0}, {1, 0, 0}}, bad}) +
                    "solid\nfacet normal 0 0 1\nouter loop\nvertex 1e39 0 0\nvertex 0 0 0\nvertex 0 1 0\n"
                    "endloop\nendfacet\nendsolid\n");
    EXPECT_EQ(text.mesh().triangles.size(), 1u);
    EXPECT_EQ(text.scene.dropped_faces, 3u);
    EXPECT_EQ(count_notices(text.notices, "a.stl:9: a facet with fewer than three vertices is left out"), 1);
    EXPECT_EQ(count_notices(text.notices,
                            "a.stl:15: a facet with a vertex that is not finite is left out (and 1 more)"),
              1);
    for (const std::string& bytes : {binary_of({bad, bad}), text_of({bad, bad})})
        EXPECT_EQ(error_of(bytes), "a.stl: the file has no triangles to render; facets that are left out: 2");
}

TEST(StlReader, WhatIsIgnoredIsSaid) {
    std::string bytes = binary_of(TETRAHEDRON);
    bytes[84 + 48] = 1;
    bytes[84 + 50 + 49] = 2;
    const Read read(bytes + "xyz");
    expect_tetrahedron(read);
    EXPECT_EQ(count_notices(read.notices, "a.stl: attributes of 2 triangles"), 1);
    EXPECT_EQ(count_notices(read.notices, "a.stl: 3 bytes behind the triangles, from byte 284, are ignored"),
              1);
}

TEST(StlReader, ErrorsNameThePlace) {
    EXPECT_EQ(error_of(binary_of(TETRAHEDRON).substr(0, 283)),
              "a.stl: byte 84: expected 4 triangles of 50 bytes, as byte 80 says, found 3 and the end of the "
              "file: it is cut off, or no STL file");
    EXPECT_EQ(error_of("x"), "a.stl: expected an STL file: a text that begins with solid, or 84 bytes before "
                             "the triangles, found 1 bytes");
    const std::string head = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n";
    EXPECT_EQ(error_of(head + "vertex 1 x 0\n"), "a.stl:5: expected a number, found 'x'");
    EXPECT_EQ(error_of(head + "endfacet\n"), "a.stl:5: expected vertex or endloop, found 'endfacet'");
    EXPECT_EQ(error_of(head), "a.stl:4: expected vertex or endloop, found the end of the file");
    EXPECT_EQ(error_of("solid a\nv 0 0 0\n"), "a.stl:2: expected facet or endsolid, found 'v'");
    EXPECT_EQ(error_of("solid a\nendsolid a\nfacet\n"), "a.stl:3: expected solid, found 'facet'");
    EXPECT_EQ(error_of("solid a\nendsolid a\n"),
              "a.stl: the file has no triangles to render; facets that are left out: 0");
}

TEST(StlReader, AFileCutOffAnywhereIsAnError) {
    const std::string text = text_of(TETRAHEDRON), binary = binary_of(TETRAHEDRON);
    for (size_t length = 0; length < text.rfind("d a thing"); ++length)
        EXPECT_NE(error_of(text.substr(0, length)), "") << length;
    for (size_t length = 0; length < binary.size(); ++length)
        EXPECT_NE(error_of(binary.substr(0, length)), "") << length;
}

TEST(StlReader, AnStlIsASceneOfItsOwn) {
    const TemporaryFolder folder;
    Options options;
    options.scene.path = folder.write("a.stl", binary_of(TETRAHEDRON));
    Progress silent(Toggle::OFF, true);
    const Scene scene = load_scene(options, silent);
    EXPECT_EQ(scene.camera.up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(scene.statistics.obj_bytes, 284u);
    EXPECT_FLOAT_EQ(scene.materials.at(0).matte.x, 0.8f);
    EXPECT_EQ(count_notices(scene.notices, "a.stl: z is taken as up, --up z, since it is an STL file"), 1);
}

} // namespace clrt
