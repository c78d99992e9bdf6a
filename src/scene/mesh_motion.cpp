// SPDX-License-Identifier: Apache-2.0
#include "scene/mesh_motion.h"

#include "error.h"
#include "scene/smoothing.h"
#include "scene/vectors.h"

#include <algorithm>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <optional>
#include <set>

namespace clrt {
namespace {

/// A polygon of more triangles counts as another face where it is cut differently.
constexpr size_t MOST_CUTS = 4096;

/// Whether the same corners follow each other in the same order, wherever it begins.
bool is_turned(const MeshTriangle& a, const MeshTriangle& b) {
    const u32 twice[6] = {b.v[0], b.v[1], b.v[2], b.v[0], b.v[1], b.v[2]};
    return std::search(std::begin(twice), std::end(twice), std::begin(a.v), std::end(a.v)) != std::end(twice);
}

/// The end of the polygon that begins with triangle `first` in both meshes: behind the first triangles that
/// together have the same corners. Nothing if there is none.
std::optional<size_t> end_of_polygon(const Mesh& a, const Mesh& b, size_t first) {
    if (std::equal(std::begin(a.triangles[first].v), std::end(a.triangles[first].v), b.triangles[first].v))
        return first + 1; // also one without three different corners
    std::set<u32> of_a, of_b;
    const size_t last = std::min(a.triangles.size(), first + MOST_CUTS);
    for (size_t i = first; i < last; ++i) {
        of_a.insert(std::begin(a.triangles[i].v), std::end(a.triangles[i].v));
        of_b.insert(std::begin(b.triangles[i].v), std::end(b.triangles[i].v));
        // A polygon of n corners has n - 2 triangles; one triangle has a single cut.
        if (i == first && of_a == of_b && !is_turned(a.triangles[i], b.triangles[i]))
            return std::nullopt;
        if (of_a == of_b && of_a.size() == i + 1 - first + 2)
            return i + 1;
    }
    return std::nullopt;
}

void check_count(const MotionFiles& files, const char* what, size_t expected, size_t found) {
    if (expected != found)
        throw SceneError(
            files.end, 0,
            fmt::format("expected the {} {} of '{}', found {}", expected, what, files.start, found));
}

void check_topology(const MotionFiles& files, const Mesh& start, const Mesh& end) {
    check_count(files, "vertices", start.positions.size(), end.positions.size());
    check_count(files, "normals (vn)", start.normals.size(), end.normals.size());
    check_count(files, "triangles", start.triangles.size(), end.triangles.size());
    for (size_t i = 0; i < start.triangles.size();) {
        const std::optional<size_t> next = end_of_polygon(start, end, i);
        if (!next) {
            const auto [a, b, c] = start.triangles[i].v;
            const auto [d, e, f] = end.triangles[i].v;
            throw SceneError(
                files.end, 0,
                fmt::format("expected the faces of '{}', found another as triangle {}: vertices {}, {}, {} "
                            "instead of {}, {}, {}",
                            files.start, i + 1, d + 1, e + 1, f + 1, a + 1, b + 1, c + 1));
        }
        i = *next;
    }
}

/// Whether all three corners have normals with a direction in both meshes.
bool are_smooth(const u32 (&n)[3], const Mesh& start, const Mesh& end) {
    return std::all_of(std::begin(n), std::end(n), [&](u32 i) {
        return i != NO_INDEX && start.normals[i] != glm::vec3(0) && end.normals[i] != glm::vec3(0);
    });
}

/// Corner normals from smoothing groups, in both meshes under the same indices: a triangle that is smooth at
/// one end of the way is so on all of it.
void smooth_both(const MotionFiles& files, Mesh& start, Mesh& end, NoticeList& notices) {
    NoticeList unused;
    smooth_by_groups(start, files.start, notices);
    smooth_by_groups(end, files.end, unused);
    for (size_t i = 0; i < start.triangles.size(); ++i) {
        MeshTriangle& triangle = start.triangles[i];
        if (triangle.n[0] == NO_INDEX && triangle.n[1] == NO_INDEX && triangle.n[2] == NO_INDEX)
            std::copy_n(end.triangles[i].n, 3, triangle.n);
        else if (std::equal(std::begin(triangle.n), std::end(triangle.n), end.triangles[i].n))
            continue;
        if (!are_smooth(triangle.n, start, end))
            std::fill_n(triangle.n, 3, NO_INDEX);
    }
}

/// a + t (b - a), exactly a at 0 and where both are the same, b at 1.
template <class Vector, class Number>
std::vector<Vector> mix_all(const std::vector<Vector>& a, const std::vector<Vector>& b, Number t) {
    if (t == 0 || t == 1)
        return t == 0 ? a : b;
    std::vector<Vector> result(a.size());
    for (size_t i = 0; i < a.size(); ++i)
        result[i] = a[i] == b[i] ? a[i] : glm::mix(a[i], b[i], t);
    return result;
}

} // namespace

void add_motion(const MotionFiles& files, const glm::dvec2& shutter, Mesh& mesh, Mesh end,
                NoticeList& notices) {
    check_topology(files, mesh, end);
    end.triangles = mesh.triangles;
    end.smoothing = mesh.smoothing;
    smooth_both(files, mesh, end, notices);
    std::vector<glm::dvec3> open = mix_all(mesh.positions, end.positions, shutter.x);
    std::vector<glm::vec3> open_normals = mix_all(mesh.normals, end.normals, float(shutter.x));
    if (shutter.x != shutter.y) {
        mesh.end_positions = mix_all(mesh.positions, end.positions, shutter.y);
        mesh.end_normals = mix_all(mesh.normals, end.normals, float(shutter.y));
    }
    mesh.positions = std::move(open);
    mesh.normals = std::move(open_normals);
}

void finish_moves(const std::string& end_file, Scene& scene) {
    const auto all_zero = [](const std::vector<vec4>& moves) {
        return std::all_of(moves.begin(), moves.end(), is_zero);
    };
    if (all_zero(scene.position_moves) && all_zero(scene.normal_moves)) {
        scene.position_moves.clear();
        scene.normal_moves.clear();
        return;
    }
    scene.position_moves.resize(scene.positions.size());
    scene.normal_moves.resize(scene.normals.size());
    for (const Emitter& emitter : scene.emitters) {
        const Triangle& t = scene.triangles[emitter.triangle];
        if (is_zero(scene.position_moves[t.v0]) && is_zero(scene.position_moves[t.v1]) &&
            is_zero(scene.position_moves[t.v2]))
            continue;
        throw SceneError(
            end_file, 0,
            fmt::format("expected lamps that stand still while the shutter is open, found triangle {} "
                        "of the emissive material \"{}\" moving; --shutter 0,0 takes the picture of "
                        "one moment",
                        emitter.triangle + 1, scene.material_names[t.material]));
    }
}

} // namespace clrt
