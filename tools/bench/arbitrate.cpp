// SPDX-License-Identifier: Apache-2.0
#include "bench/arbitrate.h"

#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <tbb/parallel_for.h>

namespace clrt {

namespace {

/// u of a float: half a unit in the last place of 1.
constexpr double FLOAT_U = 5.9604644775390625e-8;

/// Error of a distance, as a share of the largest depth of a corner, beside that of its place.
constexpr double DISTANCE_ERROR = 16 * FLOAT_U;

/// A ray in double with two directions across it.
struct ExactRay {
    glm::dvec3 origin, direction, along, x, y;
    double length; ///< of direction

    explicit ExactRay(const BenchRay& ray)
        : origin(to_dvec3(ray.origin)), direction(to_dvec3(ray.direction)) {
        length = glm::length(direction);
        along = direction / length;
        x = glm::normalize(
            glm::cross(along, std::abs(along.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        y = glm::cross(along, x);
    }
};

/// A triangle along a ray.
struct Crossing {
    double outside = INFINITY; ///< how far the ray passes it; negative: how far inside its edges the ray is
    double slack = 0;          ///< uncertainty of `outside`
    double t = 0, t_error = 0; ///< distance to the plane, and its uncertainty

    bool is_possible() const { return !(outside > slack); }
    bool is_certain() const { return outside < -slack && t > t_error; }
};

Crossing cross_triangle(const Scene& scene, const RoundingBound& bound, const ExactRay& ray, u32 index) {
    const Triangle& triangle = scene.triangles[index];
    const u32 corners[3] = {triangle.v0, triangle.v1, triangle.v2};
    glm::dvec3 p[3];
    glm::dvec2 seen[3];
    double reach = 0;
    for (int k = 0; k < 3; ++k) {
        p[k] = to_dvec3(scene.positions[corners[k]]) - ray.origin;
        seen[k] = {glm::dot(p[k], ray.x), glm::dot(p[k], ray.y)};
        reach = std::max({reach, std::abs(p[k].x), std::abs(p[k].y), std::abs(p[k].z)});
    }
    Crossing result;
    result.slack = bound.shear * reach;
    // Most triangles are far from the ray.
    for (int axis = 0; axis < 2; ++axis)
        if (std::min({seen[0][axis], seen[1][axis], seen[2][axis]}) > result.slack ||
            std::max({seen[0][axis], seen[1][axis], seen[2][axis]}) < -result.slack)
            return result;
    const auto area = [](const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; };
    const double turn = area(seen[1] - seen[0], seen[2] - seen[0]) < 0 ? -1 : 1;
    result.outside = -INFINITY;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 a = seen[k], b = seen[(k + 1) % 3];
        result.outside = std::max(result.outside, -turn * area(a, b) / glm::length(b - a));
    }
    const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    const double cosine = std::abs(glm::dot(normal, ray.along));
    result.t = glm::dot(normal, p[0]) / glm::dot(normal, ray.direction);
    const double tangent = std::sqrt(1 - std::min(cosine * cosine, 1.0)) / cosine;
    result.t_error = (result.slack * tangent + DISTANCE_ERROR * reach) / ray.length;
    return result;
}

/// True if some triangle is surely met before `latest`.
bool is_surely_met(const Scene& scene, const RoundingBound& bound, const ExactRay& ray, double latest) {
    for (u32 i = 0; i < scene.triangles.size(); ++i) {
        const Crossing crossing = cross_triangle(scene, bound, ray, i);
        if (crossing.is_certain() && crossing.t + crossing.t_error < latest)
            return true;
    }
    return false;
}

/// True if some triangle may be met before `latest`.
bool may_be_met(const Scene& scene, const RoundingBound& bound, const ExactRay& ray, double latest) {
    for (u32 i = 0; i < scene.triangles.size(); ++i) {
        const Crossing crossing = cross_triangle(scene, bound, ray, i);
        if (crossing.is_possible() && crossing.t > -crossing.t_error &&
            crossing.t - crossing.t_error <= latest)
            return true;
    }
    return false;
}

enum class Relation { SAME, TWINS, DIFFERENT };

/// The hit's own triangle along the ray. Its `outside` is infinite where the hit cannot be: no such triangle,
/// not on the ray, or not at that distance.
Crossing cross_hit(const Scene& scene, const RoundingBound& bound, const ExactRay& ray, const BenchHit& hit) {
    if (hit.triangle >= scene.triangles.size())
        return {};
    const Crossing crossing = cross_triangle(scene, bound, ray, hit.triangle);
    const bool is_there = crossing.is_possible() && std::abs(double(hit.t) - crossing.t) <= crossing.t_error;
    return is_there ? crossing : Crossing();
}

/// How two hits of a ray relate, given what rounding may do to each.
Relation relate(const Scene& scene, const RoundingBound& bound, bool any_hit, const BenchRay& ray,
                const BenchHit& a, const BenchHit& b) {
    if (a.triangle == NO_INDEX || b.triangle == NO_INDEX || any_hit)
        return (a.triangle == NO_INDEX) == (b.triangle == NO_INDEX) ? Relation::SAME : Relation::DIFFERENT;
    if (a.triangle == b.triangle && a.t == b.t)
        return Relation::SAME;
    const ExactRay exact(ray);
    const Crossing at_a = cross_hit(scene, bound, exact, a), at_b = cross_hit(scene, bound, exact, b);
    const bool both_there = at_a.is_possible() && at_b.is_possible();
    if (!both_there || !(std::abs(double(a.t) - double(b.t)) <= at_a.t_error + at_b.t_error))
        return Relation::DIFFERENT;
    return a.triangle == b.triangle ? Relation::SAME : Relation::TWINS;
}

std::string hit_text(const BenchHit& hit, bool any_hit) {
    if (hit.triangle == NO_INDEX)
        return "nothing";
    return any_hit ? "something" : fmt::format("triangle {} at {:.9g}", hit.triangle, hit.t);
}

std::string ray_text(const BenchRay& ray, const BenchHit& clrt, const BenchHit& rival, bool any_hit) {
    return fmt::format(
        "from ({:.9g}, {:.9g}, {:.9g}) along ({:.9g}, {:.9g}, {:.9g}) to {:.9g}: clrt found {}, Embree {}",
        ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z,
        ray.origin.w, hit_text(clrt, any_hit), hit_text(rival, any_hit));
}

} // namespace

RoundingBound rounding_bound(bool correctly_rounded_division) {
    // sqrt(2) times the errors on one axis, 6 u and 10 u (kernels/geometry/box.h, with |c_x| and |c_z| of one
    // size).
    return {(correctly_rounded_division ? 8.5 : 14.2) * FLOAT_U};
}

bool closest_is_wrong(const Scene& scene, const RoundingBound& bound, const BenchRay& ray,
                      const BenchHit& hit) {
    const ExactRay exact(ray);
    double latest = ray.origin.w;
    if (hit.triangle != NO_INDEX) {
        if (!cross_hit(scene, bound, exact, hit).is_possible())
            return true;
        latest = hit.t;
    }
    return is_surely_met(scene, bound, exact, latest);
}

bool any_is_wrong(const Scene& scene, const RoundingBound& bound, const BenchRay& ray, bool found) {
    const ExactRay exact(ray);
    const double latest = ray.origin.w;
    return found ? !may_be_met(scene, bound, exact, latest) : is_surely_met(scene, bound, exact, latest);
}

Verdict arbitrate(const Scene& scene, const RoundingBound& bound, bool any_hit,
                  const std::vector<BenchRay>& rays, const std::vector<BenchHit>& clrt,
                  const std::vector<BenchHit>& rival) {
    Verdict verdict;
    verdict.rays = rays.size();
    std::vector<size_t> cases;
    for (size_t i = 0; i < rays.size(); ++i) {
        const Relation relation = relate(scene, bound, any_hit, rays[i], clrt[i], rival[i]);
        verdict.twins += relation == Relation::TWINS;
        if (relation != Relation::DIFFERENT)
            continue;
        ++verdict.differences;
        if (cases.size() < MOST_JUDGED)
            cases.push_back(i);
    }

    // Judge each side of every case on its own: both may be wrong, or both excused.
    struct Faults {
        char clrt = 0, rival = 0;
    };
    std::vector<Faults> faults(cases.size());
    const auto is_wrong = [&](size_t i, const BenchHit& hit) {
        return any_hit ? any_is_wrong(scene, bound, rays[i], hit.triangle != NO_INDEX)
                       : closest_is_wrong(scene, bound, rays[i], hit);
    };
    tbb::parallel_for(size_t(0), cases.size(), [&](size_t k) {
        faults[k].clrt = is_wrong(cases[k], clrt[cases[k]]);
        faults[k].rival = is_wrong(cases[k], rival[cases[k]]);
    });
    verdict.judged = cases.size();
    for (size_t k = 0; k < cases.size(); ++k) {
        verdict.clrt_wrong += size_t(faults[k].clrt);
        verdict.rival_wrong += size_t(faults[k].rival);
        if (faults[k].clrt && verdict.first_wrong.empty())
            verdict.first_wrong = ray_text(rays[cases[k]], clrt[cases[k]], rival[cases[k]], any_hit);
    }
    return verdict;
}

} // namespace clrt
