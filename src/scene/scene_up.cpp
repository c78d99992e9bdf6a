// SPDX-License-Identifier: Apache-2.0
#include "scene/scene_up.h"

#include "scene/triangle_corners.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <vector>

namespace clrt {
namespace {

/// Of the box's size: how near to a face points are that a thing stands on.
constexpr double TOUCHING = 0.005;
/// Slices of a face, in each of which the ends of the touching points are kept.
constexpr int SLICES = 64;
/// Share of a face that a foot covers at least: for sure, and to be worth a hint.
constexpr double WELL = 0.2, SOMEHOW = 0.1;
/// Of how much better it stands on the lowest z than on the highest: so much may differ along x and y.
constexpr double EVEN = 0.25;
/// Of how well it stands on the lowest z: so well it may stand on the lowest y for a hint.
constexpr double LESS = 0.75;
/// Radii of the scene from the origin, from which on coordinates are those of a map.
constexpr double MAP_DISTANCE = 100;

/// Ends of the points in each slice of a face.
struct Outline {
    std::array<double, SLICES> low, high;

    Outline() {
        low.fill(std::numeric_limits<double>::max());
        high.fill(std::numeric_limits<double>::lowest());
    }
    void add(const glm::dvec2& p) { // both from 0 to 1
        const auto slice = size_t(std::min(int(p.x * SLICES), SLICES - 1));
        low[slice] = std::min(low[slice], p.y);
        high[slice] = std::max(high[slice], p.y);
    }
    void add(const Outline& other) {
        for (size_t i = 0; i < SLICES; ++i) {
            low[i] = std::min(low[i], other.low[i]);
            high[i] = std::max(high[i], other.high[i]);
        }
    }
};

/// What one pass over the triangles finds.
struct Touching {
    std::array<Outline, 6> sides;
    glm::dvec3 moment{0}; ///< sum of area times centre
    double area = 0;
};

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// One side of a convex hull of points in order (Andrew 1979).
void add_chain(std::vector<glm::dvec2>& chain, const glm::dvec2& p, size_t first) {
    while (chain.size() >= first + 2 && cross(chain.back() - chain[chain.size() - 2], p - chain.back()) <= 0)
        chain.pop_back();
    chain.push_back(p);
}

/// The hull of an outline, counterclockwise: slices stand for their left ends below and above the diagonal.
std::vector<glm::dvec2> hull(const Outline& outline) {
    std::vector<glm::dvec2> points;
    for (size_t i = 0; i < SLICES; ++i)
        if (outline.low[i] <= outline.high[i])
            // A slice reaches to both of its ends: exact for things that do, a 64th too wide for others.
            for (const double x : {double(i) / SLICES, double(i + 1) / SLICES}) {
                points.emplace_back(x, outline.low[i]);
                points.emplace_back(x, outline.high[i]);
            }
    std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x < b.x || (a.x == b.x && a.y < b.y);
    });
    std::vector<glm::dvec2> chain;
    for (const glm::dvec2& p : points)
        add_chain(chain, p, 0);
    const size_t lower = chain.empty() ? 0 : chain.size() - 1;
    for (auto p = points.rbegin(); p != points.rend(); ++p)
        add_chain(chain, *p, lower);
    if (!chain.empty())
        chain.pop_back();
    return chain;
}

/// The area of a hull, 0 where it does not hold `centre`.
double area_under(const std::vector<glm::dvec2>& corners, const glm::dvec2& centre) {
    double twice = 0;
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec2 a = corners[i], b = corners[(i + 1) % corners.size()];
        if (cross(b - a, centre - a) < 0)
            return 0;
        twice += cross(a, b);
    }
    return twice / 2;
}

Touching measure_touching(const Mesh& mesh, const Bounds& bounds) {
    const glm::dvec3 size = bounds.high - bounds.low, inverse = 1. / size;
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, mesh.triangles.size(), TRIANGLE_GRAIN), Touching(),
        [&](const tbb::blocked_range<size_t>& range, Touching t) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                glm::dvec3 p[3];
                for (int c = 0; c < 3; ++c) {
                    p[c] = (mesh.positions[mesh.triangles[i].v[c]] - bounds.low) * inverse;
                    for (int axis = 0; axis < 3; ++axis) {
                        const glm::dvec2 on_face(p[c][(axis + 1) % 3], p[c][(axis + 2) % 3]);
                        if (p[c][axis] <= TOUCHING)
                            t.sides[size_t(2 * axis)].add(on_face);
                        if (p[c][axis] >= 1 - TOUCHING)
                            t.sides[size_t(2 * axis + 1)].add(on_face);
                    }
                }
                const double area = glm::length(glm::cross((p[1] - p[0]) * size, (p[2] - p[0]) * size)) / 2;
                t.moment += area / 3 * (p[0] + p[1] + p[2]);
                t.area += area;
            }
            return t;
        },
        [](Touching a, const Touching& b) {
            for (size_t s = 0; s < a.sides.size(); ++s)
                a.sides[s].add(b.sides[s]);
            a.moment += b.moment;
            a.area += b.area;
            return a;
        });
}

/// Whether the surface in the lowest z is seen from below: that of a floor, or of the back of a room, is not.
bool faces_down(const Mesh& mesh, const Bounds& bounds) {
    const double top = bounds.low.z + TOUCHING * (bounds.high.z - bounds.low.z);
    double down = 0; // twice the area
    for (const MeshTriangle& t : mesh.triangles) {
        const glm::dvec3 &a = mesh.positions[t.v[0]], &b = mesh.positions[t.v[1]],
                         &c = mesh.positions[t.v[2]];
        if (a.z <= top && b.z <= top && c.z <= top)
            down -= glm::cross(b - a, c - a).z;
    }
    return down > 0;
}

bool has_map_coordinates(const Bounds& bounds) {
    const glm::dvec3 centre = bounds.centre();
    const double far = MAP_DISTANCE * bounds.radius();
    return std::fabs(centre.x) > far && std::fabs(centre.y) > far && std::fabs(centre.z) < far;
}

} // namespace

Footing measure_footing(const Mesh& mesh, const Bounds& bounds) {
    Footing footing{};
    const glm::dvec3 size = bounds.high - bounds.low;
    if (!(size.x > 0 && size.y > 0 && size.z > 0))
        return footing;
    const Touching touching = measure_touching(mesh, bounds);
    if (!(touching.area > 0))
        return footing;
    const glm::dvec3 centre = touching.moment / touching.area;
    for (size_t s = 0; s < footing.size(); ++s) {
        const int axis = int(s) / 2;
        footing[s] = area_under(hull(touching.sides[s]), {centre[(axis + 1) % 3], centre[(axis + 2) % 3]});
    }
    return footing;
}

FoundUp find_up(const Mesh& mesh, const Bounds& bounds, const std::string& z_up_reason) {
    if (!z_up_reason.empty())
        return {true, true, z_up_reason};
    if (has_map_coordinates(bounds))
        return {true, true, "its coordinates are those of a map"};
    const Footing footing = measure_footing(mesh, bounds);
    const auto better_below = [&](size_t axis) { return footing[2 * axis] - footing[2 * axis + 1]; };
    const double z = better_below(2),
                 beside = std::max(std::fabs(better_below(0)), std::fabs(better_below(1)));
    const double foot = footing[4], on_y = footing[2];
    if (z >= WELL && beside <= EVEN * z && (on_y <= EVEN * foot || faces_down(mesh, bounds)))
        return {true, true, "it stands best on its lowest z"};
    if (z >= SOMEHOW && on_y <= LESS * foot)
        return {true, false, "it stands on its lowest z, and on its lowest y less"};
    return {};
}

} // namespace clrt
