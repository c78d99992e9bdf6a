// SPDX-License-Identifier: Apache-2.0
// lights/delta_light.h: the cones of spot lights, against glTF's formula in double.
#include "probes/random_inputs.h"
#include "probes/scene_probe.h"
#include "scene/lights.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

SceneProbe& probe() {
    static SceneProbe instance = [] {
        SceneProbe made(test_device(), {"lights/lights.h"});
        // a: direction, light
        made.add("falloff",
                 "first.x = (float)delta_light_falloff(scene->lights + as_uint(a.w), vector_from(a));");
        // a: position, light
        made.add(
            "sample",
            "Surface surface; surface.position = vector_from(a); surface.is_curved = false;"
            "surface.normal_g = surface.normal_s = vector_make(0.0f, 0.0f, 1.0f);"
            "LightSample s = delta_light_sample(scene, as_uint(a.w), vector_from(a), (real2)(REAL(0.5)));"
            "delta_light_dim(scene, as_uint(a.w), &s);"
            "first = probe_vec4(s.radiance, s.pdf_w);");
        return made;
    }();
    return instance;
}

Scene spot_scene(const SpotCone& cone, const dvec3& position = dvec3(0), const dvec3& intensity = dvec3(1)) {
    LightOptions options;
    options.points.push_back({position, intensity, cone, "--spot"});
    NoticeList notices;
    Scene scene;
    scene.lights = build_lights(options, {}, 1, notices).lights;
    return scene;
}

vec4 first_light(const dvec3& v) {
    vec4 packed = to_vec4(v);
    packed.w = 0; // the bits of index 0
    return packed;
}

/// KHR_lights_punctual, squared as its reference implementation has it.
double gltf_falloff(const SpotCone& cone, const dvec3& w) {
    const auto cosine = [](double degrees) { return std::cos(degrees * PI / 180); };
    const double inner = cosine(cone.inner_degrees), outer = cosine(cone.outer_degrees);
    const double c = glm::dot(glm::normalize(cone.direction), w);
    if (inner == outer)
        return c > outer ? 1 : 0;
    const double share = std::clamp((c - outer) / (inner - outer), 0.0, 1.0);
    return share * share;
}

const SpotCone CONES[] = {
    {{0, 0, -1}, 45, 0},   {{1, 2, 3}, 30, 20},    {{0, -1, 0}, 90, 0},
    {{1, 0, 0}, 90, 90},   {{-1, 1, 0.3}, 10, 10}, {{0, 2, 0}, 180, 0},
    {{0, 0, 5}, 120, 119}, {{1, 1, 1}, 0.5, 0},    {{0.2, 1, 0}, 2, 1.9},
};

/// Directions around a cone's axis, most of them near its edge.
std::vector<dvec3> directions_around(const SpotCone& cone, size_t count, u32 seed) {
    Random random(seed);
    const dvec3 axis = glm::normalize(cone.direction);
    std::vector<dvec3> directions;
    while (directions.size() < count) {
        const dvec3 any = random.direction(), across = any - glm::dot(any, axis) * axis;
        const double degrees = random.unit() * std::min(1.3 * cone.outer_degrees, 180.0);
        const double angle = degrees * PI / 180;
        directions.push_back(std::cos(angle) * axis + std::sin(angle) * glm::normalize(across));
    }
    return directions;
}

} // namespace

TEST(SpotLight, TheFalloffIsThatOfKhrLightsPunctual) {
    for (const SpotCone& cone : CONES) {
        const Scene scene = spot_scene(cone);
        ASSERT_EQ(scene.lights.size(), 1u);
        const std::vector<dvec3> w = directions_around(cone, 4000, 1);
        std::vector<vec4> inputs;
        for (const dvec3& direction : w)
            inputs.push_back(first_light(direction));
        const SceneProbe::Outputs got = probe().run("falloff", scene, RenderParams{}, inputs);
        // Directions in floats are off by u, over the width of the falloff.
        const double width = 1 / double(LIGHT_SHARPNESS(scene.lights[0]));
        const double sine = std::sin(std::min(cone.outer_degrees, 90.0) * PI / 180);
        const double bound = std::min(1e-6 + 16 * FLOAT_U * sine / width, 0.1);
        for (size_t i = 0; i < w.size(); ++i) {
            const double expected = gltf_falloff(cone, w[i]);
            const double apart =
                glm::dot(w[i], glm::normalize(cone.direction)) - std::cos(cone.outer_degrees * PI / 180);
            if (cone.inner_degrees == cone.outer_degrees && std::abs(apart) < 1e-6)
                continue; // the edge itself
            ASSERT_NEAR(got.first[i].x, expected, bound) << cone.outer_degrees << " " << cone.inner_degrees;
        }
    }
}

TEST(SpotLight, ItLightsAsAPointWithinAndNotAtAllOutside) {
    const dvec3 place(0.2, 0.4, 2), intensity(3, 2, 1);
    const Scene scene = spot_scene({{0, 0, -1}, 30, 20}, place, intensity);
    const auto at = [&](double degrees, double distance) {
        const double angle = degrees * PI / 180;
        return first_light(place + distance * dvec3(std::sin(angle), 0, -std::cos(angle)));
    };
    const SceneProbe::Outputs got =
        probe().run("sample", scene, RenderParams{}, {at(0, 1), at(19, 2), at(31, 1), at(90, 1), at(180, 1)});
    EXPECT_NEAR(got.first[0].x, 3, 1e-5);
    EXPECT_NEAR(got.first[1].y, 0.5, 1e-5);
    EXPECT_EQ(got.first[1].w, 1);
    for (size_t i = 2; i < 5; ++i) {
        EXPECT_EQ(got.first[i].w, 0) << "no light";
        EXPECT_EQ(got.first[i].x, 0);
    }
}

TEST(SpotLight, PowerIsTheIntegralOfTheFalloff) {
    for (const SpotCone& cone : CONES) {
        const Light light = spot_scene(cone).lights.at(0);
        double sum = 0;
        constexpr int STEPS = 400000;
        for (int i = 0; i < STEPS; ++i) {
            const double c = 1 - 2 * (i + 0.5) / STEPS;
            sum += gltf_falloff({{0, 0, 1}, cone.outer_degrees, cone.inner_degrees},
                                dvec3(std::sqrt(1 - c * c), 0, c)) *
                   4 * PI / STEPS;
        }
        EXPECT_NEAR(lit_solid_angle(light) / sum, 1, cone.outer_degrees < 1 ? 0.05 : 1e-3)
            << cone.outer_degrees << " " << cone.inner_degrees;
        EXPECT_NEAR(light_power(light, 1), lit_solid_angle(light), 1e-6);
    }
}

TEST(SpotLight, AConeOfAngleZeroIsNoLightAndWrongOnesAreErrors) {
    EXPECT_TRUE(spot_scene({{0, 0, -1}, 0, 0}).lights.empty());
    EXPECT_TRUE(spot_scene({{0, 0, -1}, 1e-30, 0}).lights.empty());
    EXPECT_THROW(spot_scene({{0, 0, 0}, 30, 0}), UsageError);
    EXPECT_THROW(spot_scene({{0, 0, -1}, 30, 31}), UsageError);
    EXPECT_THROW(spot_scene({{0, 0, -1}, 181, 0}), UsageError);
    EXPECT_THROW(spot_scene({{0, 0, -1}, 30, -1}), UsageError);
}
