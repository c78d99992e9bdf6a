// SPDX-License-Identifier: Apache-2.0
// lights/light_tree.h and light_choice.h: the probability of a chosen light is that of a light met by chance,
// all of them add up to 1, and no light that shines on a point is left out.
#include "kernels/shared/path_types.h"
#include "probes/scene_probe.h"
#include "probes/statistics.h"
#include "scene/light_tree.h"
#include "support/lamps.h"
#include "support/test_device.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;
using glm::dvec3;

namespace {

SceneProbe make_probe(Precision precision) {
    ProbeOptions options;
    options.precision = precision;
    SceneProbe made(test_device(), {"lights/lights.h"}, "", options);
    const std::string view = "const LightView view = {vector_from(a), vector_from(b)};";
    // a: position; b: normal; c: words. The light, its probability when chosen and when met, what is left.
    made.add("choose", view + "const LightChoice choice = light_choose(scene, params, &view, "
                              "(uint2)(as_uint(c.x), as_uint(c.y)), as_uint(c.z));"
                              "first.x = as_float(choice.light); first.y = as_float(choice.word);"
                              "if (choice.light != NO_INDEX) {"
                              "const real met = choice.light < params->emitter_count ? "
                              "light_probability_of_emitter(scene, params, &view, choice.light) : "
                              "choice.light == light_of_sky(params) ? "
                              "light_probability_of_sky(scene, params, &view) : "
                              "light_probability_of_delta(scene, params, &view, "
                              "choice.light - params->emitter_count);"
                              "second.x = (float)choice.probability; second.y = (float)met;"
                              "second.z = met == choice.probability ? 1.0f : 0.0f; }");
    // a.w: the light
    made.add("width", view + "const ulong width = light_tree_width(scene, &view, as_uint(a.w));"
                             "first.x = as_float((uint)(width >> 32)); first.y = as_float((uint)width);");
    return made;
}

SceneProbe& probe() {
    static SceneProbe instance = make_probe(Precision::SINGLE);
    return instance;
}

RenderParams params_of(const Scene& scene) {
    RenderParams params{};
    params.emitter_count = u32(scene.emitters.size());
    params.light_count = u32(scene.lights.size());
    LIGHT_TREE_IS_USED(params) = 1;
    return params;
}

u32 light_count(const Scene& scene) {
    return u32(scene.emitters.size() + scene.lights.size() + 1);
}

/// Random lamps, points, suns and a sky, in a tree.
Lamps all_lights(u32 quads, u32 seed) {
    Lamps lamps = random_lamps(quads, seed);
    lamps.point({0.5, 0.4, 0.3}, dvec3(0.02));
    lamps.point({-0.9, 0.1, 0.3}, dvec3(3));
    lamps.sun({1, 2, 1}, dvec3(0.5), 0);
    lamps.sun({-1, 1, 1}, dvec3(50), 0.05);
    lamps.sky();
    lamps.scene.light_tree = build_light_tree(lamps.scene, KINDS_ALL);
    return lamps;
}

/// Points near and among the lights, on some of them, and normals; every seventh view is open to all sides.
struct Views {
    std::vector<vec4> positions, normals, words;

    Views(size_t count, u32 seed) {
        Random random(seed);
        for (size_t i = 0; i < count; ++i) {
            const double reach = i % 3 ? 1 : 1e-3;
            const double x = random.between(-reach, reach), y = random.between(-reach, reach);
            positions.push_back(to_vec4({x, y, random.between(-reach, reach)}));
            normals.push_back(to_vec4(i % 7 ? random.direction() : dvec3(0)));
            const u32 first = random.word(), second = random.word();
            words.push_back({bits_to_float(first), bits_to_float(second), bits_to_float(random.word()), 0});
        }
    }
};

/// The widths of all lights at one view.
std::vector<std::uint64_t> widths_at(SceneProbe& probe, const Scene& scene, const vec4& position,
                                     const vec4& normal) {
    std::vector<vec4> positions(light_count(scene), position);
    for (u32 light = 0; light < positions.size(); ++light)
        positions[light].w = bits_to_float(light);
    const auto got =
        probe.run("width", scene, params_of(scene), positions, std::vector<vec4>(positions.size(), normal));
    std::vector<std::uint64_t> widths;
    for (const vec4& halves : got.first)
        widths.push_back(std::uint64_t(float_to_bits(halves.x)) << 32 | float_to_bits(halves.y));
    return widths;
}

void expect_one_probability(Precision precision) {
    SceneProbe own = make_probe(precision);
    for (const u32 quads : {1u, 5u, 800u}) {
        const Lamps lamps = all_lights(quads, quads);
        const Views views(20000, 6);
        const auto got = own.run("choose", lamps.scene, params_of(lamps.scene), views.positions,
                                 views.normals, views.words);
        size_t chosen = 0;
        for (size_t i = 0; i < got.first.size(); ++i) {
            if (float_to_bits(got.first[i].x) == NO_INDEX)
                continue;
            ++chosen;
            ASSERT_LT(float_to_bits(got.first[i].x), light_count(lamps.scene));
            ASSERT_GT(got.second[i].x, 0);
            ASSERT_EQ(got.second[i].z, 1) << "chosen " << got.second[i].x << ", met " << got.second[i].y;
        }
        EXPECT_GT(chosen, got.first.size() * 9 / 10) << quads;
    }
}

} // namespace

TEST(LightChoice, ALightHasOneProbabilityChosenOrMet) {
    expect_one_probability(Precision::SINGLE);
}

TEST(LightChoice, ALightHasOneProbabilityInDoubleToo) {
    if (!test_device().info.fp64)
        GTEST_SKIP() << "no doubles";
    expect_one_probability(Precision::DOUBLE);
}

TEST(LightChoice, ProbabilitiesAddUpToOneToTheLastBit) {
    for (const u32 quads : {1u, 5u, 300u}) {
        const Lamps lamps = all_lights(quads, 10 + quads);
        const Views views(200, 7);
        double chosen = 0;
        for (size_t i = 0; i < views.positions.size(); ++i) {
            std::uint64_t sum = 0;
            for (const std::uint64_t width :
                 widths_at(probe(), lamps.scene, views.positions[i], views.normals[i]))
                sum += width;
            // Where both children are dark, though their parent was not, nothing is chosen.
            ASSERT_LE(sum, std::uint64_t(1) << 63);
            chosen += std::ldexp(double(sum), -63) / double(views.positions.size());
        }
        EXPECT_GT(chosen, 0.93) << "of lights on all sides, few samples may go to none";
    }
}

TEST(LightChoice, LightsAreChosenWithTheirProbability) {
    constexpr size_t SAMPLES = 200000;
    const Lamps lamps = all_lights(20, 3);
    Views views(SAMPLES, 8);
    for (const size_t at : {size_t{1}, size_t{7}}) { // one of a normal, one open to all sides
        const vec4 position = views.positions[at], normal = views.normals[at];
        const auto widths = widths_at(probe(), lamps.scene, position, normal);
        const auto got =
            probe().run("choose", lamps.scene, params_of(lamps.scene), std::vector<vec4>(SAMPLES, position),
                        std::vector<vec4>(SAMPLES, normal), views.words);
        std::vector<double> counts(widths.size()), rests(64), expected, observed;
        double few = 0, few_expected = SAMPLES, all_rests = 0; // rare lights, and no light, count together
        for (const vec4& chosen : got.first) {
            const u32 light = float_to_bits(chosen.x);
            if (light == NO_INDEX) {
                ++few;
                continue;
            }
            ++counts.at(light);
            if (light + 1 < widths.size()) { // the sky's texel takes the other word
                ++rests[float_to_bits(chosen.y) >> 26];
                ++all_rests;
            }
        }
        for (size_t i = 0; i < widths.size(); ++i) {
            const double mean = SAMPLES * std::ldexp(double(widths[i]), -63);
            EXPECT_TRUE(mean > 0 || counts[i] == 0) << i;
            if (mean < 20) {
                few += counts[i];
            } else {
                few_expected -= mean;
                observed.push_back(counts[i]);
                expected.push_back(mean);
            }
        }
        observed.push_back(few + 10);
        expected.push_back(few_expected + 10);
        EXPECT_GT(chi_squared_test(observed, expected).p_value, SMALLEST_P);
        EXPECT_GT(chi_squared_test(rests, std::vector<double>(64, all_rests / 64)).p_value, SMALLEST_P)
            << "what is left of the number is uniform";
    }
}

TEST(LightChoice, EveryLightThatShinesOnAPointCanBeChosen) {
    Lamps lamps = all_lights(300, 5);
    for (const double degrees : {5.0, 60.0, 89.0, 130.0, 179.0})
        lamps.spot({0.3, -0.2, 0.4}, {0.6, 0, 0.8}, degrees);
    lamps.scene.light_tree = build_light_tree(lamps.scene, KINDS_ALL);
    const Scene& scene = lamps.scene;
    const Views views(60, 9);
    Random random(10);
    size_t shining = 0;
    for (size_t i = 0; i < views.positions.size(); ++i) {
        const dvec3 p = to_dvec3(views.positions[i]), n = to_dvec3(views.normals[i]);
        const bool open = n == dvec3(0);
        const auto widths = widths_at(probe(), scene, views.positions[i], views.normals[i]);
        for (u32 light = 0; light < scene.emitters.size(); ++light) {
            const Triangle& t = scene.triangles[scene.emitters[light].triangle];
            const dvec3 p0 = to_dvec3(scene.positions[t.v0]), e1 = to_dvec3(scene.positions[t.v1]) - p0,
                        e2 = to_dvec3(scene.positions[t.v2]) - p0, normal = glm::cross(e1, e2);
            const bool both = scene.materials[t.material].flags & MATERIAL_EMITS_BOTH_SIDES;
            for (int k = 0; k < 6; ++k) { // corners, edges and points between
                const double u = k < 2 ? 0 : random.unit(), v = k < 4 ? 0 : random.unit() * (1 - u);
                const dvec3 way = p0 + (k == 1 ? 1 : u) * e1 + v * e2 - p;
                const double facing = -glm::dot(way, normal);
                if ((open || glm::dot(way, n) > 0) && (both ? facing != 0 : facing > 0)) {
                    ASSERT_GT(widths[light], 0u) << "view " << i << ", light " << light;
                    ++shining;
                }
            }
        }
        for (u32 k = 0; k < scene.lights.size(); ++k) {
            const Light& light = scene.lights[k];
            const dvec3 way = to_dvec3(light.vector) - (light.kind == LIGHT_POINT ? p : dvec3(0));
            const dvec3 axis(light.axis_x, light.axis_y, light.axis_z);
            const bool is_lit = LIGHT_SHARPNESS(light) == 0 ||
                                1 + glm::dot(glm::normalize(way), axis) < double(light.one_minus_cos);
            if (is_lit && (open || glm::dot(way, n) > 0))
                ASSERT_GT(widths[scene.emitters.size() + k], 0u) << "view " << i << ", light " << k;
        }
        ASSERT_GT(widths.back(), 0u) << "the sky";
    }
    EXPECT_GT(shining, 10000u);
}

TEST(LightChoice, LampsBehindAreLeftOut) {
    Lamps lamps;
    for (int i = 0; i < 8; ++i) {
        const double x = 0.5 * (i % 4) - 0.75, z = i < 4 ? 1 : -1;
        lamps.quad({x, 0, z}, {0.05, 0, 0}, {0, 0.05, 0}, dvec3(i == 2 ? 0.1 : 1)); // all shine along +z
    }
    lamps.finish();
    lamps.scene.light_tree = build_light_tree(lamps.scene, KINDS_ALL);
    // A floor looks up from between: the lamps below it shine on its back, those above turn their backs.
    for (const float normal : {1.0f, -1.0f}) {
        const auto widths = widths_at(probe(), lamps.scene, {0, 0, 0, 0}, {0, 0, normal, 0});
        for (size_t light = 0; light < widths.size(); ++light)
            EXPECT_EQ(widths[light] > 0, normal < 0 && light >= 8 && light < 16) << light;
    }
}

TEST(LightChoice, DegenerateLightsAndViewsDoNoHarm) {
    Lamps lamps;
    for (int i = 0; i < 300; ++i)
        lamps.point({0.1, 0.2, 0.3}, dvec3(i % 3 ? 1e-20 : 1e20));
    lamps.quad({0.1, 0.2, 0.3}, {1e-12, 0, 0}, {0, 1e-12, 0}, dvec3(1));
    lamps.finish();
    lamps.scene.light_tree = build_light_tree(lamps.scene, KINDS_ALL);
    Views views(3000, 11);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (size_t i = 0; i < views.positions.size(); ++i) {
        if (i % 4 == 0)
            views.positions[i] = {0.1f, 0.2f, 0.3f, 0}; // where the lights are
        if (i % 4 == 1)
            views.positions[i] = {nan, 0, 0, 0};
        if (i % 4 == 2)
            views.normals[i] = {nan, nan, nan, 0};
    }
    const auto got = probe().run("choose", lamps.scene, params_of(lamps.scene), views.positions,
                                 views.normals, views.words);
    for (size_t i = 0; i < got.first.size(); ++i) {
        const u32 light = float_to_bits(got.first[i].x);
        ASSERT_TRUE(light == NO_INDEX || light < light_count(lamps.scene));
        if (i % 4 == 1)
            ASSERT_EQ(light, NO_INDEX);
        if (light != NO_INDEX) {
            ASSERT_EQ(got.second[i].z, 1) << i;
            ASSERT_TRUE(std::isfinite(got.second[i].x) && got.second[i].x > 0) << i;
        }
    }
}
