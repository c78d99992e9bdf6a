// SPDX-License-Identifier: Apache-2.0
// Solid angles of triangles, and what sampling by them costs.
#include "stability/cases/shading_expressions.h"
#include "stability/choices.h"

#include "probes/random_inputs.h"

#include <fmt/format.h>

namespace clrt {

namespace {

using glm::dvec3;

/// Columns of the corners relative to the point, then two numbers.
#define CORNERS                                                                                              \
    "const real3 p0 = vector_make(a, b, c), p1 = vector_make(d, e, f), p2 = vector_make(g, h, j);"           \
    "const real3 normal = surface_cross(p1 - p0, p2 - p0);"

/// By van Oosterom and Strackee, against the sum of the angles less pi (Girard).
const ProbedExpression ANGLE = {
    "angle", 9, 1,
    CORNERS "const SphericalTriangle seen = spherical_triangle_make(p0, p1, p2, normal);"
            "out[0] = REAL(2.0) * real_atan2(seen.volume, seen.base + seen.apex);",
    CORNERS
    "const real3 ab = vector_normalize(vector_cross(p0, p1)), bc = vector_normalize(vector_cross(p1, p2)),"
    "ca = vector_normalize(vector_cross(p2, p0));"
    "out[0] = real_acos(-vector_dot(ab, ca)) + real_acos(-vector_dot(ab, bc)) + real_acos(-vector_dot(bc, "
    "ca)) - "
    "REAL_PI;"};

/// Weights and density of a point, by solid angle against by area.
const ProbedExpression POINT = {
    "point", 11, 3,
    CORNERS "const SphericalTriangle seen = spherical_triangle_make(p0, p1, p2, normal);"
            "const real2 at = spherical_triangle_sample(&seen, (real2)(k, l));"
            "out[0] = at.x; out[1] = at.y; out[2] = REAL(1.0) / seen.solid_angle;",
    CORNERS
    "const real2 at = warp_triangle((real2)(k, l)); out[0] = at.x; out[1] = at.y;"
    "const real3 way = p0 + at.x * (p1 - p0) + at.y * (p2 - p0); const real s = vector_dot(way, way);"
    "out[2] = s * real_sqrt(s) * REAL(2.0) * SURFACE_EDGE_SCALE * SURFACE_EDGE_SCALE / fabs(vector_dot(way, "
    "normal));"};

double exact_angle(const dvec3* p) {
    const double x = glm::length(p[0]), y = glm::length(p[1]), z = glm::length(p[2]);
    const double det = glm::dot(p[0], glm::cross(p[1] - p[0], p[2] - p[0]));
    return 2 * std::atan2(std::abs(det), x * y * z + glm::dot(p[0], p[1]) * z + glm::dot(p[1], p[2]) * x +
                                             glm::dot(p[2], p[0]) * y);
}

} // namespace

void solid_angles(CaseRun& run) {
    ProbeSet probes(run.device, {"lights/spherical_triangle.h"}, {ANGLE});
    Figure& large = run.figure("relative error from 3e-4 sr", 1e-5);
    Figure& small = run.figure("relative error below", 1e-4);
    Random random(6);
    Columns inputs(9);
    std::vector<double> expected;
    for (size_t wanted = run.count(1e5, 2e6, 1e7); expected.size() < wanted;) {
        // A triangle around the foot of the point, of any size and turned away by 75 degrees at most.
        const double size = std::abs(random.signed_log(1e-5, 60));
        const dvec3 towards = random.direction(), other = random.direction();
        const dvec3 normal = glm::normalize(towards + 0.8 * other);
        const dvec3 x = glm::normalize(glm::cross(normal, dvec3(0.3, -0.5, 0.8))), y = glm::cross(normal, x);
        dvec3 p[3];
        const double turn = 2 * PI * random.unit();
        for (int k = 0; k < 3; ++k) {
            const double angle = turn + (k + random.between(-0.3, 0.3)) * 2 * PI / 3;
            const dvec3 at =
                towards + size * random.between(0.3, 1) * (std::cos(angle) * x + std::sin(angle) * y);
            p[k] = {float(at.x), float(at.y), float(at.z)};
        }
        const double angle = exact_angle(p);
        if (angle < 1e-10 || angle > 6.2 || glm::dot(normal, towards) < 0.25)
            continue;
        for (int k = 0; k < 9; ++k)
            inputs[size_t(k)].push_back(float(p[k / 3][k % 3]));
        expected.push_back(angle);
    }
    for (const Build build : run.builds()) {
        const std::vector<std::vector<double>> got = probes.run(build, "angle", inputs);
        for (size_t i = 0; i < expected.size(); ++i)
            (expected[i] < 3e-4 ? small : large)[build].see(
                std::abs(got[0][i] / expected[i] - 1), [&] { return fmt::format("{} sr", expected[i]); });
    }
}

ProbeTime time_solid_angle(const ProbeDevice& device, int rounds) {
    Random random(7);
    Columns inputs(11);
    for (int i = 0; i < 1 << 18; ++i) {
        const float corners[] = {-1, -1, 1, 1, -1, 1, 0, 1, 1};
        for (size_t k = 0; k < 9; ++k)
            inputs[k].push_back(corners[k] + float(random.between(-0.2, 0.2)));
        inputs[9].push_back(float(random.unit()));
        inputs[10].push_back(float(random.unit()));
    }
    return ProbeSet(device, {"lights/spherical_triangle.h", "numerics/warp.h"}, {POINT})
        .time("point", inputs, rounds);
}

} // namespace clrt
