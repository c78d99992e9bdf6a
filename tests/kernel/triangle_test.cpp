// SPDX-License-Identifier: Apache-2.0
// The ray-triangle test against exact arithmetic: signs, equal bits in both widths. How exact its hits are is
// in the catalogue (tools/stability/cases/intersection_accuracy_cases.cpp).
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/ray_device.h"
#include "probes/statistics.h"
#include "support/test_device.h"

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
        const real3 permuted = ray_permuted(p[corner], shear->kz);
        x[corner] = permuted.x;
        y[corner] = permuted.y;
        z[corner] = permuted.z;
    }
}

/* u, v, w and the distance times det. */
static float4 edges(float4 origin, float4 direction, float4 p0, float4 p1, float4 p2)
{
    const Ray ray = ray_make(vector_from(origin), vector_from(direction), REAL(0.0));
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
    const Ray ray = ray_make(vector_from(origin), vector_from(direction), REAL(0.0));
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

} // namespace clrt
