// SPDX-License-Identifier: Apache-2.0
#include "scene/smoothing.h"

#include <atomic>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tuple>

namespace clrt {

namespace {

/// A sum shorter than this share of its weights has cancelled: what is left is rounding.
constexpr double LEAST_SUM = 1e-6;

/// Corner normals that differ from the triangle's by less (1 - cosine, 0.002 degrees) are its own: a flat
/// face.
constexpr double FLAT = 1e-9;

/// A corner of a triangle that is to be smoothed.
struct SmoothCorner {
    u32 vertex, group;
    std::uint64_t corner; ///< three times the triangle plus 0..2

    auto key() const { return std::tie(vertex, group, corner); }
    bool shares_normal(const SmoothCorner& other) const {
        return vertex == other.vertex && group == other.group;
    }
};

std::vector<SmoothCorner> find_corners(const Mesh& mesh) {
    std::vector<SmoothCorner> corners;
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
        if (mesh.smoothing[t] != NO_INDEX && mesh.triangles[t].n[0] == NO_INDEX)
            for (u32 k = 0; k < 3; ++k)
                corners.push_back({mesh.triangles[t].v[k], mesh.smoothing[t], 3 * std::uint64_t(t) + k});
    // The corner itself is the last key: sums do not depend on threads.
    tbb::parallel_sort(corners.begin(), corners.end(),
                       [](const SmoothCorner& a, const SmoothCorner& b) { return a.key() < b.key(); });
    return corners;
}

/// Where each run of corners with one normal starts, and the end of the last.
std::vector<size_t> find_runs(const std::vector<SmoothCorner>& corners) {
    std::vector<size_t> starts;
    for (size_t i = 0; i < corners.size(); ++i)
        if (i == 0 || !corners[i].shares_normal(corners[i - 1]))
            starts.push_back(i);
    starts.push_back(corners.size());
    return starts;
}

/// Cross product of the edges that leave a corner; its direction is the triangle's normal.
glm::dvec3 cross_at(const Mesh& mesh, const MeshTriangle& triangle, u32 k, double& angle) {
    const glm::dvec3& p = mesh.positions[triangle.v[k]];
    const glm::dvec3 to_next = mesh.positions[triangle.v[(k + 1) % 3]] - p,
                     to_last = mesh.positions[triangle.v[(k + 2) % 3]] - p;
    const glm::dvec3 cross = glm::cross(to_next, to_last);
    angle = std::atan2(glm::length(cross), glm::dot(to_next, to_last));
    return cross;
}

/// The normal that the corners [begin, end) share, of unit length; 0 where it cancels.
glm::dvec3 shared_normal(const Mesh& mesh, const SmoothCorner* begin, const SmoothCorner* end) {
    glm::dvec3 sum(0);
    double weights = 0;
    for (const SmoothCorner* at = begin; at != end; ++at) {
        double angle = 0;
        const glm::dvec3 cross = cross_at(mesh, mesh.triangles[at->corner / 3], u32(at->corner % 3), angle);
        const double length = glm::length(cross);
        if (!(length > 0))
            continue;
        sum += cross * (angle / length);
        weights += angle;
    }
    const double length = glm::length(sum);
    return length > LEAST_SUM * weights ? sum / length : glm::dvec3(0);
}

/// False where a corner has no normal, or where the corners describe nothing but the plane.
bool is_smooth(const Mesh& mesh, const MeshTriangle& triangle) {
    double angle = 0;
    const glm::dvec3 cross = cross_at(mesh, triangle, 0, angle);
    const double length = glm::length(cross);
    bool differs = false;
    for (const u32 n : triangle.n) {
        const glm::dvec3 normal(mesh.normals[n]);
        if (normal == glm::dvec3(0))
            return false;
        differs |= !(glm::dot(normal, cross) >= (1 - FLAT) * length);
    }
    return differs && length > 0;
}

} // namespace

void smooth_by_groups(Mesh& mesh, const std::string& path, NoticeList& notices) {
    if (mesh.smoothing.empty())
        return;
    const std::vector<SmoothCorner> corners = find_corners(mesh);
    mesh.smoothing = {};
    const std::vector<size_t> runs = find_runs(corners);
    const size_t first = mesh.normals.size();
    mesh.normals.resize(first + runs.size() - 1);
    tbb::parallel_for(size_t(0), runs.size() - 1, [&](size_t run) {
        mesh.normals[first + run] =
            glm::vec3(shared_normal(mesh, &corners[runs[run]], &corners[0] + runs[run + 1]));
        for (size_t i = runs[run]; i < runs[run + 1]; ++i)
            mesh.triangles[corners[i].corner / 3].n[corners[i].corner % 3] = u32(first + run);
    });
    std::atomic<size_t> smoothed{0};
    tbb::parallel_for(size_t(0), mesh.triangles.size(), [&](size_t t) {
        MeshTriangle& triangle = mesh.triangles[t];
        if (triangle.n[0] == NO_INDEX || triangle.n[0] < first)
            return;
        if (is_smooth(mesh, triangle))
            ++smoothed;
        else
            triangle.n[0] = triangle.n[1] = triangle.n[2] = NO_INDEX;
    });
    if (smoothed)
        notices.add_line(fmt::format("{}: {} triangles without vn are smooth by their smoothing groups (s)",
                                     path, smoothed.load()));
}

} // namespace clrt
