// SPDX-License-Identifier: Apache-2.0
// Faces -> OBJ text. Numbers have nine digits, so that every float is written exactly.
#include "probes/scene_builder.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace clrt {

namespace {

/// Corners of an icosahedron of radius 1 (golden rectangles), and its faces seen from outside.
std::vector<TestTriangle> icosahedron() {
    const double g = (1 + std::sqrt(5.0)) / 2;
    const glm::dvec3 corners[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                    {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                    {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    const int faces[20][3] = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                              {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                              {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                              {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    std::vector<TestTriangle> triangles;
    for (const auto& face : faces)
        triangles.push_back({{glm::normalize(corners[face[0]]), glm::normalize(corners[face[1]]),
                              glm::normalize(corners[face[2]])}});
    return triangles;
}

std::vector<TestTriangle> subdivided(const std::vector<TestTriangle>& triangles) {
    std::vector<TestTriangle> result;
    for (const TestTriangle& t : triangles) {
        const auto& [a, b, c] = t.corners;
        const glm::dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
        result.push_back({{a, ab, ca}});
        result.push_back({{ab, b, bc}});
        result.push_back({{ca, bc, c}});
        result.push_back({{ab, bc, ca}});
    }
    return result;
}

} // namespace

std::vector<TestTriangle> icosphere_triangles(const glm::dvec3& centre, double radius, int subdivisions) {
    std::vector<TestTriangle> triangles = icosahedron();
    for (int i = 0; i < subdivisions; ++i)
        triangles = subdivided(triangles);
    for (TestTriangle& triangle : triangles)
        for (glm::dvec3& corner : triangle.corners)
            corner = centre + radius * corner;
    return triangles;
}

void SceneBuilder::vertex(const glm::dvec3& position) {
    statements_.push_back({"", true, position});
    ++vertices_;
}

void SceneBuilder::line(const std::string& text) {
    statements_.push_back({text, false, {}});
}

void SceneBuilder::face(size_t first_vertex, size_t count, bool textured) {
    std::string text = "f";
    for (size_t i = 0; i < count; ++i)
        text += textured ? fmt::format(" {}/{}", first_vertex + i, uvs_ - count + i + 1)
                         : fmt::format(" {}", first_vertex + i);
    line(text);
}

SceneBuilder& SceneBuilder::header(const std::string& lines) {
    mtl_ = lines + mtl_;
    return *this;
}

SceneBuilder& SceneBuilder::material(const std::string& name, const std::string& keys) {
    mtl_ += "newmtl " + name + "\n" + keys + "\n\n";
    return *this;
}

SceneBuilder& SceneBuilder::use(const std::string& name) {
    line("usemtl " + name);
    return *this;
}

SceneBuilder& SceneBuilder::polygon(const std::vector<glm::dvec3>& corners) {
    for (const glm::dvec3& corner : corners)
        vertex(corner);
    face(vertices_ - corners.size() + 1, corners.size(), false);
    return *this;
}

SceneBuilder& SceneBuilder::textured_quad(const std::vector<glm::dvec3>& corners) {
    for (const glm::dvec3& corner : corners)
        vertex(corner);
    for (const char* uv : {"0 0", "1 0", "1 1", "0 1"}) {
        line(std::string("vt ") + uv);
        ++uvs_;
    }
    face(vertices_ - 3, 4, true);
    return *this;
}

SceneBuilder& SceneBuilder::floor(double half_size, double height) {
    const double s = half_size;
    return polygon({{-s, height, s}, {s, height, s}, {s, height, -s}, {-s, height, -s}});
}

SceneBuilder& SceneBuilder::box(const glm::dvec3& low, const glm::dvec3& high, Facing facing) {
    // Corner i has the upper x, y, z where bits 0, 1, 2 of i are set; faces are listed from outside.
    const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                             {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const auto& face_corners : faces) {
        std::vector<glm::dvec3> corners;
        for (const int i : face_corners)
            corners.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
        if (facing == Facing::INWARD)
            std::swap(corners[1], corners[3]);
        polygon(corners);
    }
    return *this;
}

SceneBuilder& SceneBuilder::icosphere(const glm::dvec3& centre, double radius, int subdivisions,
                                      Facing facing, Shading shading) {
    const double side = facing == Facing::OUTWARD ? 1 : -1;
    for (const TestTriangle& triangle : icosphere_triangles(centre, radius, subdivisions)) {
        const glm::dvec3 corners[3] = {triangle.corners[0],
                                       triangle.corners[facing == Facing::OUTWARD ? 1 : 2],
                                       triangle.corners[facing == Facing::OUTWARD ? 2 : 1]};
        for (const glm::dvec3& corner : corners)
            vertex(corner);
        if (shading == Shading::FLAT) {
            face(vertices_ - 2, 3, false);
            continue;
        }
        for (const glm::dvec3& corner : corners) {
            const glm::dvec3 n = side * (corner - centre) / radius;
            line(fmt::format("vn {:.9g} {:.9g} {:.9g}", n.x, n.y, n.z));
            ++normals_;
        }
        line(fmt::format("f {}//{} {}//{} {}//{}", vertices_ - 2, normals_ - 2, vertices_ - 1, normals_ - 1,
                         vertices_, normals_));
    }
    return *this;
}

SceneBuilder& SceneBuilder::raw(const std::string& text) {
    line(text);
    return *this;
}

std::string SceneBuilder::obj(const std::string& library, double scale) const {
    std::string text = "mtllib " + library + "\n";
    for (const Statement& statement : statements_) {
        const glm::dvec3 p = glm::dvec3(glm::vec3(statement.position)) * scale; // exact for powers of two
        text += statement.is_position ? fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z)
                                      : statement.text + "\n";
    }
    return text;
}

} // namespace clrt
