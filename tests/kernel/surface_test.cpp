// SPDX-License-Identifier: Apache-2.0
// geometry/surface.h: hit points, normals, sides, texture derivatives, the curved surface, and rays that
// leave a triangle without meeting it again.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "support/test_device.h"

#include <array>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        // a: barycentric weights 1 and 2, triangle; b: wo; c: direction that leaves
        const std::string surface =
            "Hit hit; hit.t = REAL(1.0); hit.b1 = (real)a.x; hit.b2 = (real)a.y; "
            "hit_set_triangle(0u, as_uint(a.z), &hit);"
            "const Ray ray_there = ray_make((real3)(REAL(0.0)), -vector_from(b), REAL(0.0));"
            "const Surface surface = surface_at(scene, &hit, &ray_there);";
        SceneProbe made(test_device(), {"geometry/surface.h", "geometry/triangle.h"});
        made.add("geometry", surface + "first = probe_vec4(surface.position, surface.offset);"
                                       "second = probe_vec4(surface.normal_g, surface.front ? 1.0f : 0.0f);"
                                       "third = probe_vec4(surface.normal_s, 0.0f);");
        made.add("shape", surface + "first = probe_vec4(surface.tangent, surface.uv.x);"
                                    "second = probe_vec4(surface.bitangent, surface.uv.y);"
                                    "third = probe_vec4(surface.bulge, 0.0f);");
        made.add("labels",
                 surface + "first = (vec4)(as_float(surface.emitter), as_float(surface.material), 0, 0);");
        made.add("origin", surface + "first = probe_vec4(surface_origin(&surface, surface_reflects(&surface, "
                                     "vector_from(c)), vector_from(c)), 0.0f);");
        // Meets the same triangle again, by the arithmetic of the traversal: first.x is 1.
        made.add("leave", surface + R"(
            const Ray ray = surface_ray(&surface, surface_reflects(&surface, vector_from(c)), vector_from(c));
            const RayShear shear = ray_shear_make(&ray);
            real3 p[3];
            surface_corners(scene, scene->triangles + hit.triangle, &p[0], &p[1], &p[2]);
            real x[3], y[3], z[3];
            for (int k = 0; k < 3; ++k) {
                const real3 permuted = ray_permuted(p[k], shear.kz);
                x[k] = permuted.x;
                y[k] = permuted.y;
                z[k] = permuted.z;
            }
            real u, v, w, det, t_det;
            triangle_edges(&shear, x, y, z, &u, &v, &w, &det, &t_det);
            const bool inside = (u >= REAL(0.0) && v >= REAL(0.0) && w >= REAL(0.0)) ||
                                (u <= REAL(0.0) && v <= REAL(0.0) && w <= REAL(0.0));
            first.x = inside && det != REAL(0.0) && t_det / det > REAL(0.0) ? 1.0f : 0.0f;
            first.y = inside && det != REAL(0.0) ? 1.0f : 0.0f;)");
        return made;
    }();
    return instance;
}

/// A scene of separate triangles.
struct Triangles {
    Scene scene;

    u32 add(const dvec3& p0, const dvec3& p1, const dvec3& p2) {
        Triangle triangle{};
        triangle.v0 = u32(scene.positions.size());
        triangle.v1 = triangle.v0 + 1;
        triangle.v2 = triangle.v0 + 2;
        triangle.n0 = triangle.n1 = triangle.n2 = triangle.t0 = triangle.t1 = triangle.t2 = NO_INDEX;
        triangle.emitter = NO_INDEX;
        for (const dvec3& p : {p0, p1, p2})
            scene.positions.push_back(to_vec4(p));
        scene.triangles.push_back(triangle);
        return u32(scene.triangles.size() - 1);
    }
    void set_normals(u32 index, const dvec3& n0, const dvec3& n1, const dvec3& n2) {
        Triangle& triangle = scene.triangles[index];
        triangle.n0 = u32(scene.normals.size());
        triangle.n1 = triangle.n0 + 1;
        triangle.n2 = triangle.n0 + 2;
        for (const dvec3& n : {n0, n1, n2})
            scene.normals.push_back(to_vec4(n));
    }
    void set_uvs(u32 index, const std::array<float, 6>& uvs) {
        Triangle& triangle = scene.triangles[index];
        triangle.t0 = u32(scene.uvs.size() / 2);
        triangle.t1 = triangle.t0 + 1;
        triangle.t2 = triangle.t0 + 2;
        scene.uvs.insert(scene.uvs.end(), uvs.begin(), uvs.end());
    }
    dvec3 corner(u32 index, u32 k) const { return to_dvec3(scene.positions[size_t{3} * index + k]); }
    dvec3 winding_normal(u32 index) const {
        return glm::normalize(
            glm::cross(corner(index, 1) - corner(index, 0), corner(index, 2) - corner(index, 0)));
    }
    double extent(u32 index) const {
        const dvec3 low = glm::min(corner(index, 0), glm::min(corner(index, 1), corner(index, 2)));
        const dvec3 high = glm::max(corner(index, 0), glm::max(corner(index, 1), corner(index, 2)));
        return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    }
};

vec4 hit(double b1, double b2, u32 triangle) {
    return {float(b1), float(b2), bits_to_float(triangle), 0};
}

/// A uniform point, or every fourth time one on an edge or in a corner.
vec4 random_hit(Random& random, u32 triangle) {
    double b1 = random.unit(), b2 = random.unit();
    if (b1 + b2 > 1) {
        b1 = 1 - b1;
        b2 = 1 - b2;
    }
    switch (random.word() % 16) {
    case 0:
        return hit(0, b2, triangle);
    case 1:
        return hit(b1, 0, triangle);
    case 2:
        return hit(b1, 1 - b1, triangle);
    case 3:
        return hit(triangle % 2, 0, triangle);
    default:
        return hit(b1, b2, triangle);
    }
}

/// Triangles of the normalised frame (|coordinate| up to 2) with edges of 1e-8 to 1 at up to ten thousand
/// times that from the origin, every other one a needle.
Triangles hard_triangles(size_t count, u32 seed) {
    Random random(seed);
    Triangles triangles;
    while (triangles.scene.triangles.size() < count) {
        const double size = std::abs(random.signed_log(1e-8, 1));
        const dvec3 centre =
            random.direction() * std::min(1.0, size * std::abs(random.signed_log(1e-2, 1e4)));
        const dvec3 across = random.direction();
        const double width =
            triangles.scene.triangles.size() % 2 ? std::abs(random.signed_log(1e-3, 1)) : 1.0;
        const dvec3 p = centre + random.in_cube(1) * size, q = p + across * size;
        const dvec3 r = p + across * size * random.unit() + random.in_cube(1) * size * width;
        const auto rounded = [](const dvec3& v) { return to_dvec3(to_vec4(v)); };
        const double area = glm::length(glm::cross(rounded(q) - rounded(p), rounded(r) - rounded(p)));
        if (area > 1e-6 * size * size) // not rounded to a line
            triangles.add(p, q, r);
    }
    return triangles;
}

dvec3 towards(const dvec3& direction, const dvec3& side) {
    return glm::dot(direction, side) < 0 ? -direction : direction;
}

} // namespace

TEST(Surface, RaysThatLeaveATriangleNeverMeetItAgain) {
    constexpr u32 TRIANGLES = 20000, RAYS = 16;
    const Triangles triangles = hard_triangles(TRIANGLES, 1);
    Random random(2);
    std::vector<vec4> hits, wo, w;
    for (u32 i = 0; i < TRIANGLES; ++i)
        for (u32 k = 0; k < RAYS; ++k) {
            hits.push_back(random_hit(random, i));
            wo.push_back(to_vec4(random.direction()));
            // Every other ray grazes: within a thousandth of the plane, down to rounding.
            const dvec3 n = triangles.winding_normal(i),
                        along = glm::normalize(glm::cross(n, random.direction()));
            const dvec3 grazing = along + n * random.signed_log(1e-9, 1e-3);
            w.push_back(to_vec4(k % 2 ? glm::normalize(grazing) : random.direction()));
        }
    const std::vector<vec4> got = probe().run("leave", triangles.scene, RenderParams{}, hits, wo, w).first;
    size_t met = 0, behind = 0;
    for (const vec4& result : got) {
        met += result.x != 0;
        behind += result.y != 0;
    }
    EXPECT_EQ(met, 0u);
    EXPECT_GT(behind, got.size() / 4); // lines that do cross the triangle, behind the ray's start
}

TEST(Surface, PointsLieOnTheTriangleWithinTheirBound) {
    constexpr u32 TRIANGLES = 50000;
    const Triangles triangles = hard_triangles(TRIANGLES, 3);
    Random random(4);
    std::vector<vec4> hits, wo;
    for (u32 i = 0; i < TRIANGLES; ++i) {
        hits.push_back(random_hit(random, i));
        wo.push_back(to_vec4(random.direction()));
    }
    const SceneProbe::Outputs got = probe().run("geometry", triangles.scene, RenderParams{}, hits, wo);
    for (u32 i = 0; i < TRIANGLES; ++i) {
        const dvec3 p0 = triangles.corner(i, 0), e1 = triangles.corner(i, 1) - p0,
                    e2 = triangles.corner(i, 2) - p0;
        const dvec3 position = to_dvec3(got.first[i]);
        const double offset = got.first[i].w;
        ASSERT_LT(std::abs(glm::dot(position - p0, triangles.winding_normal(i))), offset) << i;
        // Points near an edge are drawn in, around a sharp corner by more than the margin.
        const dvec3 exact = p0 + double(hits[i].x) * e1 + double(hits[i].y) * e2;
        const double nearest =
            std::min({double(hits[i].x), double(hits[i].y), 1 - double(hits[i].x) - hits[i].y});
        const bool is_inside = nearest * glm::length(glm::cross(e1, e2)) > 8 * offset * triangles.extent(i);
        ASSERT_LT(glm::length(position - exact), is_inside ? offset : 16 * offset + triangles.extent(i)) << i;
        // The bound itself: a few roundings of the coordinates, a few more of the extent.
        const double largest = std::max({glm::length(p0), glm::length(p0 + e1), glm::length(p0 + e2)});
        ASSERT_LE(offset, FLOAT_U * (4.01 * largest + 24.01 * triangles.extent(i))) << i;
        ASSERT_GE(offset, FLOAT_U * (2.2 * largest + 13.9 * triangles.extent(i))) << i;
    }
}

TEST(Surface, TheGeometricNormalFacesTheEyeAndTheWindingTellsTheFront) {
    constexpr u32 TRIANGLES = 50000;
    Triangles triangles = hard_triangles(TRIANGLES, 5);
    Random random(6);
    std::vector<vec4> hits, wo;
    for (u32 i = 0; i < TRIANGLES; ++i) {
        const dvec3 n = triangles.winding_normal(i);
        if (i % 3 == 1) // given normals that agree with the winding
            triangles.set_normals(i, n, n, n);
        if (i % 3 == 2) // and that contradict it
            triangles.set_normals(i, -n, -n, -n);
        hits.push_back(random_hit(random, i));
        wo.push_back(to_vec4(random.direction()));
    }
    const SceneProbe::Outputs got = probe().run("geometry", triangles.scene, RenderParams{}, hits, wo);
    for (u32 i = 0; i < TRIANGLES; ++i) {
        const dvec3 n = triangles.winding_normal(i), o = to_dvec3(wo[i]);
        if (std::abs(glm::dot(n, o)) < 1e-5)
            continue;
        // Edges are rounded once: needles turn by that over their height.
        const dvec3 p0 = triangles.corner(i, 0), e1 = triangles.corner(i, 1) - p0,
                    e2 = triangles.corner(i, 2) - p0;
        const double longest = std::max(glm::length(e1), glm::length(e2));
        const double sine = glm::length(glm::cross(e1, e2)) / (longest * longest);
        ASSERT_LE(glm::length(to_dvec3(got.second[i]) - towards(n, o)), 4 * FLOAT_U + 4 * FLOAT_U / sine)
            << i;
        const bool winding_side = glm::dot(n, o) > 0;
        ASSERT_EQ(got.second[i].w != 0, i % 3 == 2 ? !winding_side : winding_side) << i;
    }
}

TEST(Surface, SmoothNormalsAreInterpolatedOnTheEyesSide) {
    Triangles triangles;
    Random random(7);
    std::vector<vec4> hits, wo;
    for (u32 i = 0; i < 5000; ++i) {
        triangles.add(random.in_cube(1), random.in_cube(1), random.in_cube(1));
        const dvec3 n = triangles.winding_normal(i) * (i % 2 ? 1.0 : -1.0);
        const auto bent = [&] { return glm::normalize(n + random.direction() * 0.7); };
        const dvec3 n0 = bent(), n1 = bent();
        triangles.set_normals(i, n0, n1, bent());
        hits.push_back(random_hit(random, i));
        wo.push_back(to_vec4(random.direction()));
    }
    const SceneProbe::Outputs got = probe().run("geometry", triangles.scene, RenderParams{}, hits, wo);
    for (u32 i = 0; i < 5000; ++i) {
        const double b1 = hits[i].x, b2 = hits[i].y;
        const auto normal = [&](u32 k) { return to_dvec3(triangles.scene.normals[size_t{3} * i + k]); };
        const dvec3 sum = (1 - b1 - b2) * normal(0) + b1 * normal(1) + b2 * normal(2);
        const double side = got.second[i].w != 0 ? 1 : -1; // front: as given
        ASSERT_LE(glm::length(to_dvec3(got.third[i]) - side * glm::normalize(sum)), 16 * FLOAT_U) << i;
        ASSERT_GT(glm::dot(to_dvec3(got.third[i]), to_dvec3(got.second[i])), 0) << i;
    }
}

TEST(Surface, NormalsThatCancelGiveWayToThePlane) {
    Triangles triangles;
    const u32 flat = triangles.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
              cancelled = triangles.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    triangles.set_normals(cancelled, {1, 0, 0.0}, {-1, 0, 0.0}, {0, 0, 0});
    const SceneProbe::Outputs got =
        probe().run("geometry", triangles.scene, RenderParams{},
                    {hit(0.25, 0.25, flat), hit(0.5, 0, cancelled), hit(0.25, 0.5, cancelled)},
                    std::vector<vec4>(3, {0, 0.6f, 0.8f, 0}));
    for (const size_t i : {0, 1, 2})
        EXPECT_EQ(to_dvec3(got.third[i]), dvec3(0, 0, 1)) << i;
}

TEST(Surface, FlatTrianglesHaveNoBulgeAndCornersNeitherDo) {
    Triangles triangles;
    const dvec3 p[] = {{0, 0, 0}, {1, 0, 0}, {0.25, 1, 0}};
    const u32 plain = triangles.add(p[0], p[1], p[2]), flat = triangles.add(p[0], p[1], p[2]);
    triangles.set_normals(flat, {0, 0, 1}, {0, 0, 1}, {0, 0, 1});
    const u32 round = triangles.add(p[0], p[1], p[2]);
    triangles.set_normals(round, glm::normalize(dvec3(-1, -1, 2)), glm::normalize(dvec3(1, -1, 2)),
                          glm::normalize(dvec3(0, 1, 2)));
    std::vector<vec4> hits, wo;
    for (const double side : {1.0, -1.0}) {
        for (const u32 index : {plain, flat})
            for (const double b : {0.0, 0.1, 0.25, 0.5})
                hits.push_back(hit(b, 0.5 - b / 2, index));
        for (const auto& [b1, b2] : {std::pair{0.0, 0.0}, std::pair{1.0, 0.0}, std::pair{0.0, 1.0}})
            hits.push_back(hit(b1, b2, round));
        wo.resize(hits.size(), to_vec4({0.1, 0.2, side}));
    }
    const std::vector<vec4> bulge = probe().run("shape", triangles.scene, RenderParams{}, hits, wo).third;
    for (size_t i = 0; i < hits.size(); ++i)
        // Corners are drawn in by a few offset bounds.
        EXPECT_LE(glm::length(to_dvec3(bulge[i])), i % 11 < 8 ? 0 : 1e-5) << i;
}

TEST(Surface, RoundedNormalsOfAPlaneAreFlatAndThoseOfAFacetAreNot) {
    // What two decimals make of a plane's normal, and corners of a ball of 200 segments.
    Triangles triangles;
    Random random(10);
    std::vector<vec4> hits, wo;
    constexpr u32 COUNT = 2000;
    for (u32 i = 0; i < COUNT; ++i) {
        triangles.add(random.in_cube(1), random.in_cube(1), random.in_cube(1));
        const dvec3 n = triangles.winding_normal(i);
        const auto rounded = [&] { // as exporters write it: each corner's last digit may fall either way
            return glm::normalize(glm::round(100.0 * n + random.in_cube(1e-3)) / 100.0);
        };
        if (i % 2 == 0)
            triangles.set_normals(i, rounded(), rounded(), rounded());
        else {
            const dvec3 centre =
                (triangles.corner(i, 0) + triangles.corner(i, 1) + triangles.corner(i, 2)) / 3.0;
            const auto outward = [&](u32 k) {
                return glm::normalize(n + PI / 200 * glm::normalize(triangles.corner(i, k) - centre));
            };
            triangles.set_normals(i, outward(0), outward(1), outward(2));
        }
        hits.push_back(hit(0.3, 0.4, i));
        wo.push_back(to_vec4(n));
    }
    const std::vector<vec4> bulge = probe().run("shape", triangles.scene, RenderParams{}, hits, wo).third;
    for (u32 i = 0; i < COUNT; ++i)
        ASSERT_EQ(to_dvec3(bulge[i]) == dvec3(0), i % 2 == 0) << i;
}

TEST(Surface, ContradictoryNormalsLiftNoPointBelowThePlane) {
    Triangles triangles;
    Random random(11);
    std::vector<vec4> hits, wo;
    constexpr u32 COUNT = 20000;
    for (u32 i = 0; i < COUNT; ++i) {
        triangles.add(random.in_cube(1), random.in_cube(1), random.in_cube(1));
        const dvec3 n0 = random.direction(), n1 = random.direction();
        triangles.set_normals(i, n0, n1, random.direction());
        hits.push_back(random_hit(random, i));
        wo.push_back(to_vec4(random.direction()));
    }
    const std::vector<vec4> bulge = probe().run("shape", triangles.scene, RenderParams{}, hits, wo).third;
    const SceneProbe::Outputs got = probe().run("geometry", triangles.scene, RenderParams{}, hits, wo);
    size_t lifted = 0;
    for (u32 i = 0; i < COUNT; ++i) {
        const double rounding = 1e-6 * glm::length(to_dvec3(bulge[i]));
        ASSERT_GE(glm::dot(to_dvec3(bulge[i]), to_dvec3(got.second[i])), -rounding) << i;
        ASSERT_GE(glm::dot(to_dvec3(bulge[i]), to_dvec3(got.third[i])), -rounding) << i;
        lifted += to_dvec3(bulge[i]) != dvec3(0);
    }
    EXPECT_GT(lifted, COUNT / 10);
}

TEST(Surface, PointsAreLiftedToTheCurvedSurfaceOnItsRoundSideOnly) {
    // A triangle inscribed in the unit sphere, with the sphere's normals and with those of a hollow: then its
    // round side is behind. The curved surface lies between the chord and the tangent planes.
    const dvec3 p[] = {glm::normalize(dvec3(-0.2, -0.15, 1)), glm::normalize(dvec3(0.2, -0.15, 1)),
                       glm::normalize(dvec3(0, 0.25, 1))};
    for (const double round_side : {1.0, -1.0}) {
        const dvec3 bend(round_side, round_side, 1), n[] = {p[0] * bend, p[1] * bend, p[2] * bend};
        Triangles triangles;
        triangles.add(p[0], p[1], p[2]);
        triangles.set_normals(0, n[0], n[1], n[2]);
        Random random(8);
        std::vector<vec4> hits;
        for (int i = 0; i < 2000; ++i)
            hits.push_back(random_hit(random, 0));
        const auto seen_from = [&](double side) {
            const std::vector<vec4> wo(hits.size(), to_vec4({0.1, 0.2, side}));
            return probe().run("shape", triangles.scene, RenderParams{}, hits, wo).third;
        };
        const std::vector<vec4> round = seen_from(round_side), hollow = seen_from(-round_side);
        for (size_t i = 0; i < hits.size(); ++i) {
            const double b[] = {1 - double(hits[i].x) - hits[i].y, hits[i].x, hits[i].y};
            const dvec3 position = b[0] * p[0] + b[1] * p[1] + b[2] * p[2];
            dvec3 bulge(0); // Hanika's projections on the corners' tangent planes
            for (u32 k = 0; k < 3; ++k)
                bulge -= b[k] * glm::dot(position - p[k], n[k]) * n[k];
            ASSERT_LE(glm::length(to_dvec3(round[i]) - bulge), 1e-5) << i;
            ASSERT_GE(round[i].z * round_side, 0) << i;
            // Rays that leave the hollow side meet nothing of the chord.
            ASSERT_LE(glm::length(to_dvec3(hollow[i])), 1e-5) << i;
        }
    }
}

TEST(Surface, TextureCoordinatesAndTheirDerivativesMatchTheEdges) {
    constexpr u32 TRIANGLES = 5000;
    Triangles triangles;
    Random random(9);
    std::vector<vec4> hits, wo;
    for (u32 i = 0; i < TRIANGLES; ++i) {
        triangles.add(random.in_cube(1), random.in_cube(1), random.in_cube(1));
        std::array<float, 6> uvs;
        for (float& value : uvs)
            value = float(random.between(-3, 3));
        triangles.set_uvs(i, uvs);
        hits.push_back(random_hit(random, i));
        wo.push_back(to_vec4(random.direction()));
    }
    const SceneProbe::Outputs got = probe().run("shape", triangles.scene, RenderParams{}, hits, wo);
    for (u32 i = 0; i < TRIANGLES; ++i) {
        const auto uv = [&](u32 k) {
            return dvec3(triangles.scene.uvs[size_t{6} * i + 2 * k],
                         triangles.scene.uvs[size_t{6} * i + 2 * k + 1], 0);
        };
        const dvec3 d1 = uv(1) - uv(0), d2 = uv(2) - uv(0),
                    at = uv(0) + double(hits[i].x) * d1 + double(hits[i].y) * d2;
        ASSERT_NEAR(got.first[i].w, at.x, 32 * FLOAT_U) << i;
        ASSERT_NEAR(got.second[i].w, at.y, 32 * FLOAT_U) << i;
        const dvec3 tangent = to_dvec3(got.first[i]), bitangent = to_dvec3(got.second[i]);
        const dvec3 e1 = triangles.corner(i, 1) - triangles.corner(i, 0),
                    e2 = triangles.corner(i, 2) - triangles.corner(i, 0);
        const double size = 32 * FLOAT_U * (6 * (glm::length(tangent) + glm::length(bitangent)) + 2);
        ASSERT_LE(glm::length(d1.x * tangent + d1.y * bitangent - e1), size) << i;
        ASSERT_LE(glm::length(d2.x * tangent + d2.y * bitangent - e2), size) << i;
    }
}

TEST(Surface, DegenerateOrAbsentTextureCoordinatesHaveNoTangents) {
    Triangles triangles;
    for (int i = 0; i < 3; ++i)
        triangles.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    triangles.set_uvs(1, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f});
    triangles.set_uvs(2, {0, 0, 1, 1, 0.5f, 0.5f});
    const SceneProbe::Outputs got = probe().run("shape", triangles.scene, RenderParams{},
                                                {hit(0.25, 0.25, 0), hit(0.25, 0.25, 1), hit(0.25, 0.25, 2)},
                                                std::vector<vec4>(3, {0, 0, 1, 0}));
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(to_dvec3(got.first[i]), dvec3(0)) << i;
        EXPECT_EQ(to_dvec3(got.second[i]), dvec3(0)) << i;
    }
    EXPECT_EQ(got.first[0].w, 0);
    EXPECT_EQ(got.first[1].w, 0.5f);
    EXPECT_NEAR(got.first[2].w, 0.375, 1e-7);
}

TEST(Surface, RaysStartOnTheirOwnSideOfThePlane) {
    Triangles triangles;
    triangles.add({0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5});
    const vec4 at = hit(0.25, 0.5, 0);
    const std::vector<vec4> w = {
        {0, 0, 1, 0}, {0.6f, 0, -0.8f, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0.6f, 0, -0.8f, 0}};
    const vec4 above = {0, 0, 1, 0}, below = {0, 0, -1, 0};
    const SceneProbe::Outputs got =
        probe().run("origin", triangles.scene, RenderParams{}, std::vector<vec4>(5, at),
                    {above, above, above, below, below}, w);
    EXPECT_GT(got.first[0].z, 0.5f);
    EXPECT_LT(got.first[1].z, 0.5f);
    EXPECT_GT(got.first[2].z, 0.5f); // along the plane: on the eye's side
    EXPECT_GT(got.first[3].z, 0.5f);
    EXPECT_LT(got.first[4].z, 0.5f);
}

TEST(Surface, RaysStartOnTheCurvedSurfaceWhereTheFacetWouldHideAllFromThem) {
    const dvec3 p[] = {{-0.3, -0.2, 0.9}, {0.3, -0.2, 0.9}, {0, 0.4, 0.9}};
    Triangles triangles;
    triangles.add(p[0], p[1], p[2]);
    triangles.set_normals(0, glm::normalize(p[0]), glm::normalize(p[1]), glm::normalize(p[2]));
    const vec4 above = {0, 0, 1, 0};
    // There the normal leans to +x: over the plane, reflected below it, through the surface.
    const std::vector<vec4> w = {
        {-0.8f, 0, 0.6f, 0}, {0, 0, 1, 0}, {0.999f, 0, -0.02f, 0}, {0.6f, 0, -0.8f, 0}};
    const std::vector<vec4> hits(4, hit(0.6, 0.2, 0)), wo(4, above);
    const std::vector<vec4> start = probe().run("origin", triangles.scene, RenderParams{}, hits, wo, w).first;
    const std::vector<vec4> bulge = probe().run("shape", triangles.scene, RenderParams{}, hits, wo).third;
    ASSERT_GT(bulge[0].z, 1e-3f);
    EXPECT_NEAR(start[0].z, 0.9, 1e-5);
    EXPECT_NEAR(start[1].z, 0.9, 1e-5);
    EXPECT_NEAR(start[2].z, 0.9 + bulge[2].z, 1e-5);
    EXPECT_NEAR(start[3].z, 0.9, 1e-5);
    EXPECT_LT(start[3].z, 0.9f);
}

TEST(Surface, LabelsAreThoseOfTheTriangle) {
    Triangles triangles;
    for (u32 i = 0; i < 4; ++i) {
        triangles.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
        triangles.scene.triangles[i].material = 10 + i;
        triangles.scene.triangles[i].emitter = i == 2 ? 7 : NO_INDEX;
    }
    const std::vector<vec4> got =
        probe()
            .run("labels", triangles.scene, RenderParams{},
                 {hit(0, 0, 0), hit(0, 0, 1), hit(0, 0, 2), hit(0, 0, 3)}, std::vector<vec4>(4, {0, 0, 1, 0}))
            .first;
    for (u32 i = 0; i < 4; ++i) {
        EXPECT_EQ(float_to_bits(got[i].y), 10 + i);
        EXPECT_EQ(float_to_bits(got[i].x), i == 2 ? 7 : NO_INDEX);
    }
}
