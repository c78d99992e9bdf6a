// SPDX-License-Identifier: Apache-2.0
// The ray-triangle test against double precision: exact signs, accuracy of distance and weights, no false
// hits.
#include "support/kernel_probe.h"
#include "support/random_inputs.h"
#include "support/ray_device.h"
#include "support/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <gtest/gtest.h>
#include <utility>

namespace clrt {
namespace {

const char* const TEXT = R"(
static void permute(const RayShear* shear, const real3* p, real* x, real* y, real* z)
{
    for (int corner = 0; corner < 3; ++corner) {
        x[corner] = ray_component(p[corner], shear->kx);
        y[corner] = ray_component(p[corner], shear->ky);
        z[corner] = ray_component(p[corner], shear->kz);
    }
}

/* u, v, w and the distance times det. */
static float4 edges(float4 origin, float4 direction, float4 p0, float4 p1, float4 p2)
{
    const Ray ray = ray_make(vector_from(origin), vector_from(direction));
    const RayShear shear = ray_shear_make(&ray);
    const real3 p[3] = {vector_from(p0), vector_from(p1), vector_from(p2)};
    real x[3], y[3], z[3], u, v, w, det, t_det;
    permute(&shear, p, x, y, z);
    triangle_edges(&shear, x, y, z, &u, &v, &w, &det, &t_det);
    return (float4)(u, v, w, t_det);
}

/* The same in one lane of eight; the others hold the triangle with corners exchanged. */
static float4 edges_8(uint lane, float4 origin, float4 direction, float4 p0, float4 p1, float4 p2)
{
    const Ray ray = ray_make(vector_from(origin), vector_from(direction));
    const RayShear shear = ray_shear_make(&ray);
    const real3 p[3] = {vector_from(p0), vector_from(p1), vector_from(p2)};
    real scalar[3][3];
    permute(&shear, p, scalar[0], scalar[1], scalar[2]);
    real8 wide[3][3], u, v, w, det, t_det;
    for (int axis = 0; axis < 3; ++axis)
        for (int corner = 0; corner < 3; ++corner) {
            real values[8];
            for (uint i = 0; i < 8; ++i)
                values[i] = scalar[axis][i == lane ? corner : 2 - corner];
            wide[axis][corner] = vload8(0, values);
        }
    triangle_edges_8(&shear, wide[0], wide[1], wide[2], &u, &v, &w, &det, &t_det);
    real us[8], vs[8], ws[8], t_dets[8];
    vstore8(u, 0, us);
    vstore8(v, 0, vs);
    vstore8(w, 0, ws);
    vstore8(t_det, 0, t_dets);
    return (float4)(us[lane], vs[lane], ws[lane], t_dets[lane]);
}
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"geometry/triangle.h"});
        made.add_text(TEXT);
        made.add<vec4(vec4, vec4, vec4, vec4, vec4)>("edges", "edges(a, b, c, d, e)");
        made.add<vec4(vec4, vec4, vec4, vec4, vec4)>("edges_8", "edges_8(i % 8u, a, b, c, d, e)");
        return made;
    }();
    return instance;
}

/// Rays and triangles, one of each an element.
struct Pairs {
    std::vector<vec4> origin, direction, p0, p1, p2;

    void add(const glm::dvec3& o, const glm::dvec3& d, const glm::dvec3& a, const glm::dvec3& b,
             const glm::dvec3& c) {
        origin.push_back(to_vec4(o));
        direction.push_back(to_vec4(d));
        p0.push_back(to_vec4(a));
        p1.push_back(to_vec4(b));
        p2.push_back(to_vec4(c));
    }
    std::vector<vec4> run(const char* expression) const {
        return probe().run<vec4>(expression, origin, direction, p0, p1, p2);
    }
};

bool same_sign(double u, double v, double w) {
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

bool is_hit(const vec4& edges) {
    return same_sign(edges.x, edges.y, edges.z) && edges.x + edges.y + edges.z != 0;
}

/// What the test computes, in double: corners seen along the ray.
struct Sheared {
    glm::dvec2 corners[3];
    double depths[3]; ///< distances along the ray
    double reach;     ///< largest |component| of a corner minus the origin
};

Sheared shear(const Pairs& pairs, size_t i) {
    const glm::dvec3 o = to_dvec3(pairs.origin[i]), d = to_dvec3(pairs.direction[i]);
    const glm::dvec3 a = glm::abs(d);
    const int kz = a.x > a.y ? (a.x > a.z ? 0 : 2) : (a.y > a.z ? 1 : 2);
    const int kx = (kz + 1) % 3, ky = (kx + 1) % 3;
    Sheared result{};
    const vec4* const corners[3] = {&pairs.p0[i], &pairs.p1[i], &pairs.p2[i]};
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 p = to_dvec3(*corners[k]) - o;
        result.corners[k] = {p[kx] - d[kx] / d[kz] * p[kz], p[ky] - d[ky] / d[kz] * p[kz]};
        result.depths[k] = p[kz] / d[kz];
        result.reach = std::max({result.reach, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    }
    return result;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

double distance_to_segment(const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 way = b - a;
    const double squared = glm::dot(way, way);
    const double s = squared > 0 ? std::clamp(-glm::dot(a, way) / squared, 0.0, 1.0) : 0;
    return glm::length(a + s * way);
}

/// How far the ray passes the triangle, measured across the sheared ray; 0 inside.
double distance_to(const Sheared& triangle) {
    const auto& [a, b, c] = triangle.corners;
    if (same_sign(cross(b, c), cross(c, a), cross(a, b)))
        return 0;
    return std::min({distance_to_segment(a, b), distance_to_segment(b, c), distance_to_segment(c, a)});
}

/// Whether the device's divisions are within half a unit in the last place; OpenCL grants 2.5.
bool divides_exactly() {
    return test_device().info.correctly_rounded_division;
}

} // namespace

// Along (0, 0, 1) the sheared corners are x and y themselves, so 64-bit integers know the edge functions.
TEST(Triangle, EdgeFunctionsHaveExactSigns) {
    Random random(1);
    Pairs pairs;
    std::vector<std::array<long long, 3>> exact;
    const auto integer = [&](int bits) {
        return (long long)(random.word() >> (32 - bits)) - (1ll << (bits - 1));
    };
    while (exact.size() < 200000) {
        // Corners nearly in line with the ray, or exactly.
        const long long x = integer(13), y = integer(13), k = integer(11), m = integer(11),
                        slack = random.word() % 3;
        const long long ax = x, ay = y, bx = k * x + slack * (integer(2)), by = k * y + slack * (integer(2));
        const long long cx = m * x + slack * (integer(2)), cy = m * y + slack * (integer(2));
        pairs.add({0, 0, 0}, {0, 0, 1}, {ax, ay, 1}, {bx, by, 1}, {cx, cy, 1});
        exact.push_back({cx * by - cy * bx, ax * cy - ay * cx, bx * ay - by * ax});
    }
    const std::vector<vec4> got = pairs.run("edges");
    size_t wrong_signs = 0, zeros = 0;
    double worst = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        const float edges[3] = {got[i].x, got[i].y, got[i].z};
        for (size_t k = 0; k < 3; ++k) {
            const long long value = exact[i][k];
            wrong_signs += (edges[k] > 0) != (value > 0) || (edges[k] < 0) != (value < 0);
            zeros += value == 0;
            worst = std::max(worst, ulp_distance(edges[k], double(value)));
        }
    }
    EXPECT_EQ(wrong_signs, 0u);
    EXPECT_GT(zeros, 100000u);
    EXPECT_LE(worst, 1.5); // Jeannerod, Louvet and Muller 2013
}

TEST(Triangle, EightLanesGiveTheBitsOfOne) {
    Random random(2);
    Pairs pairs;
    for (int i = 0; i < 200000; ++i) {
        const glm::dvec3 centre = random.in_cube(1);
        const double size = std::abs(random.signed_log(1e-6, 1));
        const glm::dvec3 p0 = centre + random.in_cube(size), p1 = centre + random.in_cube(size);
        const glm::dvec3 p2 = centre + random.in_cube(size), origin = random.in_cube(3);
        // At a corner, or into the triangle.
        const glm::dvec3 target = i % 2 ? p0 : (p0 + p1 + p2) / 3.0;
        pairs.add(origin, glm::normalize(target - origin), p0, p1, p2);
    }
    const std::vector<vec4> one = pairs.run("edges"), eight = pairs.run("edges_8");
    EXPECT_EQ(std::memcmp(one.data(), eight.data(), one.size() * sizeof(vec4)), 0);
}

TEST(Triangle, DistanceAndWeightsOfTheUnitTriangleAreAccurate) {
    constexpr double LIMIT = 8 * 2 * FLOAT_U; // 8 units in the last place of 1; Embree's own test allows 16
    Random random(3);
    Pairs pairs;
    for (int i = 0; i < 1000000; ++i) {
        double u = random.unit(), v = random.unit();
        if (u + v > 1)
            u = 1 - u, v = 1 - v;
        const glm::dvec3 target(u, v, 0),
            origin = target + random.between(0.25, 1) * random.upper_direction();
        pairs.add(origin, glm::normalize(target - origin), {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    }
    const std::vector<vec4> got = pairs.run("edges");
    double worst_t = 0, worst_b = 0;
    size_t hits = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        if (!is_hit(got[i]))
            continue; // the rounded ray passes outside
        ++hits;
        const glm::dvec3 o = to_dvec3(pairs.origin[i]), d = to_dvec3(pairs.direction[i]);
        const double t = -o.z / d.z;
        const float det = got[i].x + got[i].y + got[i].z;
        // At grazing incidence any error across the ray is a larger one along it and along the plane.
        const double scale = std::max(1.0, 1 / std::abs(d.z) / 8);
        worst_t = std::max(worst_t, std::abs(double(got[i].w / det) - t) / scale);
        worst_b = std::max({worst_b, std::abs(double(got[i].y / det) - (o.x + t * d.x)) / scale,
                            std::abs(double(got[i].z / det) - (o.y + t * d.y)) / scale});
    }
    RecordProperty("worst_t_in_u", std::to_string(worst_t / FLOAT_U));
    RecordProperty("worst_b_in_u", std::to_string(worst_b / FLOAT_U));
    EXPECT_GT(hits, 999000u);
    EXPECT_LE(worst_t, LIMIT);
    EXPECT_LE(worst_b, LIMIT);
}

// A corner is off by at most u (2 |x| + 4 |z|) on each axis across the ray where divisions are exact, and by
// u (2 |x| + 8 |z|) where they are off by 2.5 units in the last place (kernels/geometry/box.h): sqrt(2) times
// that in all.
TEST(Triangle, NeedlesAtGrazingIncidenceAreNotHitFromAfar) {
    const double limit = (divides_exactly() ? 8.5 : 14.2) * FLOAT_U;
    Random random(4);
    Pairs pairs;
    while (pairs.origin.size() < 1000000) {
        // A needle of aspect above 10 and a ray within a degree of its plane.
        const glm::dvec3 p0 = random.in_cube(1), along = random.direction();
        const glm::dvec3 across = glm::normalize(glm::cross(along, random.direction()));
        const double width = std::abs(random.signed_log(1e-7, 0.1));
        const glm::dvec3 p1 = p0 + along, p2 = p0 + along * random.unit() + across * width;
        const glm::dvec3 normal = glm::cross(along, across);
        const glm::dvec3 target = p0 + along * random.unit() + across * (width * random.between(-1, 2));
        const double angle = random.between(0, 2 * PI);
        const glm::dvec3 way =
            along * std::cos(angle) + across * std::sin(angle) + normal * random.between(0, 0.017);
        pairs.add(target - way * random.between(0.1, 3), glm::normalize(way), p0, p1, p2);
    }
    const std::vector<vec4> got = pairs.run("edges");
    double farthest = 0, outside = 0;
    size_t hits = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        if (!is_hit(got[i]))
            continue;
        ++hits;
        const Sheared seen = shear(pairs, i);
        farthest = std::max(farthest, distance_to(seen) / seen.reach);
        const auto [low, high] = std::minmax({seen.depths[0], seen.depths[1], seen.depths[2]});
        const double t = got[i].w / (got[i].x + got[i].y + got[i].z);
        outside = std::max(outside, std::max(low - t, t - high) / std::max(std::abs(low), std::abs(high)));
    }
    RecordProperty("farthest_in_u", std::to_string(farthest / FLOAT_U));
    RecordProperty("outside_in_u", std::to_string(outside / FLOAT_U));
    EXPECT_GT(hits, 100000u);
    EXPECT_LE(farthest, limit);
    EXPECT_LE(outside, 8 * FLOAT_U);
}

} // namespace clrt
