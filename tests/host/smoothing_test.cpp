// SPDX-License-Identifier: Apache-2.0
#include "scene/smoothing.h"

#include "scene/readers/obj_reader.h"
#include "scene_support.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

namespace clrt {

namespace {

ObjMesh read(const std::string& text, NoticeList& notices) {
    Progress silent(Toggle::OFF, true);
    ObjMesh mesh = read_obj({"a.obj", text}, silent);
    smooth_by_groups(mesh, "a.obj", notices);
    return mesh;
}

ObjMesh read(const std::string& text) {
    NoticeList notices;
    return read(text, notices);
}

glm::vec3 normal(const ObjMesh& mesh, size_t triangle, int corner) {
    const u32 n = mesh.triangles[triangle].n[corner];
    return n == NO_INDEX ? glm::vec3(0) : mesh.normals[n];
}

const char* const CUBE =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n";
const char* const CUBE_FACES = "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

} // namespace

TEST(Smoothing, TheCornersOfACubeAreNormalsOfItsSphere) {
    // Three right angles at each corner: the cut of a face into triangles, which gives one corner two of 45
    // degrees, does not show.
    NoticeList notices;
    const ObjMesh mesh = read(std::string(CUBE) + "s 1\n" + CUBE_FACES, notices);
    ASSERT_EQ(mesh.triangles.size(), 12u);
    for (size_t t = 0; t < 12; ++t)
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 expected = glm::normalize(mesh.positions[mesh.triangles[t].v[k]]);
            EXPECT_LT(glm::distance(glm::dvec3(normal(mesh, t, k)), expected), 1e-7) << t << " " << k;
        }
    EXPECT_EQ(mesh.normals.size(), 8u) << "one for each vertex";
    EXPECT_TRUE(mesh.smoothing.empty());
    EXPECT_EQ(count_notices(notices, "12 triangles without vn are smooth"), 1);
}

TEST(Smoothing, GroupsDoNotMix) {
    // Each side of the cube is flat in a group of its own; two sides that share one are rounded at their
    // edge.
    NoticeList notices;
    const ObjMesh apart =
        read(std::string(CUBE) + "s 1\nf 1 4 3 2\ns 2\nf 5 6 7 8\ns 3\nf 1 2 6 5\n", notices);
    for (const MeshTriangle& triangle : apart.triangles)
        EXPECT_EQ(triangle.n[0], NO_INDEX) << "normals of a plane are left to the plane";
    EXPECT_TRUE(notices.lines().empty());
    const ObjMesh pair = read(std::string(CUBE) + "s 1\nf 5 6 7 8\ns 2\nf 1 4 3 2\ns 1\nf 1 2 6 5\n");
    const glm::vec3 edge(0, -std::sqrt(0.5f), std::sqrt(0.5f));
    EXPECT_LT(glm::distance(normal(pair, 0, 0), edge), 1e-6f) << "vertex 5, between +z and -y";
    EXPECT_EQ(pair.triangles[2].n[0], NO_INDEX);
}

TEST(Smoothing, WithoutGroupsAndWithVnNothingChanges) {
    for (const char* before : {"", "s off\n", "s 0\n"})
        EXPECT_TRUE(read(std::string(CUBE) + before + CUBE_FACES).normals.empty());
    const ObjMesh given = read(std::string(CUBE) + "vn 0 0 1\ns 1\nf 5//1 6//1 7//1 8//1\nf 1 2 6 5\n");
    EXPECT_EQ(normal(given, 0, 0), glm::vec3(0, 0, 1));
    EXPECT_EQ(given.triangles[2].n[0], NO_INDEX) << "a side with vn is no neighbour to smooth with";
}

TEST(Smoothing, SidesThatCancelStayFlat) {
    // A sheet whose two sides are faces of one group: their normals sum to nothing.
    const ObjMesh sheet = read("v 0 0 0.1\nv 1 0 0.2\nv 0.3 1 0.7\ns 1\nf 1 2 3\nf 3 2 1\n");
    for (const MeshTriangle& triangle : sheet.triangles)
        EXPECT_EQ(triangle.n[0], NO_INDEX);
    // Faces without area have no normal to give.
    const ObjMesh needle = read(std::string(CUBE) + "s 1\n" + CUBE_FACES + "f 1 2 2\n");
    EXPECT_EQ(needle.triangles[12].n[0], NO_INDEX);
    EXPECT_LT(glm::distance(normal(needle, 0, 0), glm::vec3(-std::sqrt(1 / 3.f))), 1e-6f);
}

TEST(Smoothing, NeitherThreadsNorPlaceChangeTheNormals) {
    // A bumpy grid, near the origin and 2^23 away: its coordinates are multiples of 2^-10.
    const auto grid = [](double offset) {
        std::string text = "s 1\n";
        for (int y = 0; y < 40; ++y)
            for (int x = 0; x < 40; ++x)
                text += "v " + std::to_string(x + offset) + " " + std::to_string(y - offset) + " " +
                        std::to_string((x * 37 + y * 91) % 64 / 64.0) + "\n";
        for (int y = 0; y < 39; ++y)
            for (int x = 0; x < 39; ++x) {
                const int i = 40 * y + x + 1;
                text += "f " + std::to_string(i) + " " + std::to_string(i + 1) + " " +
                        std::to_string(i + 41) + " " + std::to_string(i + 40) + "\n";
            }
        return text;
    };
    const ObjMesh mesh = read(grid(0));
    EXPECT_EQ(mesh.normals, read(grid(8388608)).normals);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(mesh.normals, read(grid(0)).normals);
}

} // namespace clrt
