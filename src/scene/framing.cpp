// SPDX-License-Identifier: Apache-2.0
#include "scene/framing.h"

#include "scene/triangle_corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

namespace clrt {
namespace {

/// Newton's steps to the middle: two find the points that bound the picture, the third is exact.
constexpr int CENTRING_STEPS = 3;
/// Of the scene's height: how far a floor may be from one plane.
constexpr double FLOOR_THICKNESS = 0.01;
/// Times as wide as what stands on it, a floor is left out: smaller ones are part of the thing, as a plinth
/// is.
constexpr double WIDE_FLOOR = 2;
/// Times as large as all that does not shine, a scene has lamps far away.
constexpr double FAR_LAMPS = 5;
/// Diameters of all that does not shine, on every side of it: as far out a lamp is near.
constexpr double NEAR_LAMPS = 1;

glm::dvec3 position(const Scene& scene, u32 vertex) {
    const vec4& p = scene.positions[vertex];
    return {p.x, p.y, p.z};
}

/// Calls visit(corners of a triangle, whether it shines) for all triangles, on all threads, and merges what
/// the tasks have got.
template <class T, class Visit, class Merge>
T reduce_triangles(const Scene& scene, const T& start, const Visit& visit, const Merge& merge) {
    return tbb::parallel_reduce(
        tbb::blocked_range<size_t>(0, scene.triangles.size(), TRIANGLE_GRAIN), start,
        [&](const tbb::blocked_range<size_t>& range, T value) {
            for (size_t i = range.begin(); i < range.end(); ++i) {
                const Triangle& t = scene.triangles[i];
                const glm::dvec3 corners[3] = {position(scene, t.v0), position(scene, t.v1),
                                               position(scene, t.v2)};
                visit(value, corners, t.emitter != NO_INDEX);
            }
            return value;
        },
        merge);
}

Bounds nothing() {
    const double most = std::numeric_limits<double>::max();
    return {glm::dvec3(most), glm::dvec3(-most)};
}

bool is_nothing(const Bounds& box) {
    return box.low.x > box.high.x;
}

void add(Bounds& box, const glm::dvec3& p) {
    box.low = glm::min(box.low, p);
    box.high = glm::max(box.high, p);
}

Bounds united(const Bounds& a, const Bounds& b) {
    return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

/// Half the diagonal of a box as seen from above.
double width(const Bounds& box) {
    return std::hypot(box.high.x - box.low.x, box.high.z - box.low.z) / 2;
}

bool is_floor(const glm::dvec3 (&corners)[3], const glm::dvec3& up, double top) {
    return glm::dot(corners[0], up) < top && glm::dot(corners[1], up) < top && glm::dot(corners[2], up) < top;
}

/// Whether a triangle is part of what is framed.
bool is_framed(const Framed& framed, const glm::dvec3 (&corners)[3], bool shines, const glm::dvec3& up) {
    if (framed.without_floor && is_floor(corners, up, framed.floor_top))
        return false;
    if (!shines || !framed.lamps_within)
        return true;
    const glm::dmat3 frame = up_frame(up);
    const Bounds& near = *framed.lamps_within;
    return std::all_of(std::begin(corners), std::end(corners), [&](const glm::dvec3& corner) {
        const glm::dvec3 p = corner * frame;
        return glm::clamp(p, near.low, near.high) == p;
    });
}

/// How far points reach: along the normals of the planes right, left, above and below, and towards the eye.
struct Reach {
    double right, left, above, below, near;
};

Reach farther(const Reach& a, const Reach& b) {
    return {std::max(a.right, b.right), std::max(a.left, b.left), std::max(a.above, b.above),
            std::max(a.below, b.below), std::max(a.near, b.near)};
}

Reach measure_reach(const Scene& scene, const Framed& framed, const glm::dvec3& up, const PictureAxes& axes,
                    const ViewTangents& view) {
    const double least = std::numeric_limits<double>::lowest();
    return reduce_triangles(
        scene, Reach{least, least, least, least, least},
        [&](Reach& reach, const glm::dvec3(&corners)[3], bool shines) {
            if (!is_framed(framed, corners, shines, up))
                return;
            for (const glm::dvec3& p : corners) {
                const double x = glm::dot(p, axes.right), y = glm::dot(p, axes.up),
                             z = glm::dot(p, axes.look);
                reach = farther(reach, {x - view.horizontal * z, -x - view.horizontal * z,
                                        y - view.vertical * z, -y - view.vertical * z, -z});
            }
        },
        farther);
}

/// The point that is farthest to one side of the picture, as seen from an eye: tangent of its angle, 1 /
/// depth.
struct Farthest {
    double tangent = std::numeric_limits<double>::lowest(), inverse_depth = 0;
};

/// To the right, to the left, above and below.
using Edges = std::array<Farthest, 4>;

Edges measure_edges(const Scene& scene, const Framed& framed, const glm::dvec3& up, const PictureAxes& axes,
                    const glm::dvec3& eye) {
    const auto see = [](Farthest& edge, double side, double inverse_depth) {
        if (side * inverse_depth > edge.tangent)
            edge = {side * inverse_depth, inverse_depth};
    };
    return reduce_triangles(
        scene, Edges(),
        [&](Edges& edges, const glm::dvec3(&corners)[3], bool shines) {
            if (!is_framed(framed, corners, shines, up))
                return;
            for (const glm::dvec3& p : corners) {
                const double x = glm::dot(p - eye, axes.right), y = glm::dot(p - eye, axes.up),
                             inverse = 1 / glm::dot(p - eye, axes.look);
                see(edges[0], x, inverse);
                see(edges[1], -x, inverse);
                see(edges[2], y, inverse);
                see(edges[3], -y, inverse);
            }
        },
        [](Edges a, const Edges& b) {
            for (size_t i = 0; i < a.size(); ++i)
                if (b[i].tangent > a[i].tangent)
                    a[i] = b[i];
            return a;
        });
}

/// The box, in the up frame, of those triangles that does_count(corners, whether it shines) chooses.
template <class Counts>
Bounds box_of(const Scene& scene, const glm::dmat3& frame, const Counts& does_count) {
    return reduce_triangles(
        scene, nothing(),
        [&](Bounds& box, const glm::dvec3(&corners)[3], bool shines) {
            if (does_count(corners, shines))
                for (const glm::dvec3& p : corners)
                    add(box, p * frame);
        },
        united);
}

/// Lamps do not say where the scene is where all else is small beside them and their distance.
void leave_out_far_lamps(const Scene& scene, const glm::dvec3& up, Framed& framed) {
    if (scene.emitters.empty())
        return;
    const glm::dmat3 frame = up_frame(up);
    const Bounds lit = box_of(scene, frame, [](const auto&, bool shines) { return !shines; });
    if (is_nothing(lit) || !(lit.radius() > 0) || framed.box.radius() <= FAR_LAMPS * lit.radius())
        return;
    const glm::dvec3 margin(2 * NEAR_LAMPS * lit.radius());
    framed.lamps_within = Bounds{lit.low - margin, lit.high + margin};
    framed.box = box_of(scene, frame, [&](const glm::dvec3(&corners)[3], bool shines) {
        return is_framed(framed, corners, shines, up);
    });
    framed.centre = frame * framed.box.centre();
}

/// How far the eye must go so that both farthest points are equally far from the middle (Newton's step).
double balance(const Farthest& one, const Farthest& other) {
    return (one.tangent - other.tangent) / (one.inverse_depth + other.inverse_depth);
}

} // namespace

Framed frame_all(const Scene& scene, const glm::dvec3& up) {
    const glm::dmat3 frame = up_frame(up);
    Framed framed;
    framed.box = box_of(scene, frame, [](const auto&, bool) { return true; });
    if (is_nothing(framed.box))
        framed.box = {};
    framed.centre = frame * framed.box.centre();
    return framed;
}

Framed find_framed(const Scene& scene, const glm::dvec3& up) {
    const glm::dmat3 frame = up_frame(up);
    Framed framed = frame_all(scene, up);
    leave_out_far_lamps(scene, up, framed);
    struct Parts {
        Bounds floor = nothing(), rest = nothing();
    };
    const double top = framed.box.low.y + FLOOR_THICKNESS * (framed.box.high.y - framed.box.low.y);
    const Parts parts = reduce_triangles(
        scene, Parts(),
        [&](Parts& p, const glm::dvec3(&corners)[3], bool shines) {
            if (!is_framed(framed, corners, shines, up))
                return;
            Bounds& box = is_floor(corners, up, top) ? p.floor : p.rest;
            for (const glm::dvec3& corner : corners)
                add(box, corner * frame);
        },
        [](const Parts& a, const Parts& b) {
            return Parts{united(a.floor, b.floor), united(a.rest, b.rest)};
        });
    if (!is_nothing(parts.floor) && !is_nothing(parts.rest) &&
        width(parts.floor) > WIDE_FLOOR * width(parts.rest)) {
        framed.without_floor = true;
        framed.floor_top = top;
        framed.box = parts.rest;
        framed.centre = frame * framed.box.centre();
    }
    return framed;
}

glm::dvec3 framing_eye(const Scene& scene, const Framed& framed, const glm::dvec3& up,
                       const PictureAxes& axes, const ViewTangents& view,
                       const std::optional<glm::dvec3>& at) {
    const ViewTangents inner{FRAMED_SHARE * view.vertical, FRAMED_SHARE * view.horizontal};
    const double radius = framed.box.radius() > 0 ? framed.box.radius() : 1;
    if (scene.triangles.empty() ||
        !(framed.box.radius() > 0)) // a point: seen as a sphere of radius 1 would be
        return at.value_or(framed.centre) -
               axes.look * (1 / std::sin(std::atan(std::min(inner.vertical, inner.horizontal))));
    const Reach reach = measure_reach(scene, framed, up, axes, inner);
    const double nearest = -reach.near - LEAST_DISTANCE * radius;
    // A point p is inside where (p - eye) has no part along any of the four normals: each bounds the eye.
    if (at) {
        const double x = glm::dot(*at, axes.right), y = glm::dot(*at, axes.up), z = glm::dot(*at, axes.look);
        const double beside = std::min(-reach.right + x, -reach.left - x) / inner.horizontal;
        const double above = std::min(-reach.above + y, -reach.below - y) / inner.vertical;
        return *at + axes.look * (std::min({beside, above, nearest, z - LEAST_DISTANCE * radius}) - z);
    }
    const double z = std::min({-(reach.right + reach.left) / (2 * inner.horizontal),
                               -(reach.above + reach.below) / (2 * inner.vertical), nearest});
    glm::dvec3 eye = axes.right * ((reach.right - reach.left) / 2) +
                     axes.up * ((reach.above - reach.below) / 2) + axes.look * z;
    // Where the picture is wider than needed, other points may bound it at either end.
    for (int step = 0; step < CENTRING_STEPS; ++step) {
        const Edges edges = measure_edges(scene, framed, up, axes, eye);
        eye += axes.right * balance(edges[0], edges[1]) + axes.up * balance(edges[2], edges[3]);
    }
    return eye;
}

ParallelFilm framing_film(const Scene& scene, const Framed& framed, const glm::dvec3& up,
                          const PictureAxes& axes, double aspect, const std::optional<glm::dvec3>& at) {
    if (scene.triangles.empty() || !(framed.box.radius() > 0)) // as framing_eye
        return {at.value_or(framed.centre) - axes.look * (1 + LEAST_DISTANCE),
                2 / FRAMED_SHARE / std::min(1., aspect)};
    const double radius = framed.box.radius();
    const Reach reach = measure_reach(scene, framed, up, axes, {0, 0});
    const double x = at ? glm::dot(*at, axes.right) : (reach.right - reach.left) / 2,
                 y = at ? glm::dot(*at, axes.up) : (reach.above - reach.below) / 2;
    const double nearest = at ? std::min(-reach.near, glm::dot(*at, axes.look)) : -reach.near;
    const double half_width = std::max(reach.right - x, reach.left + x),
                 half_height = std::max(reach.above - y, reach.below + y);
    const double height = 2 * std::max(half_height, half_width / aspect) / FRAMED_SHARE;
    return {axes.right * x + axes.up * y + axes.look * (nearest - LEAST_DISTANCE * radius),
            std::max(height, LEAST_HEIGHT * radius)};
}

} // namespace clrt
