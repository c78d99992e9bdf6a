// SPDX-License-Identifier: Apache-2.0
// Every statement, every kind of odd text and every error of the OBJ reader.
#include "scene/readers/obj_reader.h"

#include "error.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <sstream>
#include <tbb/global_control.h>
#include <unistd.h>

namespace clrt {
namespace {

const char* const SQUARE = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";

/// A file with a text, gone at the end of its scope.
class TemporaryObj {
public:
    explicit TemporaryObj(const std::string& text)
        : path_(testing::TempDir() + "obj_reader_test_" + std::to_string(getpid()) + ".obj") {
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~TemporaryObj() { std::filesystem::remove(path_); }
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

/// The message without the folder: "scene.obj:1: ...".
std::string without_path(std::string message, const std::string& path) {
    return message.rfind(path, 0) == 0 ? "scene.obj" + message.substr(path.size()) : message;
}

ObjMesh read(const std::string& text, size_t chunk_bytes = OBJ_CHUNK_BYTES) {
    const TemporaryObj file(text);
    Progress progress(Toggle::OFF, true);
    ObjMesh mesh = read_obj(read_scene_file(file.path()), progress, chunk_bytes);
    for (std::string& notice : mesh.notices)
        notice = without_path(notice, file.path());
    return mesh;
}

/// The SceneError that a text gives, empty if it gives none.
std::string error_of(const std::string& text, size_t chunk_bytes = OBJ_CHUNK_BYTES) {
    const TemporaryObj file(text);
    Progress progress(Toggle::OFF, true);
    try {
        read_obj(read_scene_file(file.path()), progress, chunk_bytes);
    } catch (const SceneError& error) {
        return without_path(error.what(), file.path());
    }
    return "";
}

/// Everything a mesh holds, bit by bit, for comparing two.
std::string dump(const ObjMesh& mesh) {
    std::ostringstream out;
    const auto bytes = [&out](const auto& values) {
        out << values.size() << ' ';
        out.write(reinterpret_cast<const char*>(values.data()),
                  std::streamsize(values.size() * sizeof values[0]));
    };
    bytes(mesh.positions), bytes(mesh.normals), bytes(mesh.uvs), bytes(mesh.triangles),
        bytes(mesh.material_lines), bytes(mesh.colours), bytes(mesh.smoothing);
    for (const auto* names : {&mesh.material_names, &mesh.object_names, &mesh.notices})
        for (const std::string& name : *names)
            out << name << '\n';
    for (const ObjLibrary& library : mesh.libraries)
        out << library.line << ' ' << library.names << '\n';
    out << mesh.dropped_faces;
    return out.str();
}

std::vector<u32> indices(const u32 (&values)[3]) {
    return {values[0], values[1], values[2]};
}

const std::vector<u32> NONE{NO_INDEX, NO_INDEX, NO_INDEX};
using Names = std::vector<std::string>;

TEST(ObjReader, TriangleHasPositionsUvsAndNormals) {
    const ObjMesh mesh =
        read("v 0 0 0\nv 1.5 0 -2e1\nv 0 1 0\nvt 0 0\nvt 1 .25\nvn 0 0 1\nf 1/1/1 2/2/1 3/1/1\n");
    ASSERT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.positions[1], glm::dvec3(1.5, 0, -20));
    EXPECT_EQ(mesh.uvs[1], glm::vec2(1, 0.25f));
    EXPECT_EQ(mesh.normals[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(indices(mesh.triangles[0].v), (std::vector<u32>{0, 1, 2}));
    EXPECT_EQ(indices(mesh.triangles[0].t), (std::vector<u32>{0, 1, 0}));
    EXPECT_EQ(indices(mesh.triangles[0].n), (std::vector<u32>{0, 0, 0}));
    EXPECT_EQ(mesh.material_names, Names{""});
    EXPECT_EQ(mesh.object_names, Names{""});
    EXPECT_EQ(mesh.notices, Names{});
}

TEST(ObjReader, TrianglesTakeOnlyAttributesThatAllCornersHave) {
    const std::string head = std::string(SQUARE) + "vt 0 0\nvn 0 0 1\n";
    const ObjMesh mesh =
        read(head + "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1 3/1/1\nf 1/1/1 2//1 3/1/1\n"
                    "f 1/ 2// 3\n");
    const bool has_uvs[] = {false, true, false, true, false, false};
    const bool has_normals[] = {false, false, true, false, true, false};
    ASSERT_EQ(mesh.triangles.size(), 6u);
    for (size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(indices(mesh.triangles[i].t) != NONE, has_uvs[i]) << i;
        EXPECT_EQ(indices(mesh.triangles[i].n) != NONE, has_normals[i]) << i;
    }
    EXPECT_EQ(mesh.notices, Names{});
}

TEST(ObjReader, NegativeIndicesCountBackFromTheirLine) {
    const ObjMesh mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf -3/-1/-1 -2/-1/-1 -1/-1/-1\n"
                              "v 5 0 0\nvt 1 1\nvn 0 1 0\nf -1/-1/-1 -2/-2/-2 -4/-1/-1\n");
    EXPECT_EQ(indices(mesh.triangles[0].v), (std::vector<u32>{0, 1, 2}));
    EXPECT_EQ(indices(mesh.triangles[1].v), (std::vector<u32>{3, 2, 0}));
    EXPECT_EQ(indices(mesh.triangles[1].t), (std::vector<u32>{1, 0, 1}));
    EXPECT_EQ(indices(mesh.triangles[1].n), (std::vector<u32>{1, 0, 1}));
}

TEST(ObjReader, PositiveIndicesMayPointForward) {
    EXPECT_EQ(indices(read(std::string("f +1 2 3\n") + SQUARE).triangles[0].v), (std::vector<u32>{0, 1, 2}));
}

TEST(ObjReader, EveryKindOfLineEndGivesTheSameMesh) {
    const std::string lf = std::string(SQUARE) + "\nusemtl a b\nf 1 2 3 4\n\nf 1 2 3";
    std::string crlf, cr;
    for (const char c : lf) {
        crlf += c == '\n' ? "\r\n" : std::string(1, c);
        cr += c == '\n' ? '\r' : c;
    }
    ObjMesh expected = read(lf);
    EXPECT_EQ(expected.material_lines, std::vector<size_t>{6});
    for (const std::string& text : {crlf, cr, lf + "\n"}) {
        ObjMesh mesh = read(text);
        EXPECT_EQ(dump(mesh), dump(expected));
    }
    for (const char* end : {"\n", "\r\n", "\r"})
        EXPECT_EQ(error_of(std::string("v 0 0 0") + end + end + "v 1 x 0" + end),
                  "scene.obj:3: expected a number after v, found 'x'");
}

TEST(ObjReader, BackslashContinuesLines) {
    const ObjMesh mesh =
        read("v 0 \\\n0 0\nv 2 0 0\r\nv 2 2\\\r\n 0\nv 0 2 0\nf 1 2 \\\n\\\n3 \\\n 4\nf 1 2 3\\");
    EXPECT_EQ(mesh.positions[2], glm::dvec3(2, 2, 0));
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_EQ(error_of("v 0 \\\n0 0\nv 1 \\\nx 0\n"), "scene.obj:3: expected a number after v, found 'x'");
}

TEST(ObjReader, BackslashInsideLineOrAfterCommentContinuesNothing) {
    const ObjMesh mesh =
        read("mtllib C:\\new folder\\a.mtl\n# C:\\scenes\\\n" + std::string(SQUARE) + "f 1 2 3\n");
    EXPECT_EQ(mesh.libraries[0].names, "C:\\new folder\\a.mtl");
    EXPECT_EQ(mesh.positions.size(), 4u);
}

TEST(ObjReader, MarksBlanksAndCommentsAreSkipped) {
    const ObjMesh mesh =
        read("\xef\xbb\xbfv 0 0 0\n\t v\t1 0\t 0 # one\n#v 9 9 9\n  v 0 1 0 \t\n \n f 1 2 3 # end\n");
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.notices, Names{});
}

TEST(ObjReader, ExtraNumbersAreIgnoredAndMissingUvsAreZero) {
    const ObjMesh mesh =
        read("v 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt .5\nvt .5 .25 0\nvt .5 # .25\nf 1/1 2/2 3/3\n");
    EXPECT_EQ(mesh.positions[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(mesh.uvs, (std::vector<glm::vec2>{{.5, 0}, {.5, .25}, {.5, 0}}));
}

TEST(ObjReader, NormalsAreKeptAsWritten) {
    const ObjMesh mesh = read(std::string(SQUARE) + "vn 0 0 0\nvn nan 0 7\nf 1//1 2//2 3//1\n");
    EXPECT_EQ(mesh.normals[0], glm::vec3(0));
    EXPECT_TRUE(std::isnan(mesh.normals[1].x));
    EXPECT_EQ(indices(mesh.triangles[0].n), (std::vector<u32>{0, 1, 0}));
    EXPECT_EQ(mesh.notices, Names{});
}

TEST(ObjReader, NamesKeepInnerSpacesOnly) {
    const ObjMesh mesh = read(std::string(SQUARE) +
                              "mtllib  my lib.mtl other.mtl \t\no an  object \nusemtl red wood #2 \nf 1 2 3\n"
                              "mtllib b.mtl\ng group one\nf 1 2 3\n");
    ASSERT_EQ(mesh.libraries.size(), 2u);
    EXPECT_EQ(mesh.libraries[0].names, "my lib.mtl other.mtl");
    EXPECT_EQ(mesh.libraries[0].line, 5u);
    EXPECT_EQ(mesh.libraries[1].line, 9u);
    EXPECT_EQ(mesh.material_names, Names{"red wood #2"});
    EXPECT_EQ(mesh.object_names, (Names{"an  object", "group one"}));
}

TEST(ObjReader, MaterialsAndObjectsAreNumberedByFirstUse) {
    const ObjMesh mesh =
        read(std::string(SQUARE) + "f 1 2 3\nusemtl b\nusemtl a\no x\nf 1 2 3 4\nusemtl unused\nusemtl b\n"
                                   "g y\nf 1 2 3\nusemtl\ng x\nf 1 2 3\nusemtl a\nf 2 3 4\n");
    EXPECT_EQ(mesh.material_names, (Names{"", "a", "b"}));
    EXPECT_EQ(mesh.material_lines, (std::vector<size_t>{0, 7, 11}));
    EXPECT_EQ(mesh.object_names, (Names{"", "x", "y"}));
    std::vector<u32> materials, objects;
    for (const MeshTriangle& triangle : mesh.triangles) {
        materials.push_back(triangle.material);
        objects.push_back(triangle.object);
    }
    EXPECT_EQ(materials, (std::vector<u32>{0, 1, 1, 2, 0, 1}));
    EXPECT_EQ(objects, (std::vector<u32>{0, 1, 1, 2, 1, 1}));
    EXPECT_EQ(read(std::string(SQUARE) + "usemtl\nf 1 2 3\n").material_lines, std::vector<size_t>{0});
}

TEST(ObjReader, WhatIsLeftOutIsCountedInOneNoticeAKind) {
    const ObjMesh mesh =
        read(std::string(SQUARE) + "s 1\np 1\np 2\nl 1 2\ncstype bezier\ncurv 0 1 1 2\nfoo\nbar\nfoo\n"
                                   "f 1 2\nf\nf 1 2 3\nf 2\ns off\n");
    EXPECT_EQ(mesh.notices,
              (Names{"scene.obj:6: a point statement (p) is ignored (and 1 more)",
                     "scene.obj:8: a line statement (l) is ignored",
                     "scene.obj:9: a curve or surface statement is ignored (and 1 more)",
                     "scene.obj:11: the unknown statement 'foo' is ignored (and 2 more)",
                     "scene.obj:14: a face with fewer than three corners is left out (and 2 more)"}));
    EXPECT_EQ(mesh.dropped_faces, 3u);
    EXPECT_EQ(mesh.triangles.size(), 1u);
}

TEST(ObjReader, FacesWithNonFiniteVertexAreLeftOut) {
    const ObjMesh mesh =
        read(std::string(SQUARE) + "v nan 0 0\nv 0 -inf 0\nv 0 0 1e39\nv 1.#IND 0 0\nv 0 0 1e-99\n"
                                   "f 1 2 3\nf 1 2 5\nf 1 2 3 6\nf 7 2 3\nf 1 8 2\nf 1 9 3\n");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.dropped_faces, 4u);
    EXPECT_EQ(mesh.notices,
              Names{"scene.obj:11: a face with a vertex that is not finite is left out (and 3 more)"});
}

TEST(ObjReader, AttributeIndicesOutOfRangeAreLeftOut) {
    const ObjMesh mesh =
        read(std::string(SQUARE) + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1/2/1 2/1/1 3/-2/1\n"
                                   "f 1/1/0 2/1/1 3/1/1\nf 1/1/99999999999 2/1/1 3/1/1\n");
    ASSERT_EQ(mesh.triangles.size(), 4u);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(indices(mesh.triangles[i].t) == NONE, i == 1) << i;
        EXPECT_EQ(indices(mesh.triangles[i].n) == NONE, i >= 2) << i;
    }
    EXPECT_EQ(
        mesh.notices,
        (Names{"scene.obj:8: a texture coordinate (vt) whose index is out of range is left out (and 1 more)",
               "scene.obj:9: a normal (vn) whose index is out of range is left out (and 1 more)"}));
}

TEST(ObjReader, PositionIndicesOutOfRangeAreErrors) {
    const std::pair<const char*, const char*> cases[] = {
        {"0", "0"},
        {"5", "5"},
        {"-5", "-5"},
        {"2147483648", "'2147483648'"},
        {"-99999999999999999999/1", "'-99999999999999999999'"},
        {"2147483647", "'2147483647'"}};
    for (const auto& [index, found] : cases)
        EXPECT_EQ(error_of(SQUARE + std::string("f 1 2 3\n\nf 1 2 ") + index + "\n"),
                  std::string("scene.obj:7: expected a vertex index from 1 to 4 or from -4 to -1, found ") +
                      found);
    EXPECT_EQ(error_of(std::string("f 1 2 -1\n") + SQUARE),
              "scene.obj:1: expected a vertex index from 1 to 4, found -1");
    EXPECT_EQ(
        error_of("f 1 2 3\n"),
        "scene.obj:1: expected vertices (v) to make faces of, found none in the file but vertex index 1");
}

TEST(ObjReader, WhatIsNoNumberIsAnError) {
    const std::string corner = "expected a corner v, v/t, v//n or v/t/n with whole numbers after f, found ";
    const std::pair<const char*, std::string> cases[] = {
        {"v 1 2,5 3", "expected a number after v, found '2,5'"},
        {"v 1 2", "expected 3 numbers after v, found 2"},
        {"v # 1 2 3", "expected 3 numbers after v, found 0"},
        {"vn 1 0", "expected 3 numbers after vn, found 2"},
        {"vt", "expected 1 number after vt, found 0"},
        {"vt 1 x", "expected a number after vt, found 'x'"},
        {"f 1 2 a", corner + "'a'"},
        {"f 1 2 3.5", corner + "'3.5'"},
        {"f 1 2 /3", corner + "'/3'"},
        {"f 1 2 3/1/1/1", corner + "'3/1/1/1'"},
        {"f 1 2 3/x", corner + "'3/x'"},
        {"f 1 2 +-3", corner + "'+-3'"}};
    for (const auto& [line, message] : cases)
        EXPECT_EQ(error_of(std::string(SQUARE) + line + "\nf x\n"), "scene.obj:5: " + message);
}

TEST(ObjReader, FilesWithoutFacesAreErrors) {
    EXPECT_EQ(
        error_of(""),
        "scene.obj: the file has no faces (f) to render, only 0 vertices (v), 0 lines (l), 0 points (p), "
        "0 curve and surface statements and 0 unknown ones");
    EXPECT_EQ(
        error_of(std::string(SQUARE) + "l 1 2\nl 2 3\np 1\nx\n"),
        "scene.obj: the file has no faces (f) to render, only 4 vertices (v), 2 lines (l), 1 points (p), "
        "0 curve and surface statements and 1 unknown ones");
    EXPECT_EQ(error_of(std::string(SQUARE) + "v nan 0 0\nf 1 2\nf 1 2 5\n"),
              "scene.obj: the file has no faces that can be rendered: all 2 have fewer than three corners or "
              "a vertex "
              "that is not finite");
}

TEST(ObjReader, FilesThatCannotBeReadAreErrors) {
    EXPECT_THROW(read_scene_file(testing::TempDir() + "no_such_file.obj"), SceneError);
    EXPECT_THROW(read_scene_file(testing::TempDir()), SceneError);
}

TEST(ObjReader, NulBytesAreTextLikeAnyOther) {
    std::string text = std::string(SQUARE) + "o a_b\n# _\n_\nf 1 2 3\n";
    std::replace(text.begin(), text.end(), '_', '\0');
    const ObjMesh mesh = read(text);
    EXPECT_EQ(mesh.object_names, Names{std::string("a\0b", 3)});
    EXPECT_EQ(mesh.notices, Names{"scene.obj:7: the unknown statement '\\x00' is ignored"});
    text += std::string("v 1 2\0 3\n", 9);
    EXPECT_EQ(error_of(text), "scene.obj:9: expected a number after v, found '2\\x00'");
}

TEST(ObjReader, LongLinesAreRead) {
    std::ostringstream text, face;
    const int corners = 20000;
    for (int i = 0; i < corners; ++i) {
        text << "v " << 1e5 * std::cos(6.283185307 * i / corners) << ' '
             << 1e5 * std::sin(6.283185307 * i / corners) << " 0\n";
        face << ' ' << i + 1;
    }
    const std::string long_name(100000, 'n');
    const ObjMesh mesh = read("#" + long_name + "\n" + text.str() + "o " + long_name + "\nf" + face.str());
    EXPECT_EQ(mesh.triangles.size(), size_t(corners - 2));
    EXPECT_EQ(mesh.object_names, Names{long_name});
    EXPECT_LT(error_of("v " + long_name).size(), 200u);
}

TEST(ObjReader, PolygonCornersKeepTheirAttributes) {
    const ObjMesh mesh =
        read("v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\nvn 0 0 1\nvn 0 1 1\n"
             "vn 1 0 1\nvn 1 1 1\nf 1/4/2 2/3/1 3/2/4 4/1/3\n");
    ASSERT_EQ(mesh.triangles.size(), 2u);
    const u32 uv_of[] = {3, 2, 1, 0}, normal_of[] = {1, 0, 3, 2};
    for (const MeshTriangle& triangle : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(triangle.t[k], uv_of[triangle.v[k]]);
            EXPECT_EQ(triangle.n[k], normal_of[triangle.v[k]]);
        }
}

TEST(ObjReader, CornerWithoutAttributeSpoilsOnlyItsOwnTriangles) {
    const ObjMesh mesh = read("v 0 0 0\nv 3 0 0\nv 5 2 0\nv 0 2 0\nvn 0 0 1\nf 1 2//1 3//1 4//1\n");
    ASSERT_EQ(mesh.triangles.size(), 2u); // cut from corner 2 to corner 4
    EXPECT_NE(indices(mesh.triangles[0].n), NONE);
    EXPECT_EQ(indices(mesh.triangles[1].n), NONE);
}

TEST(ObjReader, FacesThatCannotBeCutProperlyAreReported) {
    const ObjMesh mesh = read(std::string(SQUARE) + "f 1 3 2 4\n");
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.notices,
              Names{"scene.obj:5: a face that folds or crosses itself, has no area or too many corners is "
                    "cut into triangles that may overlap"});
}

/// A text with some of everything, absolute and relative indices, and every line end.
std::string mixed_text(unsigned seed) {
    std::mt19937 random(seed);
    const auto below = [&](unsigned n) { return unsigned(random() % n); };
    const char* const ends[] = {"\n", "\r\n", "\r"};
    std::ostringstream text;
    unsigned positions = 0;
    for (int i = 0; i < 400; ++i) {
        const char* const end = ends[below(3)];
        const unsigned kind = positions < 5 ? 0 : below(16);
        if (kind < 4) {
            text << "v " << below(100) << " \\" << end << below(100) << ' ' << (below(60) ? "1" : "nan")
                 << end;
            ++positions;
        } else if (kind < 6)
            text << "vt 0." << below(100) << end << "vn 0 0." << below(100) << " 1" << end;
        else if (kind < 12) {
            text << 'f';
            for (unsigned c = 0, corners = 1 + below(7); c < corners; ++c) {
                const bool relative = below(2) == 0;
                text << ' ' << (relative ? "-" : "") << 1 + below(positions) << '/' << 1 + below(20) << "/-"
                     << 1 + below(20);
            }
            text << (below(5) ? "" : " # corners") << end;
        } else {
            const char* const others[] = {"usemtl m ", "o part ", "l 1 2 ", "unknown "};
            text << others[kind - 12] << below(4) << end;
        }
    }
    return text.str();
}

TEST(ObjReader, ResultDoesNotDependOnChunksOrThreads) {
    for (unsigned seed = 0; seed < 8; ++seed) {
        const std::string text = mixed_text(seed);
        const std::string expected = dump(read(text));
        for (const size_t chunk_bytes : {1, 16, 100, 1000})
            EXPECT_EQ(dump(read(text, chunk_bytes)), expected)
                << "seed " << seed << ", chunks of " << chunk_bytes;
        const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
        EXPECT_EQ(dump(read(text, 16)), expected) << "seed " << seed;
        for (const char* wrong : {"v 1 x 2", "f 1 2 9999", "f 1 2 9999999999"}) {
            const std::string bad = text + wrong + "\nf 1 2 0\n" + text;
            EXPECT_NE(error_of(bad), "");
            EXPECT_EQ(error_of(bad, 16), error_of(bad)) << wrong;
        }
    }
}

TEST(ObjReader, PositionsAreDoubles) {
    const ObjMesh mesh = read("v 5400552.8 -1e-3 3.0000000001\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions[0], glm::dvec3(5400552.8, -1e-3, 3.0000000001));
    EXPECT_EQ(
        error_of("v 1e39 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").find("not finite"),
        std::string("scene.obj: the file has no faces that can be rendered: all 1 have fewer than three "
                    "corners or a vertex that is ")
            .size());
}

TEST(ObjReader, ColoursBehindPositionsAreKept) {
    const std::string text =
        "v 0 0 0\nv 1 0 0 0.25 0.5 1\nv 1 1 0 1 # a weight\nv 0 1 0 1 0 0 0.5\nf 1 2 3 4\n";
    for (const size_t chunk_bytes : {OBJ_CHUNK_BYTES, size_t(1), size_t(20)}) {
        const ObjMesh mesh = read(text, chunk_bytes);
        ASSERT_EQ(mesh.colours.size(), 4u);
        EXPECT_TRUE(std::isnan(mesh.colours[0].x));
        EXPECT_EQ(mesh.colours[1], glm::vec3(0.25f, 0.5f, 1));
        EXPECT_TRUE(std::isnan(mesh.colours[2].x)) << "one number is a weight";
        EXPECT_EQ(mesh.colours[3], glm::vec3(1, 0, 0)) << "a fourth number is an opacity";
        EXPECT_EQ(mesh.first_colour_line, 2u);
    }
    EXPECT_TRUE(read(std::string(SQUARE) + "f 1 2 3 4\n").colours.empty());
}

TEST(ObjReader, SmoothingGroupsHoldUntilTheNextStatement) {
    const std::string text = std::string(SQUARE) +
                             "f 1 2 3\ns 1\nf 1 2 3\nf 1 2 3 4\ns off\nf 1 2 3\ns 7 # seven\n"
                             "f 1 2 3\ns 1\nf 1 2 3\ns 0\nf 1 2 3\n";
    for (const size_t chunk_bytes : {OBJ_CHUNK_BYTES, size_t(1), size_t(9)}) {
        const ObjMesh mesh = read(text, chunk_bytes);
        ASSERT_EQ(mesh.smoothing.size(), 8u);
        const u32 one = mesh.smoothing[1], seven = mesh.smoothing[5];
        EXPECT_NE(one, seven);
        EXPECT_EQ(mesh.smoothing,
                  (std::vector<u32>{NO_INDEX, one, one, one, NO_INDEX, seven, one, NO_INDEX}));
        EXPECT_EQ(mesh.first_normals_line, 7u);
        EXPECT_EQ(mesh.first_normals_triangle, 1u);
    }
    EXPECT_TRUE(read(std::string(SQUARE) + "s off\nf 1 2 3\ns 0\nf 1 2 3\n").smoothing.empty());
}

TEST(ObjReader, Utf16IsReadAsUtf8) {
    const std::string text = std::string(SQUARE) + "o \xc3\xa4\nf 1 2 3 4\n"; // a with two dots
    const auto utf16 = [](const std::string& characters, bool big, bool mark) {
        std::string bytes = !mark ? "" : big ? "\xfe\xff" : "\xff\xfe";
        for (const char c : characters)
            bytes += big ? std::string{'\0', c} : std::string{c, '\0'};
        return bytes;
    };
    const std::string expected = dump(read(text));
    for (const bool big : {false, true})
        for (const bool mark : {false, true}) {
            ObjMesh mesh = read(utf16(std::string(SQUARE) + "o \xe4\nf 1 2 3 4\n", big, mark));
            EXPECT_EQ(dump(mesh), expected) << big << mark;
        }
    EXPECT_EQ(error_of(utf16("v 0 0 0\nv 1 x 0\n", false, true)),
              "scene.obj:2: expected a number after v, found 'x'");
}

TEST(ObjReader, AMaterialLibraryIsNamed) {
    EXPECT_NE(error_of("# a library\nnewmtl red\nKd 1 0 0\n").find("it looks like a material library (MTL)"),
              std::string::npos);
}

} // namespace
} // namespace clrt
