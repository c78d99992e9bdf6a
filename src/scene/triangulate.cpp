// SPDX-License-Identifier: Apache-2.0
// Fans, quads and ear clipping (Meisters 1975, "Polygons have ears") in the projected plane of the polygon.
#include "scene/triangulate.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace clrt {

namespace {

/// Twice the signed area of a, b, c: positive if they turn left.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// The polygon without the coordinate in which its area vector is longest, turning left. Empty if it has no
/// area.
std::vector<glm::dvec2> project(const std::vector<glm::dvec3>& polygon) {
    const glm::dvec3& origin = polygon[0];
    glm::dvec3 area(0);
    for (size_t i = 2; i < polygon.size(); ++i)
        area += glm::cross(polygon[i - 1] - origin, polygon[i] - origin);
    const glm::dvec3 size = glm::abs(area);
    const int axis = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
    if (!(size[axis] > 0))
        return {};
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (area[axis] < 0)
        std::swap(u, v);
    std::vector<glm::dvec2> points;
    points.reserve(polygon.size());
    for (const glm::dvec3& p : polygon)
        points.emplace_back(p[u], p[v]);
    return points;
}

void emit(std::vector<u32>& triangles, u32 a, u32 b, u32 c) {
    triangles.insert(triangles.end(), {a, b, c});
}

void emit_fan(std::vector<u32>& triangles, size_t apex, size_t size) {
    for (size_t i = 1; i + 1 < size; ++i)
        emit(triangles, u32(apex), u32((apex + i) % size), u32((apex + i + 1) % size));
}

/// Cuts along the shorter of the diagonals that lie inside. A corner on the line between its neighbours, or
/// equal to one of them, is tolerated where no diagonal gives two triangles with an area.
bool cut_quad(const std::vector<glm::dvec3>& polygon, const std::vector<glm::dvec2>& p,
              std::vector<u32>& triangles) {
    // The areas of the two triangles beside diagonal 0-2, and beside diagonal 1-3.
    const double areas[2][2] = {{turn(p[0], p[1], p[2]), turn(p[0], p[2], p[3])},
                                {turn(p[1], p[2], p[3]), turn(p[1], p[3], p[0])}};
    const auto inside = [&](int d) { return areas[d][0] > 0 && areas[d][1] > 0; };
    const auto tolerable = [&](int d) { return areas[d][0] >= 0 && areas[d][1] >= 0; };
    const auto length = [&](int d) { return glm::length(polygon[d + 2] - polygon[d]); };
    int diagonal = length(1) < length(0) ? 1 : 0;
    if (!inside(diagonal) && (inside(1 - diagonal) || !tolerable(diagonal)))
        diagonal = 1 - diagonal;
    emit_fan(triangles, size_t(diagonal), 4);
    return tolerable(diagonal);
}

/// Never turns right and goes round once (its edges change between leftwards and rightwards exactly twice).
bool is_convex(std::vector<glm::dvec2> points) {
    // Doubled corners would hide a turn.
    points.erase(std::unique(points.begin(), points.end()), points.end());
    while (points.back() == points.front())
        points.pop_back();
    const size_t size = points.size();
    int changes = 0;
    double last = 0;
    for (size_t i = 0; i <= size; ++i) {
        const glm::dvec2 &a = points[i % size], &b = points[(i + 1) % size], &c = points[(i + 2) % size];
        if (turn(a, b, c) < 0)
            return false;
        const double step = b.x != a.x ? b.x - a.x : b.y - a.y;
        changes += last * step < 0;
        last = step;
    }
    return changes == 2;
}

/// Cuts a convex polygon. A fan's first and last triangle have an area only if the apex's neighbours are no
/// flat corners; false if there is no such apex.
bool cut_convex(const std::vector<glm::dvec2>& points, std::vector<u32>& triangles) {
    const size_t size = points.size();
    const auto is_flat = [&](size_t i) {
        return turn(points[(i + size - 1) % size], points[i % size], points[(i + 1) % size]) <= 0;
    };
    for (size_t apex = 0; apex < size; ++apex)
        if (!is_flat(apex + 1) && !is_flat(apex + size - 1)) {
            emit_fan(triangles, apex, size);
            return true;
        }
    return false;
}

/// Cuts off ears until a triangle is left. What blocks an ear is always a corner that is not convex, and
/// cutting an ear changes only its two neighbours, so each of O(n) tests looks at the non-convex corners
/// alone.
class EarClipper {
public:
    EarClipper(const std::vector<glm::dvec2>& points, std::vector<u32>& triangles);
    bool clip();

private:
    /// STRICT: ears have an area, and nothing touches their diagonal. RELAXED, for what is left of polygons
    /// that cross or touch themselves: flat corners are cut off too, and corners may touch.
    enum class Rule { STRICT, RELAXED };
    enum class State : unsigned char { UNKNOWN, NO_EAR, CUT };

    double turn_at(u32 i) const { return turn(points_[previous_[i]], points_[i], points_[next_[i]]); }
    bool clip_with(Rule rule);
    bool is_ear(u32 i, Rule rule);
    bool blocks(u32 i, u32 ear, Rule rule) const;
    void cut(u32 i);

    const std::vector<glm::dvec2>& points_;
    std::vector<u32>& triangles_;
    std::vector<u32> previous_, next_, blockers_;
    std::vector<State> states_;
    size_t left_;
    u32 at_ = 0;
};

EarClipper::EarClipper(const std::vector<glm::dvec2>& points, std::vector<u32>& triangles)
    : points_(points), triangles_(triangles), previous_(points.size()), next_(points.size()),
      states_(points.size(), State::UNKNOWN), left_(points.size()) {
    for (size_t i = 0; i < left_; ++i) {
        previous_[i] = u32((i + left_ - 1) % left_);
        next_[i] = u32((i + 1) % left_);
    }
    for (u32 i = 0; i < left_; ++i)
        if (turn_at(i) <= 0)
            blockers_.push_back(i);
}

bool EarClipper::clip() {
    // Polygons that cross themselves may end in a triangle that is turned over.
    const bool proper = (clip_with(Rule::STRICT) || clip_with(Rule::RELAXED)) && turn_at(at_) >= 0;
    // A fan for the rest: the last triangle, or what has no ears.
    for (; left_ > 2; cut(next_[at_]))
        continue;
    return proper;
}

bool EarClipper::clip_with(Rule rule) {
    for (State& state : states_)
        if (state == State::NO_EAR)
            state = State::UNKNOWN;
    // Walk round; the corner after a cut is skipped, which avoids slivers that all meet in one corner.
    for (size_t since_cut = 0; left_ > 3 && since_cut < left_; at_ = next_[at_], ++since_cut)
        if (is_ear(at_, rule)) {
            cut(at_);
            at_ = next_[at_];
            since_cut = 0;
        }
    return left_ == 3;
}

bool EarClipper::is_ear(u32 i, Rule rule) {
    if (states_[i] == State::NO_EAR)
        return false;
    states_[i] = State::NO_EAR;
    const double turned = turn_at(i);
    if (turned <= 0)
        return turned == 0 && rule == Rule::RELAXED;
    for (size_t k = 0; k < blockers_.size();) {
        const u32 blocker = blockers_[k];
        // Forget corners that were cut or became convex.
        if (states_[blocker] == State::CUT || turn_at(blocker) > 0) {
            blockers_[k] = blockers_.back();
            blockers_.pop_back();
            continue;
        }
        if (blocks(blocker, i, rule))
            return false;
        ++k;
    }
    return true;
}

bool EarClipper::blocks(u32 i, u32 ear, Rule rule) const {
    const glm::dvec2 &a = points_[previous_[ear]], &b = points_[ear], &c = points_[next_[ear]],
                     &p = points_[i];
    const auto inside = [rule](double area) { return rule == Rule::STRICT ? area >= 0 : area > 0; };
    // Corners at the same place as one of the ear's are bridges to holes, or doubled: they do not block.
    return inside(turn(c, a, p)) && inside(turn(a, b, p)) && inside(turn(b, c, p)) && p != a && p != b &&
           p != c;
}

void EarClipper::cut(u32 i) {
    const u32 before = previous_[i], after = next_[i];
    emit(triangles_, before, i, after);
    next_[before] = after;
    previous_[after] = before;
    states_[before] = states_[after] = State::UNKNOWN;
    states_[i] = State::CUT;
    --left_;
}

} // namespace

bool triangulate(const std::vector<glm::dvec3>& polygon, std::vector<u32>& triangles) {
    const size_t size = polygon.size();
    triangles.clear();
    if (size == 3) {
        emit_fan(triangles, 0, size);
        return true;
    }
    const std::vector<glm::dvec2> points = project(polygon);
    if (points.empty()) {
        emit_fan(triangles, 0, size);
        return false;
    }
    if (size == 4)
        return cut_quad(polygon, points, triangles);
    if (is_convex(points) && cut_convex(points, triangles))
        return true;
    if (size > MAX_CLIPPED_CORNERS) {
        emit_fan(triangles, 0, size);
        return false;
    }
    return EarClipper(points, triangles).clip();
}

} // namespace clrt
