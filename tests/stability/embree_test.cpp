// SPDX-License-Identifier: Apache-2.0
// A million rays against Embree in its robust mode. Where the two differ, all triangles in double precision
// say which is wrong.
#include "probes/meshes.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"
#include "support/embree_scene.h"
#include "support/test_device.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>

namespace clrt {
namespace {

/// Error of corners seen along a ray, as a share of their largest component from the origin: what single
/// precision with correctly rounded divisions cannot avoid (kernels/geometry/box.h), on two axes.
constexpr double SHEAR_ERROR = 8.5 * FLOAT_U;

/// Error of a distance, as a share of the largest depth of a corner, beside that of its place.
constexpr double DISTANCE_ERROR = 16 * FLOAT_U;

/// A ray in double with two directions across it.
struct ExactRay {
    glm::dvec3 origin, direction, x, y;

    explicit ExactRay(const TestRay& ray) : origin(to_dvec3(ray.origin)), direction(to_dvec3(ray.direction)) {
        const glm::dvec3 n = glm::normalize(direction);
        x = glm::normalize(glm::cross(n, std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        y = glm::cross(n, x);
    }
};

/// A triangle along a ray.
struct Crossing {
    double outside = INFINITY; ///< how far the ray passes it; negative: how far inside its edges the ray is
    double slack = 0;          ///< uncertainty of `outside`
    double t = 0, t_error = 0; ///< distance to the plane, and its uncertainty
};

Crossing cross_triangle(const Scene& scene, const ExactRay& ray, u32 index) {
    glm::dvec3 p[3];
    glm::dvec2 seen[3];
    double reach = 0;
    for (int k = 0; k < 3; ++k) {
        p[k] = corner_position(scene, scene.triangles[index], k) - ray.origin;
        seen[k] = {glm::dot(p[k], ray.x), glm::dot(p[k], ray.y)};
        reach = std::max({reach, std::abs(p[k].x), std::abs(p[k].y), std::abs(p[k].z)});
    }
    Crossing result;
    result.slack = SHEAR_ERROR * reach;
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
    const double cosine = std::abs(glm::dot(normal, glm::normalize(ray.direction)));
    result.t = glm::dot(normal, p[0]) / glm::dot(normal, ray.direction);
    result.t_error =
        result.slack * std::sqrt(1 - std::min(cosine * cosine, 1.0)) / cosine + DISTANCE_ERROR * reach;
    return result;
}

/// True if two hits differ by no more than what rounding may do to each.
bool agree(const Scene& scene, const ExactRay& ray, const TestHit& a, const TestHit& b) {
    if (a.triangle == NO_INDEX || b.triangle == NO_INDEX)
        return a.triangle == b.triangle;
    return std::abs(a.t - b.t) <=
           cross_triangle(scene, ray, a.triangle).t_error + cross_triangle(scene, ray, b.triangle).t_error;
}

/// True if no rounding excuses an answer: a triangle that is not there, or a nearer one overlooked.
bool is_wrong(const Scene& scene, const ExactRay& ray, const TestHit& hit) {
    double latest = INFINITY;
    if (hit.triangle != NO_INDEX) {
        const Crossing crossing = cross_triangle(scene, ray, hit.triangle);
        if (crossing.outside > crossing.slack || std::abs(hit.t - crossing.t) > crossing.t_error)
            return true;
        latest = hit.t;
    }
    for (u32 i = 0; i < scene.triangles.size(); ++i) {
        const Crossing crossing = cross_triangle(scene, ray, i);
        if (crossing.outside < -crossing.slack && crossing.t > crossing.t_error &&
            crossing.t + crossing.t_error < latest)
            return true;
    }
    return false;
}

/// A closed ball with bumps, of 130,560 triangles; it holds a ball of radius 0.7.
Scene make_bumpy_ball() {
    Scene scene = make_ball(256, 256);
    for (vec4& p : scene.positions)
        p = to_vec4(to_dvec3(p) * (1 + 0.25 * std::sin(9 * p.x) * std::cos(7 * p.y) * std::cos(5 * p.z)));
    return scene;
}

constexpr size_t RAYS = 1000000, RAYS_FROM_INSIDE = 700000;

/// Rays into the void, at corners, and at points of edges, the first RAYS_FROM_INSIDE of them from inside.
std::vector<TestRay> mixed_rays(const Scene& scene) {
    Random random(1);
    std::vector<TestRay> rays;
    rays.reserve(RAYS);
    while (rays.size() < RAYS) {
        const bool inside = rays.size() < RAYS_FROM_INSIDE;
        const glm::dvec3 origin = inside ? random.in_cube(0.35) : 2.0 * random.direction();
        const Triangle& triangle = scene.triangles[random.word() % scene.triangles.size()];
        const glm::dvec3 p0 = corner_position(scene, triangle, 0), p1 = corner_position(scene, triangle, 1);
        if (rays.size() % 3 == 0)
            rays.push_back(make_ray_to(origin, origin + random.direction()));
        else
            rays.push_back(make_ray_to(origin, rays.size() % 3 == 1 ? p0 : p0 + random.unit() * (p1 - p0)));
    }
    return rays;
}

/// Outlines and grazing incidence account for fewer; with more, nobody waits for each to be judged.
constexpr size_t MOST_DIFFERENCES = RAYS / 1000;

struct Verdict {
    size_t lost = 0, embree_lost = 0; ///< rays from inside without a hit
    size_t twins = 0;                 ///< hits of different triangles at distances that agree
    size_t differences = 0;           ///< of which:
    size_t wrong = 0, embree_wrong = 0;
};

Verdict compare(const Scene& scene, const std::vector<TestRay>& rays, const std::vector<TestHit>& found,
                const std::vector<TestHit>& embree) {
    Verdict verdict;
    for (size_t i = 0; i < rays.size(); ++i) {
        const bool inside = i < RAYS_FROM_INSIDE;
        const bool is_lost = inside && found[i].triangle == NO_INDEX;
        const bool embree_is_lost = inside && embree[i].triangle == NO_INDEX;
        verdict.lost += is_lost;
        verdict.embree_lost += embree_is_lost;
        if (is_lost || embree_is_lost)
            continue;
        if (found[i].triangle == embree[i].triangle && found[i].t == embree[i].t)
            continue;
        const ExactRay ray(rays[i]);
        if (agree(scene, ray, found[i], embree[i])) {
            verdict.twins += found[i].triangle != embree[i].triangle;
            continue;
        }
        if (++verdict.differences > MOST_DIFFERENCES)
            return verdict;
        verdict.wrong += is_wrong(scene, ray, found[i]);
        verdict.embree_wrong += is_wrong(scene, ray, embree[i]);
    }
    return verdict;
}

} // namespace

TEST(Embree, GivesTheSameHitsOrIsWrong) {
    const Scene scene = normalised(make_bumpy_ball());
    const std::vector<TestRay> rays = mixed_rays(scene);
    const EmbreeScene embree(scene.positions, scene.triangles);
    std::vector<TestHit> expected;
    expected.reserve(rays.size());
    for (const TestRay& ray : rays) {
        const EmbreeHit hit = embree.closest(ray.origin, ray.direction, ray.origin.w);
        expected.push_back({hit.t, hit.u, hit.v, hit.triangle});
    }
    for (const BvhLayout layout : ALL_LAYOUTS) {
        const Verdict v =
            compare(scene, rays, RayDevice(test_device(), scene, layout).closest(rays), expected);
        std::printf("%s, %zu rays: lost %zu, by Embree %zu; twins %zu; differences %zu, wrong %zu, Embree "
                    "wrong %zu\n",
                    name_of(layout), rays.size(), v.lost, v.embree_lost, v.twins, v.differences, v.wrong,
                    v.embree_wrong);
        EXPECT_EQ(v.lost, 0u) << name_of(layout);
        EXPECT_EQ(v.wrong, 0u) << name_of(layout);
        // Else one of the two scenes is not the other.
        EXPECT_LE(v.differences, MOST_DIFFERENCES) << name_of(layout);
        EXPECT_LT(v.embree_lost, rays.size() / 100) << name_of(layout);
    }
}

} // namespace clrt
