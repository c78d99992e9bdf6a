// SPDX-License-Identifier: Apache-2.0
#include "scene/free_way.h"

#include "scene/triangle_corners.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

/// The distance of the hit (Moeller and Trumbore 1997), infinite without one.
double hit_distance(const glm::dvec3& from, const glm::dvec3& direction, const glm::dvec3& a,
                    const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 e1 = b - a, e2 = c - a, across = glm::cross(direction, e2), way = from - a;
    const double determinant = glm::dot(e1, across);
    if (determinant == 0)
        return INFINITY;
    const double u = glm::dot(way, across) / determinant;
    const glm::dvec3 q = glm::cross(way, e1);
    const double v = glm::dot(direction, q) / determinant, t = glm::dot(e2, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : INFINITY;
}

glm::dvec3 corner(const Scene& scene, u32 index) {
    const vec4& p = scene.positions[index];
    return {p.x, p.y, p.z};
}

} // namespace

std::vector<double> free_ways(const Scene& scene, const glm::dvec3& from,
                              const std::vector<glm::dvec3>& directions) {
    using Ways = std::vector<double>;
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, scene.triangles.size(), TRIANGLE_GRAIN),
        Ways(directions.size(), INFINITY),
        [&](const tbb::blocked_range<size_t>& range, Ways ways) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const Triangle& t = scene.triangles[i];
                const glm::dvec3 a = corner(scene, t.v0), b = corner(scene, t.v1), c = corner(scene, t.v2);
                for (size_t k = 0; k < ways.size(); ++k)
                    ways[k] = std::min(ways[k], hit_distance(from, directions[k], a, b, c));
            }
            return ways;
        },
        [](Ways a, const Ways& b) {
            for (size_t k = 0; k < a.size(); ++k)
                a[k] = std::min(a[k], b[k]);
            return a;
        });
}

} // namespace clrt
