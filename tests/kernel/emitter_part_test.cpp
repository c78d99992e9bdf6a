// SPDX-License-Identifier: Apache-2.0
// geometry/emitter_part.h: which part of a lamp a point is on; points that are chosen by a lamp's map, and
// that both techniques give them one density.
#include "probes/scene_probe.h"
#include "probes/scratch_scene.h"
#include "probes/statistics.h"
#include "scene/emitter_parts.h"
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
        SceneProbe made(test_device(), {"lights/emission.h", "geometry/triangle.h"});
        // a: position, second number; b: words. third.w: the emitter
        made.add("sample", "const LightSample s = emitter_sample(scene, params, vector_from(a), "
                           "as_uint(b.x), as_uint(b.y), a.w);"
                           "first = probe_vec4(s.wi, s.pdf_w); second = probe_vec4(s.radiance, 0.0f);"
                           "third = probe_vec4(s.target, as_float(emitter_choose(scene, params, "
                           "as_uint(b.x), as_uint(b.y))));");
        // a: barycentric weights 1 and 2, triangle; b: wo; c: the point that the ray left, distance
        made.add("hit", "Hit hit; hit.t = (real)c.w; hit.b1 = (real)a.x; hit.b2 = (real)a.y;"
                        "hit_set_triangle(0u, as_uint(a.z), &hit);"
                        "const Ray ray_there = ray_make((real3)(REAL(0.0)), -vector_from(b), REAL(0.0));"
                        "const Surface surface = surface_at(scene, &hit, &ray_there);"
                        "first.x = emitter_hit_pdf_w(scene, &surface, "
                        "(real)scene->emitters[surface.emitter].pdf_a, vector_from(c), hit.t, "
                        "vector_from(b)); first.y = as_float(surface.emitter);");
        // a: words of the choice; b.xy: of the direction
        made.add("leave", "EmissionNumbers n; n.words = (uint2)(as_uint(a.x), as_uint(a.y));"
                          "n.alias_word = as_uint(a.z); n.direction = (real2)((real)b.x, (real)b.y);"
                          "const Emission e = emission_sample(scene, params, &n);"
                          "first = probe_vec4(e.point, e.pdf / e.cosine); second = probe_vec4(e.power, 0.0f);"
                          "third.x = as_float(e.light);");
        return made;
    }();
    return instance;
}

/// Two triangles that shine down, one of them larger, by a map with a few bright texels and a frame that
/// covers half.
Scene spotted_lamp(const std::string& keys) {
    ScratchScene scratch;
    std::vector<float> texels(64, 0.02f);
    texels[9] = 5, texels[10] = 3, texels[44] = 9;
    scratch.texture("spots.exr", 8, 8, 1, texels);
    scratch.texture8("mask.png", 2, 1, 1, {255, 90});
    scratch.build.material("lamp", "Kd 0 0 0\nmap_Ke spots.exr\n" + keys).use("lamp");
    scratch.build.textured_quad({{-1, 0.9, -1}, {1, 0.7, -1}, {1.2, 0.8, 1.1}, {-0.7, 1, 0.8}});
    return scratch.load();
}

RenderParams params_of(const Scene& scene) {
    RenderParams params{};
    params.emitter_count = u32(scene.emitters.size());
    params.choose_emitter = params.emit_emitter = 1;
    params.emission_radius = 2;
    return params;
}

dvec3 corner(const Scene& scene, u32 triangle, int k) {
    const Triangle& t = scene.triangles[triangle];
    return to_dvec3(scene.positions[k == 0 ? t.v0 : k == 1 ? t.v1 : t.v2]);
}

/// Barycentric weights 1 and 2 of a point's foot on a triangle.
dvec2 weights_of(const Scene& scene, u32 triangle, const dvec3& p) {
    const dvec3 p0 = corner(scene, triangle, 0), e1 = corner(scene, triangle, 1) - p0,
                e2 = corner(scene, triangle, 2) - p0, n = glm::cross(e1, e2);
    return {glm::dot(glm::cross(p - p0, e2), n) / glm::dot(n, n),
            glm::dot(glm::cross(e1, p - p0), n) / glm::dot(n, n)};
}

/// The emitter that a point of a triangle is on.
u32 emitter_at(const Scene& scene, u32 triangle, const dvec2& b) {
    const u32 first = scene.triangles[triangle].emitter, digits = part_at(EMITTER_LARGEST_LEVEL, b);
    u32 i = first + EMITTER_CODE_PARTS(scene.emitter_parts[first].code);
    while (EMITTER_CODE_DIGITS(scene.emitter_parts[--i].code) > digits) {
    }
    return i;
}

/// Quarters of an emitter as seen from a position: the share of its points that each holds.
std::array<double, 4> quarter_shares(const Scene& scene, u32 emitter, const dvec3& position) {
    const auto p = emitter_corners(scene, emitter);
    const dvec3 a = p[0] - position, e1 = p[1] - p[0], e2 = p[2] - p[0];
    const double whole = solid_angle(a, a + e1, a + e2), distance = glm::length(a + (e1 + e2) / 3.0);
    const double if_small = std::abs(glm::dot(a, glm::cross(e1, e2))) / 2 / std::pow(distance, 3);
    const bool is_near = if_small > 0.25 || distance < std::max(glm::length(e1), glm::length(e2));
    std::array<double, 4> shares{0.25, 0.25, 0.25, 0.25};
    if (!is_near || whole < 0.25)
        return shares;
    for (u32 k = 0; k < 4; ++k) {
        const PartPlace quarter = part_place(1, k);
        const auto at = [&](const dvec2& b) {
            const dvec2 there = quarter.at(b);
            return a + there.x * e1 + there.y * e2;
        };
        shares[k] = solid_angle(at({0, 0}), at({1, 0}), at({0, 1})) / whole;
    }
    return shares;
}

const dvec3 POSITIONS[] = {{0.2, -6, 0.1}, {0.1, -0.6, 0.2}, {-0.3, -0.25, 0.3}};

} // namespace

TEST(EmitterPart, APointIsOnThePartThatTheHostSays) {
    const Scene scene = spotted_lamp("");
    ASSERT_GT(scene.emitter_parts.size(), 32u);
    Random random(2);
    std::vector<vec4> hits, wo, from;
    for (int i = 0; i < 20000; ++i) {
        double x = random.unit(), y = random.unit();
        if (x + y > 1)
            x = 1 - x, y = 1 - y;
        hits.push_back({float(x), float(y), bits_to_float(u32(i % 2)), 0});
        wo.push_back({0, -1, 0, 0});
        from.push_back({0, -1, 0, 1});
    }
    const std::vector<vec4> got = probe().run("hit", scene, params_of(scene), hits, wo, from).first;
    size_t apart = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        const u32 found = float_to_bits(got[i].y);
        ASSERT_LT(found, scene.emitters.size());
        ASSERT_EQ(scene.emitters[found].triangle, i % 2);
        apart += found != emitter_at(scene, u32(i % 2), {double(hits[i].x), double(hits[i].y)});
    }
    EXPECT_LE(apart, 2u); // but for rounding on the borders
}

TEST(EmitterPart, PointsAreChosenByTheTableAndWithinAPartAsOnAnyTriangle) {
    constexpr size_t SAMPLES = 400000;
    const Scene scene = spotted_lamp("");
    u32 seed = 3;
    for (const dvec3& position : POSITIONS) {
        const LightNumbers samples = light_numbers_at(position, SAMPLES, ++seed);
        const std::vector<vec4> got =
            probe().run("sample", scene, params_of(scene), samples.positions, samples.words).third;
        const u32 emitters = u32(scene.emitters.size());
        std::vector<double> counts(4 * size_t(emitters)), expected(counts.size());
        for (u32 e = 0; e < emitters; ++e) {
            const auto shares = quarter_shares(scene, e, to_dvec3(to_vec4(position)));
            for (u32 k = 0; k < 4; ++k)
                expected[4 * e + k] =
                    double(SAMPLES) * double(scene.emitters[e].pdf_a) * emitter_area(scene, e) * shares[k];
        }
        size_t elsewhere = 0;
        for (const vec4& target : got) {
            const u32 chosen = float_to_bits(target.w), triangle = scene.emitters[chosen].triangle;
            const dvec2 b = weights_of(scene, triangle, to_dvec3(target));
            const u32 e = emitter_at(scene, triangle, b);
            elsewhere += e != chosen;
            const PartPlace place = emitter_place(scene, e);
            ++counts[4 * e + part_at(1, (b - place.origin) / place.step)];
        }
        EXPECT_LT(elsewhere, SAMPLES / 1000) << "targets are off the part only by the error bound";
        EXPECT_GT(chi_squared_test(counts, expected).p_value, SMALLEST_P) << position.y;
    }
}

TEST(EmitterPart, AHitHasTheDensityOfTheSample) {
    const Scene scene = spotted_lamp("");
    u32 seed = 10;
    for (const dvec3& position : POSITIONS) {
        const LightNumbers samples = light_numbers_at(position, 20000, ++seed);
        const SceneProbe::Outputs got =
            probe().run("sample", scene, params_of(scene), samples.positions, samples.words);
        std::vector<vec4> hits, wo, from, kept;
        for (size_t i = 0; i < got.first.size(); ++i) {
            if (got.first[i].w == 0)
                continue;
            const u32 triangle = scene.emitters[float_to_bits(got.third[i].w)].triangle;
            const dvec3 at = to_dvec3(samples.positions[i]), point = to_dvec3(got.third[i]);
            const dvec2 b = weights_of(scene, triangle, point);
            hits.push_back({float(b.x), float(b.y), bits_to_float(triangle), 0});
            wo.push_back(to_vec4(-to_dvec3(got.first[i])));
            from.push_back(to_vec4(at, glm::length(point - at)));
            kept.push_back({got.first[i].w, got.third[i].w, 0, 0});
        }
        ASSERT_GT(hits.size(), 15000u);
        const std::vector<vec4> hit = probe().run("hit", scene, params_of(scene), hits, wo, from).first;
        size_t elsewhere = 0;
        for (size_t i = 0; i < hit.size(); ++i) {
            const bool is_there = float_to_bits(hit[i].y) == float_to_bits(kept[i].y);
            elsewhere += !is_there;
            if (is_there)
                ASSERT_NEAR(hit[i].x / kept[i].x, 1, 2e-4) << i << ", y " << position.y;
        }
        EXPECT_LT(elsewhere, 20u);
    }
}

TEST(EmitterPart, SamplesGiveTheIrradianceOfTheMap) {
    for (const char* keys : {"", "map_d mask.png", "d 0.5"}) {
        const Scene scene = spotted_lamp(keys);
        u32 seed = 20;
        for (const dvec3& position : POSITIONS) {
            const LightNumbers samples = light_numbers_at(position, 200000, ++seed);
            const SceneProbe::Outputs got =
                probe().run("sample", scene, params_of(scene), samples.positions, samples.words);
            std::vector<double> estimates;
            for (size_t i = 0; i < got.first.size(); ++i)
                estimates.push_back(got.first[i].w > 0 ? double(got.second[i].x) * double(got.first[i].y) /
                                                             double(got.first[i].w)
                                                       : 0);
            // The same light by points spread evenly over the triangles.
            Scene even = scene;
            even.emitter_parts.clear();
            even.emitter_exitance.clear();
            even.emitters = {Emitter{0, 0, 0x80000000u, 0}, Emitter{1, 1, 0x80000000u, 0}};
            double all = 0;
            for (u32 i = 0; i < 2; ++i)
                even.triangles[i].emitter = i, all += emitter_area(even, i);
            std::vector<double> plain;
            for (Emitter& emitter : even.emitters)
                emitter.pdf_a = float(0.5 / emitter_area(even, emitter.triangle));
            const SceneProbe::Outputs evenly =
                probe().run("sample", even, params_of(even), samples.positions, samples.words);
            for (size_t i = 0; i < evenly.first.size(); ++i)
                plain.push_back(evenly.first[i].w > 0
                                    ? double(evenly.second[i].x) * double(evenly.first[i].y) /
                                          double(evenly.first[i].w)
                                    : 0);
            const Moments a = moments_of(estimates), b = moments_of(plain);
            EXPECT_GT(welch_test(a, b).p_value, SMALLEST_P) << a.mean << " " << b.mean << " " << keys;
            if (position != POSITIONS[2]) // where distances say more than the map tables are not better
                EXPECT_LT(a.variance, 0.2 * b.variance) << keys << " y " << position.y;
        }
    }
}

TEST(EmitterPart, LightPathsStartWhereTheMapShines) {
    const Scene scene = spotted_lamp("");
    Random random(30);
    std::vector<vec4> words, directions;
    for (int i = 0; i < 200000; ++i) {
        const float x = bits_to_float(random.word()), y = bits_to_float(random.word());
        words.push_back({x, y, bits_to_float(random.word()), 0});
        directions.push_back({float(random.unit()), float(random.unit()), 0, 0});
    }
    const SceneProbe::Outputs got = probe().run("leave", scene, params_of(scene), words, directions);
    std::vector<double> counts(scene.emitters.size()), expected, power, areas;
    for (u32 e = 0; e < scene.emitters.size(); ++e)
        expected.push_back(double(words.size()) * double(scene.emitters[e].pdf_a) * emitter_area(scene, e));
    for (size_t i = 0; i < got.first.size(); ++i) {
        const u32 e = float_to_bits(got.third[i].x), triangle = scene.emitters[e].triangle;
        const dvec2 b = weights_of(scene, triangle, to_dvec3(got.first[i]));
        ++counts[emitter_at(scene, triangle, b)];
        ASSERT_NEAR(double(got.first[i].w) * PI / double(scene.emitters[e].pdf_a), 1, 1e-4);
        power.push_back(double(got.second[i].x));
        areas.push_back(1 / double(scene.emitters[e].pdf_a));
    }
    EXPECT_GT(chi_squared_test(counts, expected).p_value, SMALLEST_P);
    double exact = 0;
    for (u32 i = 0; i < 2; ++i)
        exact += 0.5 * glm::length(glm::cross(corner(scene, i, 1) - corner(scene, i, 0),
                                              corner(scene, i, 2) - corner(scene, i, 0)));
    EXPECT_LT(std::abs(z_of_mean(moments_of(areas), exact)), 6);
    const Moments sent = moments_of(power);
    EXPECT_LT(sent.variance, 0.6 * sent.mean * sent.mean); // evenly chosen it is many times that
}
