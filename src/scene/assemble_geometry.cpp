// SPDX-License-Identifier: Apache-2.0
#include "scene/assemble_geometry.h"

#include "scene/lights.h"
#include "scene/vectors.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

constexpr size_t ELEMENTS_PER_TASK = 1 << 14; // elements per task: some hundred kilobytes

/// Runs f(i) for i in [0, n) on all threads.
template <typename F>
void for_each_index(size_t n, const F& f) {
    tbb::parallel_for(tbb::blocked_range<size_t>(0, n, ELEMENTS_PER_TASK),
                      [&](const tbb::blocked_range<size_t>& range) {
                          for (size_t i = range.begin(); i < range.end(); ++i)
                              f(i);
                      });
}

template <typename T>
void release(std::vector<T>& values) {
    std::vector<T>().swap(values);
}

Bounds empty_bounds() {
    const double most = std::numeric_limits<double>::max();
    return {glm::dvec3(most), glm::dvec3(-most)};
}

void extend(Bounds& bounds, const glm::dvec3& p) {
    bounds.low = glm::min(bounds.low, p);
    bounds.high = glm::max(bounds.high, p);
}

/// A normal as a unit vector; zero if it has no direction.
vec4 unit_normal(const glm::vec3& normal) {
    const double length = glm::length(glm::dvec3(normal));
    if (!std::isfinite(length) || length <= 0)
        return {0, 0, 0, 0};
    const glm::dvec3 unit = glm::dvec3(normal) / length;
    return {float(unit.x), float(unit.y), float(unit.z), 0};
}

/// The way of what goes from one place to another, from its start as the kernels have it; 0 for what stands
/// still and for what no triangle uses.
vec4 move_between(const vec4& start, const glm::dvec3& end, bool moves) {
    const glm::dvec3 move = end - to_dvec3(start);
    return moves && is_finite(move) ? to_vec4(move) : vec4{0, 0, 0, 0};
}

enum class Attribute { ABSENT, USABLE, BROKEN };

/// Whether a triangle's three indices of an attribute can be used; `usable(i)` tests one value.
template <typename F>
Attribute check_attribute(const u32 (&index)[3], const F& usable) {
    const auto given = std::count_if(index, index + 3, [](u32 i) { return i != NO_INDEX; });
    if (given == 0)
        return Attribute::ABSENT;
    return given == 3 && std::all_of(index, index + 3, usable) ? Attribute::USABLE : Attribute::BROKEN;
}

void note_count(NoticeList& notices, size_t count, const std::string& path, const char* what) {
    if (count)
        notices.add_line(fmt::format("{}: {} {}", path, count, what));
}

void assemble_uvs(std::vector<glm::vec2>& from, std::vector<float>& to) {
    to.resize(2 * from.size());
    for_each_index(from.size(), [&](size_t i) {
        to[2 * i] = from[i].x;
        to[2 * i + 1] = from[i].y;
    });
    release(from);
}

void assemble_vertices(Mesh& mesh, const Normalisation& frame, Scene& scene) {
    scene.positions.resize(mesh.positions.size());
    for_each_index(mesh.positions.size(), [&](size_t i) {
        const glm::dvec3 p = to_normalised(frame, mesh.positions[i]);
        // No triangle uses a position that is not finite; no kernel shall meet one.
        const bool finite = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        scene.positions[i] = finite ? vec4{float(p.x), float(p.y), float(p.z), 0} : vec4{0, 0, 0, 0};
    });
    if (!mesh.end_positions.empty()) {
        scene.position_moves.resize(mesh.positions.size());
        for_each_index(mesh.positions.size(), [&](size_t i) {
            scene.position_moves[i] =
                move_between(scene.positions[i], to_normalised(frame, mesh.end_positions[i]),
                             mesh.end_positions[i] != mesh.positions[i]);
        });
    }
    release(mesh.positions);
    release(mesh.end_positions);
    scene.normals.resize(mesh.normals.size());
    for_each_index(mesh.normals.size(), [&](size_t i) { scene.normals[i] = unit_normal(mesh.normals[i]); });
    if (!mesh.end_normals.empty()) {
        scene.normal_moves.resize(mesh.normals.size());
        for_each_index(mesh.normals.size(), [&](size_t i) {
            scene.normal_moves[i] = move_between(scene.normals[i], to_dvec3(unit_normal(mesh.end_normals[i])),
                                                 mesh.end_normals[i] != mesh.normals[i]);
        });
    }
    release(mesh.normals);
    release(mesh.end_normals);
    assemble_uvs(mesh.uvs, scene.uvs);
    assemble_uvs(mesh.second_uvs, scene.second_uvs);
    scene.vertex_colours = std::move(mesh.colours);
}

} // namespace

Bounds bounds_of_triangles(const Mesh& mesh) {
    if (mesh.triangles.empty())
        return {};
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, mesh.triangles.size(), ELEMENTS_PER_TASK), empty_bounds(),
        [&](const tbb::blocked_range<size_t>& range, Bounds bounds) {
            for (size_t i = range.begin(); i < range.end(); ++i)
                for (u32 v : mesh.triangles[i].v) {
                    extend(bounds, mesh.positions[v]);
                    if (!mesh.end_positions.empty())
                        extend(bounds, mesh.end_positions[v]);
                }
            return bounds;
        },
        [](const Bounds& a, const Bounds& b) {
            return Bounds{glm::min(a.low, b.low), glm::max(a.high, b.high)};
        });
}

void assemble_geometry(Mesh& mesh, const Bounds& bounds, const Normalisation& frame, const std::string& path,
                       Scene& scene, NoticeList& notices) {
    for (const glm::dvec3& corner : {to_normalised(frame, bounds.low), to_normalised(frame, bounds.high)})
        for (int c = 0; c < 3; ++c)
            scene.extent = std::max(scene.extent, float(std::fabs(corner[c])));
    assemble_vertices(mesh, frame, scene);

    std::atomic<size_t> broken_normals{0}, broken_uvs{0}, degenerate{0};
    scene.triangles.resize(mesh.triangles.size());
    for_each_index(mesh.triangles.size(), [&](size_t i) {
        const MeshTriangle& from = mesh.triangles[i];
        Triangle& to = scene.triangles[i];
        to = {from.v[0], from.v[1], from.v[2], NO_INDEX,      NO_INDEX, NO_INDEX,
              NO_INDEX,  NO_INDEX,  NO_INDEX,  from.material, NO_INDEX, from.object};
        const auto has_direction = [&](u32 n) { return !is_zero(scene.normals[n]); };
        const auto is_finite = [&](u32 t) {
            const auto has_pair = [t](const std::vector<float>& uvs) {
                return uvs.empty() || (std::isfinite(uvs[2 * t]) && std::isfinite(uvs[2 * t + 1]));
            };
            return has_pair(scene.uvs) && has_pair(scene.second_uvs);
        };
        const Attribute normals = check_attribute(from.n, has_direction),
                        uvs = check_attribute(from.t, is_finite);
        if (normals == Attribute::USABLE)
            to.n0 = from.n[0], to.n1 = from.n[1], to.n2 = from.n[2];
        if (uvs == Attribute::USABLE)
            to.t0 = from.t[0], to.t1 = from.t[1], to.t2 = from.t[2];
        broken_normals += normals == Attribute::BROKEN;
        broken_uvs += uvs == Attribute::BROKEN;
        degenerate +=
            triangle_area(scene.positions[to.v0], scene.positions[to.v1], scene.positions[to.v2]) <= 0;
    });
    release(mesh.triangles);
    if (mesh.first_normals_line && scene.triangles[mesh.first_normals_triangle].n0 != NO_INDEX)
        scene.first_smooth = {path, mesh.first_normals_line};

    scene.statistics.degenerate_triangles = degenerate;
    note_count(notices, degenerate, path,
               "triangles of zero area: they can only close seams and give no light");
    note_count(notices, broken_normals, path, "triangles with a zero, infinite or missing vn: shaded flat");
    note_count(notices, broken_uvs, path,
               "triangles with an infinite or missing vt: texture coordinates unused");
}

} // namespace clrt
