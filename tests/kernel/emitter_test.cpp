// SPDX-License-Identifier: Apache-2.0
// lights/emitter.h and light_sample.h: points on emissive triangles, their density per steradian from both
// techniques, sides, and shadow rays that do not meet the light they are sent to.
#include "probes/scene_probe.h"
#include "probes/statistics.h"
#include "scene/lights.h"
#include "support/light_numbers.h"
#include "support/solid_angle.h"
#include "support/test_device.h"

#include <glm/vec2.hpp>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec2;
using glm::dvec3;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"lights/emitter.h", "geometry/triangle.h"});
        // a: position, second number; b: words
        const std::string sample =
            "const LightSample s = emitter_sample(scene, params, vector_from(a), as_uint(b.x), "
            "as_uint(b.y), a.w);";
        made.add(
            "sample",
            sample +
                "first = probe_vec4(s.wi, s.pdf_w); second = probe_vec4(s.radiance, 0.0f);"
                "third = probe_vec4(s.target, (s.is_distant ? 1.0f : 0.0f) + (s.is_delta ? 2.0f : 0.0f));");
        // a: barycentric weights 1 and 2, triangle; b: wo; c: the point that the ray left, distance
        made.add("hit_pdf", "Hit hit; hit.t = (real)c.w; hit.b1 = (real)a.x; hit.b2 = (real)a.y;"
                            "hit_set_triangle(0u, as_uint(a.z), &hit);"
                            "const Ray ray_there = ray_make((real3)(REAL(0.0)), -vector_from(b), REAL(0.0));"
                            "const Surface surface = surface_at(scene, &hit, &ray_there);"
                            "first.x = emitter_hit_pdf_w(scene, &surface, "
                            "(real)scene->emitters[surface.emitter].pdf_a, vector_from(c), hit.t, "
                            "vector_from(b));");
        made.add("pdf", "first.x = emitter_pdf_w((real)a.x, (real)a.y, (real)a.z);");
        // b.z: the light's triangle. first.x: the shadow ray meets it; first.y: the unbounded line does.
        made.add("shadow", sample + R"(
            Surface surface;
            surface.position = vector_from(a);
            surface.normal_g = s.wi;
            surface.bulge = (real3)(REAL(0.0));
            surface.is_curved = false;
            surface.offset = REAL(0.0);
            const Ray ray = light_shadow_ray(&surface, &s);
            const RayShear shear = ray_shear_make(&ray);
            real3 p[3];
            surface_corners(scene, scene->triangles + as_uint(b.z), &p[0], &p[1], &p[2]);
            real x[3], y[3], z[3];
            for (int k = 0; k < 3; ++k) {
                const real3 permuted = ray_permuted(p[k], shear.kz);
                x[k] = permuted.x;
                y[k] = permuted.y;
                z[k] = permuted.z;
            }
            real u, v, w, det, t_det;
            triangle_edges(&shear, x, y, z, &u, &v, &w, &det, &t_det);
            const bool inside = ((u >= REAL(0.0) && v >= REAL(0.0) && w >= REAL(0.0)) ||
                                 (u <= REAL(0.0) && v <= REAL(0.0) && w <= REAL(0.0))) && det != REAL(0.0);
            const real t = t_det / det;
            first.x = inside && t > REAL(0.0) && t <= ray.t_max ? 1.0f : 0.0f;
            first.y = inside && t > REAL(0.0) ? 1.0f : 0.0f;
            first.z = vector_length(ray.origin + ray.t_max * ray.direction - vector_from(a));
            first.w = s.pdf_w;)");
        return made;
    }();
    return instance;
}

/// Emissive triangles, each with a material of its own.
struct Lamps {
    Scene scene;
    std::vector<double> exitance;
    double power = 0;

    u32 add(const dvec3& p0, const dvec3& p1, const dvec3& p2, const dvec3& radiance, u32 flags = 0) {
        Triangle triangle{};
        triangle.v0 = u32(scene.positions.size());
        triangle.v1 = triangle.v0 + 1;
        triangle.v2 = triangle.v0 + 2;
        triangle.n0 = triangle.n1 = triangle.n2 = triangle.t0 = triangle.t1 = triangle.t2 = NO_INDEX;
        triangle.material = u32(scene.materials.size());
        for (const dvec3& p : {p0, p1, p2})
            scene.positions.push_back(to_vec4(p));
        scene.triangles.push_back(triangle);
        Material material{};
        material.matte = {0, 0, 0, 1};
        material.emission = to_vec4(radiance);
        material.flags = flags;
        material.map_matte = material.map_specular = material.map_emission = material.map_coverage = NO_INDEX;
        material.map_roughness = material.map_metallic = material.map_normal = material.map_bump = NO_INDEX;
        scene.materials.push_back(material);
        exitance.push_back(0.2126 * radiance.x + 0.7152 * radiance.y + 0.0722 * radiance.z);
        return u32(scene.triangles.size() - 1);
    }
    void finish() {
        Emitters built = build_emitters(scene.positions, scene.triangles, exitance);
        scene.emitters = built.emitters;
        power = built.power;
    }
    RenderParams params() const {
        RenderParams params{};
        params.emitter_count = u32(scene.emitters.size());
        return params;
    }
    dvec3 corner(u32 triangle, u32 k) const { return to_dvec3(scene.positions[size_t{3} * triangle + k]); }
    dvec3 normal(u32 triangle) const {
        return glm::cross(corner(triangle, 1) - corner(triangle, 0),
                          corner(triangle, 2) - corner(triangle, 0));
    }
    double area(u32 triangle) const { return glm::length(normal(triangle)) / 2; }
    /// The triangle that two words choose.
    u32 chosen(u32 word, u32 alias_word) const {
        const u32 slot = u32(uint64_t{word} * scene.emitters.size() >> 32);
        return scene.emitters[alias_word < scene.emitters[slot].threshold ? slot : scene.emitters[slot].alias]
            .triangle;
    }
    /// Barycentric weights 1 and 2 of a point's foot on a triangle.
    glm::dvec2 weights(u32 triangle, const dvec3& p) const {
        const dvec3 n = normal(triangle), p0 = corner(triangle, 0);
        const double all = glm::dot(n, n);
        return {glm::dot(glm::cross(p - p0, corner(triangle, 2) - p0), n) / all,
                glm::dot(glm::cross(corner(triangle, 1) - p0, p - p0), n) / all};
    }
};

/// Five lamps of different size and power around the origin; all show it their fronts.
Lamps five_lamps() {
    Lamps lamps;
    lamps.add({-1, -1, 1.5}, {-1, 1, 1.5}, {1, -1, 1.5}, {1, 1, 1});
    lamps.add({-1, 1, 1.5}, {1, 1, 1.2}, {1, -1, 1.5}, {0.5, 0.25, 0});
    lamps.add({1.5, 0.1, 0}, {1.5, -0.2, 0.3}, {1.5, 0.1, 0.2}, {100, 0, 0});
    lamps.add({0, 1.7, -0.01}, {0.02, 1.7, 0}, {0, 1.7, 0.01}, {0, 50, 3000});
    lamps.add({-1.5, -1, -1}, {-1.5, 1, -1}, {-1.5, -1, 1}, {0.01, 0.02, 0.03});
    for (u32 triangle = 0; triangle < 5; ++triangle)
        if (glm::dot(lamps.normal(triangle), lamps.corner(triangle, 0)) > 0) {
            Triangle& t = lamps.scene.triangles[triangle];
            std::swap(lamps.scene.positions[t.v1], lamps.scene.positions[t.v2]);
        }
    lamps.finish();
    return lamps;
}

/// Whether points are chosen by solid angle (spherical_triangle.h).
bool looks_large(const dvec3& a, const dvec3& b, const dvec3& c) {
    const double whole = solid_angle(a, b, c), distance = glm::length(a + b + c) / 3;
    const double if_small = std::abs(glm::dot(a, glm::cross(b - a, c - a))) / 2 / std::pow(distance, 3);
    const bool is_near = if_small > 0.25 || distance < std::max(glm::length(b - a), glm::length(c - a));
    return is_near && whole >= 0.25 && whole <= 6.27;
}

/// Congruent parts of a triangle, by squares of the weights folded over the diagonal.
constexpr u32 SIDE = 5;
constexpr u32 PARTS = SIDE * SIDE;

/// Row r has 2 (SIDE - r) - 1 parts.
u32 part_index(u32 column, u32 row, bool upper) {
    return std::min(row * (2 * SIDE - row) + 2 * column + upper, PARTS - 1);
}

u32 part_of(const glm::dvec2& b) {
    const double x = std::clamp(b.x, 0.0, 0.999999) * SIDE, y = std::clamp(b.y, 0.0, 0.999999) * SIDE;
    const u32 column = u32(x), row = u32(y);
    return part_index(column, row, x - column + y - row > 1);
}

/// The share of every part in the points that are chosen on a triangle seen from a position.
std::vector<double> part_shares(const Lamps& lamps, u32 triangle, const dvec3& position) {
    std::vector<double> shares(PARTS, 1.0 / PARTS);
    const dvec3 a = lamps.corner(triangle, 0) - position, e1 = lamps.corner(triangle, 1) - position - a,
                e2 = lamps.corner(triangle, 2) - position - a;
    const double whole = solid_angle(a, a + e1, a + e2);
    if (!looks_large(a, a + e1, a + e2))
        return shares;
    const auto corner = [&](u32 x, u32 y) { return a + (double(x) * e1 + double(y) * e2) / double(SIDE); };
    for (u32 y = 0; y < SIDE; ++y)
        for (u32 x = 0; x + y < SIDE; ++x) {
            shares[part_index(x, y, false)] =
                solid_angle(corner(x, y), corner(x + 1, y), corner(x, y + 1)) / whole;
            if (x + y + 1 < SIDE)
                shares[part_index(x, y, true)] =
                    solid_angle(corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)) / whole;
        }
    return shares;
}

/// p-value of the points that are chosen as seen from a position; each lies on its triangle.
double points_p_value(const Lamps& lamps, const dvec3& position, size_t samples, u32 seed) {
    const LightNumbers numbers = light_numbers_at(position, samples, seed);
    const std::vector<vec4> targets =
        probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words).third;
    const u32 triangles = u32(lamps.scene.triangles.size());
    std::vector<double> counts(size_t{triangles} * PARTS), expected;
    for (u32 triangle = 0; triangle < triangles; ++triangle) // pi area luminance, over the sum
        for (const double share : part_shares(lamps, triangle, to_dvec3(to_vec4(position))))
            expected.push_back(double(samples) * PI * lamps.area(triangle) * lamps.exitance[triangle] /
                               lamps.power * share);
    for (size_t i = 0; i < samples; ++i) {
        const u32 triangle =
            lamps.chosen(float_to_bits(numbers.words[i].x), float_to_bits(numbers.words[i].y));
        const glm::dvec2 b = lamps.weights(triangle, to_dvec3(targets[i]));
        EXPECT_TRUE(b.x > -1e-4 && b.y > -1e-4 && b.x + b.y < 1 + 1e-4) << i;
        EXPECT_NEAR(glm::dot(to_dvec3(targets[i]) - lamps.corner(triangle, 0),
                             glm::normalize(lamps.normal(triangle))),
                    0, 1e-5);
        if (::testing::Test::HasFailure())
            break;
        ++counts[triangle * PARTS + part_of(b)];
    }
    return chi_squared_test(counts, expected).p_value;
}

/// One triangle that shines on both sides.
Lamps one_lamp(const dvec3& p0, const dvec3& p1, const dvec3& p2) {
    Lamps lamps;
    lamps.add(p0, p1, p2, {1, 1, 1}, MATERIAL_EMITS_BOTH_SIDES);
    lamps.finish();
    return lamps;
}

} // namespace

TEST(Emitter, FarTrianglesAreChosenByPowerAndPointsByArea) {
    Lamps lamps = five_lamps();
    for (Material& material : lamps.scene.materials)
        material.flags |= MATERIAL_EMITS_BOTH_SIDES;
    EXPECT_GT(points_p_value(lamps, {0.1, -0.2, 12}, 400000, 1), SMALLEST_P);
}

TEST(Emitter, PointsOfNearTrianglesAreChosenBySolidAngle) {
    const Lamps lamps = five_lamps();
    for (const dvec3& position : {dvec3(0.1, -0.2, 0), dvec3(0.5, -0.3, 1.0)})
        EXPECT_GT(points_p_value(lamps, position, 400000, 1), SMALLEST_P) << position.z;
}

TEST(Emitter, PointsAreUniformInSolidAngleFromNearlyNothingToNearlyAHalfSpace) {
    // Over the middle, an edge, a corner, and beside a needle's end.
    const Lamps lamps = one_lamp({-0.4, -0.5, 0}, {0.8, -0.3, 0}, {-0.1, 0.9, 0});
    const Lamps needle = one_lamp({-1, 0, 0}, {1, 0.02, 0}, {1, -0.02, 0});
    u32 seed = 20, large = 0;
    for (const double height : {1.5, 0.5, 0.1, 0.02, 0.005, 0.002})
        for (const dvec2& at : {dvec2(0, 0), dvec2(0.2, -0.4), dvec2(-0.1, 0.89), dvec2(-0.5, -0.6)}) {
            const dvec3 position(at.x, at.y, height);
            EXPECT_GT(points_p_value(lamps, position, 100000, ++seed), SMALLEST_P) << at.x << " " << height;
            EXPECT_GT(points_p_value(needle, position, 100000, ++seed), SMALLEST_P) << at.x << " " << height;
            large += looks_large(lamps.corner(0, 0) - position, lamps.corner(0, 1) - position,
                                 lamps.corner(0, 2) - position);
        }
    EXPECT_GT(large, 12u);
}

TEST(Emitter, BothTechniquesSwitchBetweenAngleAndAreaAtTheSamePoint) {
    // Heights around those where the angle passes either limit: the same density from a sample and from a hit
    // there.
    const Lamps lamps = one_lamp({-0.4, -0.5, 0}, {0.8, -0.3, 0}, {-0.1, 0.9, 0});
    const auto angle_at = [&](double height) {
        const dvec3 p(0.05, -0.02, height);
        return solid_angle(lamps.corner(0, 0) - p, lamps.corner(0, 1) - p, lamps.corner(0, 2) - p);
    };
    for (const double limit : {0.25, 6.27}) {
        double low = 1e-4, high = 10; // the angle falls with the height
        for (int k = 0; k < 60; ++k)
            (angle_at(std::sqrt(low * high)) > limit ? low : high) = std::sqrt(low * high);
        LightNumbers numbers = light_numbers_at({0.05, -0.02, low}, 4000, 31);
        for (size_t i = 0; i < numbers.positions.size(); ++i)
            numbers.positions[i].z = float(low * (1 + (double(i) - 2000) * 1e-8));
        const SceneProbe::Outputs got =
            probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words);
        std::vector<vec4> hits, wo, from;
        size_t by_angle = 0;
        for (size_t i = 0; i < numbers.positions.size(); ++i) {
            const dvec3 position = to_dvec3(numbers.positions[i]);
            const glm::dvec2 b = lamps.weights(0, to_dvec3(got.third[i]));
            const dvec3 point = lamps.corner(0, 0) + b.x * (lamps.corner(0, 1) - lamps.corner(0, 0)) +
                                b.y * (lamps.corner(0, 2) - lamps.corner(0, 0));
            hits.push_back({float(b.x), float(b.y), bits_to_float(0), 0});
            wo.push_back(to_vec4(-to_dvec3(got.first[i])));
            from.push_back(to_vec4(position, glm::length(point - position)));
            by_angle += std::abs(got.first[i].w * limit - 1) < 1e-4;
        }
        EXPECT_TRUE(by_angle > 200 && by_angle < 3800) << by_angle;
        const std::vector<vec4> hit =
            probe().run("hit_pdf", lamps.scene, lamps.params(), hits, wo, from).first;
        for (size_t i = 0; i < hit.size(); ++i)
            ASSERT_NEAR(hit[i].x / got.first[i].w, 1, 1e-4) << i << " " << limit;
    }
}

TEST(Emitter, TheDensityIsThatOfTheAreaPerSteradianOrTheReciprocalOfTheSolidAngle) {
    constexpr size_t SAMPLES = 100000;
    const Lamps lamps = five_lamps();
    for (const dvec3& position : {dvec3(0, 0, 0), dvec3(0.9, -0.3, 1.1), dvec3(-1.2, 0.4, -0.8)}) {
        const LightNumbers numbers = light_numbers_at(position, SAMPLES, 2);
        const SceneProbe::Outputs got =
            probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words);
        std::vector<vec4> hits, wo, from, kept;
        for (size_t i = 0; i < SAMPLES; ++i) {
            if (got.first[i].w == 0)
                continue;
            const u32 triangle =
                lamps.chosen(float_to_bits(numbers.words[i].x), float_to_bits(numbers.words[i].y));
            const glm::dvec2 b = lamps.weights(triangle, to_dvec3(got.third[i]));
            const dvec3 p0 = lamps.corner(triangle, 0);
            const dvec3 point =
                p0 + b.x * (lamps.corner(triangle, 1) - p0) + b.y * (lamps.corner(triangle, 2) - p0);
            const dvec3 way = point - to_dvec3(numbers.positions[i]),
                        normal = glm::normalize(lamps.normal(triangle));
            const double cos_l = std::abs(glm::dot(glm::normalize(way), normal));
            const double pdf_a = lamps.exitance[triangle] * PI / lamps.power;
            // Roundings of the point, magnified where the lamp is seen edge-on.
            const double tolerance = 2e-6 + 2e-6 / (cos_l * glm::length(way));
            const dvec3 at = to_dvec3(numbers.positions[i]);
            const dvec3 a = p0 - at, b1 = lamps.corner(triangle, 1) - at, b2 = lamps.corner(triangle, 2) - at;
            const double angle = solid_angle(a, b1, b2);
            const double expected = looks_large(a, b1, b2) ? pdf_a * lamps.area(triangle) / angle
                                                           : pdf_a * glm::dot(way, way) / cos_l;
            ASSERT_NEAR(got.first[i].w / expected, 1, tolerance) << angle;
            ASSERT_LE(glm::length(to_dvec3(got.first[i]) - glm::normalize(way)), 1e-6 / glm::length(way));
            ASSERT_EQ(got.third[i].w, 0); // neither distant nor delta
            hits.push_back({float(b.x), float(b.y), bits_to_float(triangle), 0});
            wo.push_back(to_vec4(-to_dvec3(got.first[i])));
            from.push_back(to_vec4(at, glm::length(way)));
            kept.push_back({got.first[i].w, float(tolerance), 0, 0});
        }
        // The other technique, which hits the lamp by chance, computes the same number.
        const std::vector<vec4> hit =
            probe().run("hit_pdf", lamps.scene, lamps.params(), hits, wo, from).first;
        for (size_t i = 0; i < hit.size(); ++i)
            ASSERT_NEAR(hit[i].x / kept[i].x, 1, 2 * kept[i].y) << i;
    }
}

TEST(Emitter, ReciprocalDensitiesSumToTheSolidAngle) {
    constexpr size_t SAMPLES = 400000;
    const Lamps lamps = five_lamps();
    for (const dvec3& position : {dvec3(0, 0, 0), dvec3(0.5, -0.3, 1.0), dvec3(0.3, 0.3, -1.5)}) {
        const LightNumbers numbers = light_numbers_at(position, SAMPLES, 3);
        std::vector<double> estimates;
        for (const vec4& sample :
             probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words).first)
            estimates.push_back(sample.w > 0 ? 1 / double(sample.w) : 0);
        double exact = 0;
        for (u32 triangle = 0; triangle < 5; ++triangle) {
            const auto seen = [&](u32 k) { return lamps.corner(triangle, k) - position; };
            if (glm::dot(lamps.normal(triangle), seen(0)) < 0)
                exact += solid_angle(seen(0), seen(1), seen(2));
        }
        const Moments moments = moments_of(estimates);
        EXPECT_LT(std::abs(z_of_mean(moments, exact)), 6) << moments.mean << " " << exact;
    }
}

TEST(Emitter, OnlyTheFrontShinesUnlessBothSidesDo) {
    Lamps lamps;
    const dvec3 p0(0, 0, 0), p1(1, 0, 0), p2(0, 1, 0); // winding towards +z
    lamps.add(p0, p1, p2, {1, 2, 3});
    lamps.add(p0, p1, p2, {1, 2, 3}, MATERIAL_EMITS_BOTH_SIDES);
    lamps.add(p0, p1, p2, {1, 2, 3}); // with normals that turn it round
    Triangle& reversed = lamps.scene.triangles[2];
    reversed.n0 = reversed.n1 = reversed.n2 = 0;
    lamps.scene.normals.push_back({0, 0, -1, 0});
    lamps.finish();
    for (const double side : {1.0, -1.0}) {
        const LightNumbers numbers = light_numbers_at({0.2, 0.3, side}, 3000, 4);
        const SceneProbe::Outputs got =
            probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words);
        for (size_t i = 0; i < got.first.size(); ++i) {
            const u32 triangle =
                lamps.chosen(float_to_bits(numbers.words[i].x), float_to_bits(numbers.words[i].y));
            const bool shines = triangle == 1 || (triangle == 0) == (side > 0);
            ASSERT_EQ(got.first[i].w > 0, shines) << triangle << " " << side;
            ASSERT_EQ(to_dvec3(got.second[i]), shines ? dvec3(1, 2, 3) : dvec3(0)) << triangle << " " << side;
        }
    }
}

TEST(Emitter, NothingIsFoundInTheLampsPlaneOrOnIt) {
    Lamps lamps;
    lamps.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}, MATERIAL_EMITS_BOTH_SIDES);
    lamps.finish();
    for (const dvec3& position :
         {dvec3(0, 0, 0), dvec3(1, 0, 0), dvec3(0.25, 0.25, 0), dvec3(5, -3, 0), dvec3(0.5, 0, 0)}) {
        const LightNumbers numbers = light_numbers_at(position, 1000, 5);
        const SceneProbe::Outputs got =
            probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words);
        for (size_t i = 0; i < got.first.size(); ++i)
            ASSERT_TRUE(got.first[i].w == 0 && got.second[i].x == 0) << position.x;
    }
    // And just above it, everything is finite.
    for (const double height : {1e-7, 1e-12, 1e-20, 1e-30}) {
        const LightNumbers numbers = light_numbers_at({0.25, 0.25, height}, 1000, 6);
        for (const vec4& sample :
             probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words).first) {
            ASSERT_FALSE(std::isnan(sample.w)) << height;
            ASSERT_NEAR(glm::length(to_dvec3(sample)), 1, 4 * FLOAT_U) << height;
        }
    }
}

TEST(Emitter, ShadowRaysEndShortOfTheirLampButReachIt) {
    constexpr size_t SAMPLES = 40000;
    Random random(7);
    size_t stopped = 0, reached = 0, all = 0;
    for (int round = 0; round < 20; ++round) {
        // Lamps of all sizes, at all distances of the normalised frame.
        Lamps lamps;
        for (int i = 0; i < 50; ++i) {
            const double size = std::abs(random.signed_log(1e-6, 1));
            const dvec3 p = random.in_cube(1), q = p + random.in_cube(size);
            lamps.add(p, q, q + random.in_cube(size), {1, 1, 1}, MATERIAL_EMITS_BOTH_SIDES);
        }
        lamps.finish();
        LightNumbers numbers = light_numbers_at(random.in_cube(1), SAMPLES / 20, u32(8 + round));
        for (size_t i = 0; i < numbers.words.size(); ++i) {
            vec4& words = numbers.words[i];
            // Equal chances, whatever the size.
            words.x = bits_to_float(random.word());
            words.z = bits_to_float(lamps.chosen(float_to_bits(words.x), float_to_bits(words.y)));
        }
        for (const vec4& result :
             probe().run("shadow", lamps.scene, lamps.params(), numbers.positions, numbers.words).first) {
            all += result.w > 0;
            stopped += result.w > 0 && result.x != 0;
            reached += result.w > 0 && result.y != 0;
        }
    }
    EXPECT_EQ(stopped, 0u);
    EXPECT_GT(double(reached), 0.9 * double(all)); // the lines do go on to the lamp
}

TEST(Emitter, MapsAndCoverageScaleTheRadianceAtThePoint) {
    // Emission rises along u from black to white; coverage is one half.
    Lamps lamps;
    lamps.add({-1, -1, 1}, {-1, 3, 1}, {3, -1, 1}, {2, 4, 8}, MATERIAL_CUT_OUT);
    lamps.scene.triangles[0].t0 = 0;
    lamps.scene.triangles[0].t1 = 1;
    lamps.scene.triangles[0].t2 = 2;
    lamps.scene.uvs = {0.25f, 0.5f, 0.25f, 0.5f, 0.75f, 0.5f};
    Texture texture{};
    texture.width = 2;
    texture.height = 1;
    texture.format = TEXEL_FLOAT;
    texture.scale_u = texture.scale_v = texture.gain = 1;
    lamps.scene.textures.push_back(texture);
    for (const float value : {0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f, 1.0f, 1.0f})
        lamps.scene.texel_words.push_back(float_to_bits(value));
    lamps.scene.materials[0].map_emission = 0;
    lamps.scene.materials[0].matte.w = 0.5f;
    lamps.finish();
    const LightNumbers numbers = light_numbers_at({0, 0, 0}, 5000, 9);
    const SceneProbe::Outputs got =
        probe().run("sample", lamps.scene, lamps.params(), numbers.positions, numbers.words);
    for (size_t i = 0; i < got.first.size(); ++i) {
        const double u =
            lamps.weights(0, to_dvec3(got.third[i])).y; // of the corner at u = 0.75, 0 .. 1 between centres
        ASSERT_LE(glm::length(to_dvec3(got.second[i]) - 0.5 * u * dvec3(2, 4, 8)), 1e-4);
    }
}

TEST(Emitter, DensitiesConvertFromAreaToSteradian) {
    EXPECT_NEAR(probe().run("pdf", Scene{}, RenderParams{}, {{0.5f, 9, 0.25f, 0}}).first[0].x, 0.5 * 9 / 0.25,
                1e-5);
}
