// SPDX-License-Identifier: Apache-2.0
#include "scene/lights.h"

#include "error.h"
#include "scene_support.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

constexpr double PI = 3.14159265358979323846;

/// Right triangles in the plane z = 0 with legs of the given lengths, material i for triangle i.
struct Triangles {
    std::vector<vec4> positions;
    std::vector<Triangle> triangles;

    explicit Triangles(const std::vector<float>& legs) {
        for (float leg : legs) {
            const u32 first = u32(positions.size());
            positions.insert(positions.end(), {vec4{0, 0, 0, 0}, vec4{leg, 0, 0, 0}, vec4{0, leg, 0, 0}});
            Triangle triangle{};
            triangle.v0 = first, triangle.v1 = first + 1, triangle.v2 = first + 2;
            triangle.material = u32(triangles.size());
            triangle.emitter = 77;
            triangles.push_back(triangle);
        }
    }
};

Normalisation frame(double scale, const glm::dvec3& centre = glm::dvec3(0)) {
    Normalisation result;
    result.scale = scale;
    result.centre = centre;
    return result;
}

Lights build(const LightOptions& options, const Normalisation& normalisation = frame(1), double radius = 1) {
    NoticeList notices;
    return build_lights(options, normalisation, radius, notices);
}

} // namespace

TEST(Lights, EmittersAreChosenByPower) {
    Triangles mesh({1, 2, 3, 1});
    const Emitters result = build_emitters(mesh.positions, mesh.triangles, {4, 1, 0, 2});
    ASSERT_EQ(result.emitters.size(), 3u);
    // Powers pi area luminance: 0.5 * 4, 2 * 1, (dark), 0.5 * 2, times pi.
    EXPECT_NEAR(result.power, 5 * PI, 1e-12);
    EXPECT_NEAR(double(result.emitters[0].pdf_a) * 0.5, 2 / 5., 1e-6);
    EXPECT_NEAR(double(result.emitters[1].pdf_a) * 2.0, 2 / 5., 1e-6);
    EXPECT_NEAR(double(result.emitters[2].pdf_a) * 0.5, 1 / 5., 1e-6);
    EXPECT_EQ(mesh.triangles[0].emitter, 0u);
    EXPECT_EQ(mesh.triangles[1].emitter, 1u);
    EXPECT_EQ(mesh.triangles[2].emitter, NO_INDEX);
    EXPECT_EQ(mesh.triangles[3].emitter, 2u);
    EXPECT_EQ(result.emitters[2].triangle, 3u);
}

TEST(Lights, PdfIntegratesToOneOverTheEmitters) {
    std::vector<float> legs;
    std::vector<double> exitance;
    for (int i = 0; i < 300; ++i) {
        legs.push_back(0.001f * float(i % 17 + 1));
        exitance.push_back(std::pow(10., i % 9 - 4));
    }
    Triangles mesh(legs);
    const Emitters result = build_emitters(mesh.positions, mesh.triangles, exitance);
    double sum = 0;
    for (const Emitter& emitter : result.emitters) {
        const Triangle& t = mesh.triangles[emitter.triangle];
        sum += double(emitter.pdf_a) *
               triangle_area(mesh.positions[t.v0], mesh.positions[t.v1], mesh.positions[t.v2]);
    }
    EXPECT_NEAR(sum, 1, 1e-6);
}

TEST(Lights, ZeroAreaAndDarkTrianglesAreNoEmitters) {
    Triangles mesh({0, 1, 1e-20f});
    const Emitters result = build_emitters(mesh.positions, mesh.triangles, {5, 0, 5});
    EXPECT_TRUE(result.emitters.empty());
    EXPECT_EQ(result.power, 0);
    for (const Triangle& triangle : mesh.triangles)
        EXPECT_EQ(triangle.emitter, NO_INDEX);
}

TEST(Lights, PointLightsKeepTheRadianceOfWhatTheyLight) {
    LightOptions options;
    options.points.push_back({glm::dvec3(5, 6, 7), glm::dvec3(8, 4, 2)});
    const Lights result = build(options, frame(0.25, glm::dvec3(1, 2, 3)), 2);
    ASSERT_EQ(result.lights.size(), 1u);
    const Light& light = result.lights[0];
    EXPECT_EQ(light.kind, LIGHT_POINT);
    EXPECT_EQ(light.vector.x, 1);
    EXPECT_EQ(light.vector.z, 1);
    // Irradiance I / r^2 at 2 scene units is I' / r'^2 at 0.5 normalised ones.
    EXPECT_FLOAT_EQ(light.emission.x / (0.5f * 0.5f), 8.f / (2.f * 2.f));
    EXPECT_NEAR(result.power, 4 * PI * (0.2126 * 8 + 0.7152 * 4 + 0.0722 * 2) / 16, 1e-12);
    EXPECT_EQ(light.probability, 1);
}

TEST(Lights, AFarPointLightHasThePowerOfASunOfItsIrradiance) {
    for (double distance : {1e3, 1e6, 1e12}) {
        LightOptions point, sun;
        point.points.push_back({glm::dvec3(0, distance, 0), glm::dvec3(3 * distance * distance)});
        sun.suns.push_back({glm::dvec3(0, 1, 0), glm::dvec3(3), 0});
        const double expected = build(sun, frame(1), 2).power;
        EXPECT_NEAR(build(point, frame(1), 2).power, expected, 4e-6 * expected) << distance;
    }
    // On the sphere, half of the light meets it.
    LightOptions near;
    near.points.push_back({glm::dvec3(0, 2 + 1e-15, 0), glm::dvec3(1)});
    EXPECT_NEAR(build(near, frame(1), 2).power, 2 * PI, 1e-6);
}

TEST(Lights, ASunDiscGivesItsIrradiance) {
    for (double degrees : {0.001, 0.53, 10.0, 120.0}) {
        LightOptions options;
        options.suns.push_back({glm::dvec3(0, 3, 4), glm::dvec3(2, 1, 0.5), degrees});
        const Light light = build(options).lights.at(0);
        EXPECT_EQ(light.kind, LIGHT_SUN);
        EXPECT_FLOAT_EQ(light.vector.y, 0.6f);
        EXPECT_FLOAT_EQ(light.vector.z, 0.8f);
        const double r = degrees * PI / 360;
        // The integral of L cos over the cap is L pi sin^2 r.
        EXPECT_NEAR(double(light.emission.x) * PI * std::sin(r) * std::sin(r), 2, 1e-6) << degrees;
        const double exact = double(1 - std::cos(static_cast<long double>(r)));
        EXPECT_NEAR(double(light.one_minus_cos) / exact, 1, 1e-6) << degrees;
    }
}

TEST(Lights, ASunWithoutDiameterIsADeltaLight) {
    for (double degrees : {0.0, 1e-30}) {
        LightOptions options;
        options.suns.push_back({glm::dvec3(0, 1, 0), glm::dvec3(2, 1, 0.5), degrees});
        const Light light = build(options).lights.at(0);
        EXPECT_EQ(light.one_minus_cos, 0);
        EXPECT_EQ(light.emission.x, 2);
    }
}

TEST(Lights, LightsAreChosenByPower) {
    LightOptions options;
    options.points.push_back({glm::dvec3(0), glm::dvec3(1)});        // 4 pi
    options.suns.push_back({glm::dvec3(0, 1, 0), glm::dvec3(3), 0}); // 3 pi R^2 = 12 pi
    const Lights result = build(options, frame(1), 2);
    EXPECT_NEAR(result.lights[0].probability, 0.25, 1e-6);
    EXPECT_NEAR(result.lights[1].probability, 0.75, 1e-6);
    EXPECT_NEAR(result.power, 16 * PI, 1e-9);
}

TEST(Lights, ALightWithoutPowerIsLeftOut) {
    LightOptions options;
    options.points.push_back({glm::dvec3(0), glm::dvec3(0)});
    NoticeList notices;
    EXPECT_TRUE(build_lights(options, frame(1), 1, notices).lights.empty());
    EXPECT_EQ(count_notices(notices, "--point: a light without power"), 1);
}

TEST(Lights, WrongValuesAreUsageErrors) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto sun = [](const glm::dvec3& towards, const glm::dvec3& irradiance, double degrees) {
        LightOptions options;
        options.suns.push_back({towards, irradiance, degrees});
        return options;
    };
    const auto point = [](const glm::dvec3& position, const glm::dvec3& intensity) {
        LightOptions options;
        options.points.push_back({position, intensity});
        return options;
    };
    EXPECT_THROW(build(sun(glm::dvec3(0), glm::dvec3(1), 0)), UsageError);
    EXPECT_THROW(build(sun(glm::dvec3(nan, 0, 1), glm::dvec3(1), 0)), UsageError);
    EXPECT_THROW(build(sun(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), 0)), UsageError);
    EXPECT_THROW(build(sun(glm::dvec3(0, 1, 0), glm::dvec3(1), 180)), UsageError);
    EXPECT_THROW(build(sun(glm::dvec3(0, 1, 0), glm::dvec3(1), nan)), UsageError);
    EXPECT_THROW(build(point(glm::dvec3(0, nan, 0), glm::dvec3(1))), UsageError);
    EXPECT_THROW(build(point(glm::dvec3(0), glm::dvec3(INFINITY))), UsageError);
}
