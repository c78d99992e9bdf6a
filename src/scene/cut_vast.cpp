// SPDX-License-Identifier: Apache-2.0
#include "scene/cut_vast.h"

#include "scene/triangle_corners.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <xxhash.h>

namespace clrt {

namespace {

/// A triangle is vast from this many times the size of, and the way to, something small. Rays leave a
/// triangle by u (4 M + 24 E) of its place M and extent E (surface_offset_bound): 1024 makes that 1.5e-3 of
/// the small one. Rooms with small things keep most of their walls whole: cutting those costs time and shows
/// nothing.
constexpr double VAST = 1024;

/// Below this share of a triangle's largest coordinate its extent adds little to that bound.
constexpr double LEAST_EXTENT = 0.125;

/// Pieces of such an extent, and triangles that share an edge with them, may be cut.
constexpr double LEAST_LISTED = LEAST_EXTENT / 4;

/// Pieces at most: a field of grass does not cut its ground at every blade.
constexpr size_t MOST_ADDED = size_t(1) << 15;

/// Something small: triangles of about one size in one place.
struct Site {
    glm::dvec3 place;
    double size;
};
using Sites = std::shared_ptr<const std::vector<Site>>;

double largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

double extent_of(const TriangleCorners& c) {
    return largest(glm::max(c.p[0], glm::max(c.p[1], c.p[2])) - glm::min(c.p[0], glm::min(c.p[1], c.p[2])));
}

double place_of(const TriangleCorners& c) {
    return largest(glm::max(glm::abs(c.p[0]), glm::max(glm::abs(c.p[1]), glm::abs(c.p[2]))));
}

double distance(const glm::dvec3& point, const TriangleCorners& c) {
    const glm::dvec3 normal = glm::cross(c.p[1] - c.p[0], c.p[2] - c.p[0]);
    double nearest = INFINITY;
    bool inside = glm::dot(normal, normal) > 0;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 edge = c.p[(k + 1) % 3] - c.p[k], way = point - c.p[k];
        inside = inside && glm::dot(glm::cross(edge, way), normal) >= 0;
        const double length = glm::dot(edge, edge);
        const double along = length > 0 ? std::clamp(glm::dot(way, edge) / length, 0.0, 1.0) : 0;
        nearest = std::min(nearest, glm::length(way - along * edge));
    }
    return inside ? std::abs(glm::dot(point - c.p[0], glm::normalize(normal))) : nearest;
}

/// One site for each cell of the grid of its size; none for triangles that are larger than `most`.
Sites find_sites(const Scene& scene, double most) {
    std::unordered_set<std::uint64_t> cells; // by hash: two that are taken for one are no loss
    std::uint64_t last = 0;
    auto sites = std::make_shared<std::vector<Site>>();
    for (const Triangle& triangle : scene.triangles) {
        const TriangleCorners c = corners_of(scene.positions, triangle);
        const double size = extent_of(c);
        if (!(size > 0 && size < most))
            continue;
        const int exponent = std::ilogb(size);
        // Cells of four times the size.
        const glm::dvec3 cell = glm::floor(c.p[0] * std::ldexp(0.25, -exponent));
        const double words[] = {cell.x, cell.y, cell.z, double(exponent)};
        const std::uint64_t key = XXH3_64bits(words, sizeof words);
        if (key == last || !cells.insert(key).second)
            continue;
        last = key;
        sites->push_back({c.p[0], size});
    }
    return sites;
}

/// Triangles by their edges, as far as they may be cut.
class Cutter {
public:
    explicit Cutter(Scene& scene) : scene_(scene) {}

    CutTriangles run() {
        const Sites sites = find_sites(scene_, largest_extent() / VAST);
        if (sites->empty())
            return {};
        for (u32 t = 0; t < scene_.triangles.size(); ++t) {
            const TriangleCorners c = corners_of(scene_.positions, scene_.triangles[t]);
            if (extent_of(c) >= LEAST_LISTED * place_of(c))
                list(t);
        }
        for (auto& [t, listed] : triangles_) {
            waiting_.push_back(t);
            listed = sites;
        }
        std::sort(waiting_.begin(), waiting_.end());
        const size_t before = scene_.triangles.size();
        while (!waiting_.empty() && scene_.triangles.size() < before + MOST_ADDED) {
            const u32 t = waiting_.front();
            waiting_.pop_front();
            if (is_vast(t))
                cut(t);
        }
        return {cut_.size(), scene_.triangles.size() - before};
    }

private:
    using Edge = std::pair<u32, u32>;

    /// Of the triangles that may be vast.
    double largest_extent() const {
        double most = 0;
        for (const Triangle& triangle : scene_.triangles) {
            const TriangleCorners c = corners_of(scene_.positions, triangle);
            if (const double extent = extent_of(c); extent >= LEAST_EXTENT * place_of(c))
                most = std::max(most, extent);
        }
        return most;
    }

    /// The same number for corners at the same place.
    u32 corner(u32 position) {
        const vec4& p = scene_.positions[position];
        return places_.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, position).first->second;
    }
    Edge edge(const Triangle& t, int k) {
        const u32 v[3] = {t.v0, t.v1, t.v2};
        const u32 a = corner(v[k]), b = corner(v[(k + 1) % 3]);
        return {std::min(a, b), std::max(a, b)};
    }

    /// Notes a triangle's edges; one with equal corners has none, it is hit nowhere.
    void list(u32 t) {
        const Triangle& triangle = scene_.triangles[t];
        for (int k = 0; k < 3; ++k)
            if (edge(triangle, k).first == edge(triangle, k).second)
                return;
        for (int k = 0; k < 3; ++k)
            by_edge_[edge(triangle, k)].push_back(t);
        triangles_[t];
    }

    /// Keeps the sites beside which the triangle is vast: its pieces are vast beside no others.
    bool is_vast(u32 t) {
        const TriangleCorners c = corners_of(scene_.positions, scene_.triangles[t]);
        const double extent = extent_of(c);
        if (!(extent >= LEAST_EXTENT * place_of(c)))
            return false;
        auto kept = std::make_shared<std::vector<Site>>();
        for (const Site& site : *triangles_[t])
            if (extent > VAST * site.size && extent > VAST * (site.size + distance(site.place, c)))
                kept->push_back(site);
        triangles_[t] = kept;
        return !kept->empty();
    }

    /// The longest edge; of equal ones the same for every triangle.
    int longest_edge(u32 t) {
        const Triangle& triangle = scene_.triangles[t];
        int longest = 0;
        std::tuple<double, Edge> length{-1, {}};
        for (int k = 0; k < 3; ++k) {
            const Edge e = edge(triangle, k);
            const glm::dvec3 way = to_dvec3(scene_.positions[e.second]) - to_dvec3(scene_.positions[e.first]);
            const std::tuple<double, Edge> found{glm::dot(way, way), e};
            if (found > length) {
                length = found;
                longest = k;
            }
        }
        return longest;
    }

    bool moves(u32 position) const {
        return position < scene_.position_moves.size() && !is_zero(scene_.position_moves[position]);
    }

    /// True if texture coordinates and normals at the middle of an edge follow from those at its ends, and
    /// nothing moves there.
    bool can_be_cut(u32 t) const {
        const Triangle& triangle = scene_.triangles[t];
        if (moves(triangle.v0) || moves(triangle.v1) || moves(triangle.v2))
            return false;
        if (triangle.n0 == NO_INDEX)
            return true;
        const auto normal = [&](u32 n) { return to_dvec3(scene_.normals[n]); };
        return normal(triangle.n0) == normal(triangle.n1) && normal(triangle.n0) == normal(triangle.n2);
    }

    bool has_corner_at(const Triangle& t, const vec4& place) const {
        const auto is_there = [&](u32 v) { return to_dvec3(scene_.positions[v]) == to_dvec3(place); };
        return is_there(t.v0) || is_there(t.v1) || is_there(t.v2);
    }

    /// Cuts the triangle's longest edge after those of neighbours that have a longer one. False where one
    /// cannot be cut.
    bool cut(u32 t) {
        const Edge e = edge(scene_.triangles[t], longest_edge(t));
        for (;;) {
            const std::vector<u32> sharing = by_edge_[e];
            if (!std::all_of(sharing.begin(), sharing.end(), [&](u32 s) { return can_be_cut(s); }))
                return false;
            const auto longer = std::find_if(sharing.begin(), sharing.end(), [&](u32 s) {
                return edge(scene_.triangles[s], longest_edge(s)) != e;
            });
            if (longer == sharing.end())
                break;
            if (!cut(*longer))
                return false;
        }
        const vec4 a = scene_.positions[e.first], b = scene_.positions[e.second];
        const glm::dvec3 middle = (to_dvec3(a) + to_dvec3(b)) * 0.5;
        const vec4 rounded = {float(middle.x), float(middle.y), float(middle.z), 0};
        // No float between them, or a corner in line is there already: a half would have two equal corners,
        // and so no edges.
        for (const u32 s : by_edge_[e])
            if (has_corner_at(scene_.triangles[s], rounded))
                return false;
        scene_.positions.push_back(rounded);
        if (std::vector<glm::vec3>& colours = scene_.vertex_colours; !colours.empty())
            colours.push_back((colours[e.first] + colours[e.second]) * 0.5f);
        const std::vector<u32> sharing = std::move(by_edge_[e]);
        by_edge_.erase(e);
        for (const u32 s : sharing)
            halve(s, e, u32(scene_.positions.size() - 1));
        return true;
    }

    /// Replaces a triangle by two with a new corner on one of its edges.
    void halve(u32 t, const Edge& e, u32 middle) {
        Triangle first = scene_.triangles[t];
        int k = 0;
        while (edge(first, k) != e)
            ++k;
        turn(first, k);
        Triangle second = first; // e is from corner 0 to corner 1
        first.v1 = second.v0 = middle;
        if (first.t0 != NO_INDEX) {
            const u32 from = 2 * first.t0, to = 2 * first.t1;
            for (std::vector<float>* uvs : {&scene_.uvs, &scene_.second_uvs})
                for (u32 i = 0; i < 2 && !uvs->empty(); ++i)
                    uvs->push_back(float((double((*uvs)[from + i]) + double((*uvs)[to + i])) * 0.5));
            first.t1 = second.t0 = u32(scene_.uvs.size() / 2 - 1);
        }
        if (t < first_added_)
            cut_.insert(t);
        const u32 added = u32(scene_.triangles.size());
        std::vector<u32>& beside = by_edge_[edge(second, 1)];
        std::replace(beside.begin(), beside.end(), t, added);
        scene_.triangles[t] = first;
        scene_.triangles.push_back(second);
        by_edge_[edge(first, 0)].push_back(t);
        by_edge_[edge(second, 0)].push_back(added);
        by_edge_[edge(first, 1)].push_back(t);
        by_edge_[edge(first, 1)].push_back(added);
        triangles_[added] = triangles_[t];
        waiting_.push_back(t);
        waiting_.push_back(added);
    }

    /// Turns the corners so that edge k becomes edge 0.
    static void turn(Triangle& t, int k) {
        for (; k > 0; --k) {
            std::tie(t.v0, t.v1, t.v2) = std::make_tuple(t.v1, t.v2, t.v0);
            std::tie(t.n0, t.n1, t.n2) = std::make_tuple(t.n1, t.n2, t.n0);
            std::tie(t.t0, t.t1, t.t2) = std::make_tuple(t.t1, t.t2, t.t0);
        }
    }

    Scene& scene_;
    const u32 first_added_ = u32(scene_.triangles.size());
    std::map<std::tuple<float, float, float>, u32> places_;
    std::map<Edge, std::vector<u32>> by_edge_;
    std::unordered_map<u32, Sites> triangles_; ///< those that are listed, with what they may be vast beside
    std::deque<u32> waiting_;
    std::set<u32> cut_;
};

} // namespace

CutTriangles cut_vast_triangles(Scene& scene) {
    return Cutter(scene).run();
}

} // namespace clrt
