// SPDX-License-Identifier: Apache-2.0
// How the tables of lights mix power with an even share of every object.
#include "scene/light_tables.h"

#include "probes/scratch_scene.h"
#include "scene/environment.h"
#include "scene/lights.h"
#include "scene/sky_table.h"
#include "scene/vectors.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Four small lamps, each an object, and one behind them with 98 % of the power.
void add_lamps_and_a_strong_one(ScratchScene& scene) {
    scene.build.material("weak", "Kd 0 0 0\nKe 1 1 1").material("strong", "Kd 0 0 0\nKe 196 196 196");
    for (int i = 0; i < 5; ++i) {
        scene.build.use(i < 4 ? "weak" : "strong");
        scene.build.raw("o lamp_" + std::to_string(i) + "\n");
        const double x = 2 * i;
        scene.build.polygon({{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
    }
}

double chosen_share(const Scene& scene, size_t object) {
    double share = 0;
    for (const Emitter& emitter : scene.emitters) {
        const Triangle& t = scene.triangles[emitter.triangle];
        if (t.object == object)
            share += double(emitter.pdf_a) *
                     triangle_area(scene.positions[t.v0], scene.positions[t.v1], scene.positions[t.v2]);
    }
    return share;
}

} // namespace

TEST(LightTables, AMixtureIsNeverFarFromTheBetterRule) {
    const std::vector<double> powers = {1, 2, 1e-6, 300, 40, 5e4};
    const std::vector<u32> groups = {0, 0, 1, 2, 2, 3};
    const std::vector<double> weights = mixed_weights(powers, groups, 4);
    const double all = 50343 + 1e-6, of_group[] = {3, 1e-6, 340, 5e4};
    double sum = 0;
    for (size_t i = 0; i < powers.size(); ++i) {
        const double by_power = powers[i] / all, by_group = 0.25 * powers[i] / of_group[groups[i]];
        EXPECT_NEAR(weights[i], (by_power + by_group) / 2, 1e-12);
        sum += weights[i];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_EQ(mixed_weights(powers, std::vector<u32>(6, 0), 1), powers) << "one object: no rounding";
}

TEST(LightTables, ObjectsShareHalfOfTheChoiceEvenly) {
    ScratchScene scratch;
    add_lamps_and_a_strong_one(scratch);
    Scene scene = scratch.load();
    tabulate_lights(LightSampler::POWER, scene);
    EXPECT_NEAR(chosen_share(scene, 0), 0.005, 1e-6);
    EXPECT_NEAR(chosen_share(scene, 4), 0.98, 1e-6);
    tabulate_lights(LightSampler::MIXTURE, scene);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(chosen_share(scene, i), (0.005 + 0.2) / 2, 1e-6);
    EXPECT_NEAR(chosen_share(scene, 4), (0.98 + 0.2) / 2, 1e-6);
}

TEST(LightTables, KindsAreComparedByWhatTheySendIntoTheBoundingSphere) {
    ScratchScene scratch;
    add_lamps_and_a_strong_one(scratch);
    scratch.options.light.suns.push_back({{0, 0, 1}, glm::dvec3(2), 0.5});
    for (const double scale : {1.0, 1024.0, 3.0}) {
        scratch.scale = scale;
        const Scene scene = scratch.load();
        const double radius = 0.5 * std::sqrt(81 + 1.), emitted = PI * (4 + 196),
                     sun = 2 * PI * radius * radius;
        const KindShares power = kind_shares(LightSampler::POWER, scene);
        EXPECT_NEAR(power.emitters, emitted / (emitted + sun), 1e-6) << scale;
        EXPECT_NEAR(power.lights, sun / (emitted + sun), 1e-6) << scale;
        EXPECT_EQ(power.environment, 0) << scale;
        EXPECT_NEAR(kind_shares(LightSampler::MIXTURE, scene).lights, power.lights / 2 + 0.25, 1e-6) << scale;
    }
}

TEST(LightTables, OfAMapCountsWhatItsTableStandsFor) {
    ScratchScene scratch;
    add_lamps_and_a_strong_one(scratch);
    Scene scene = scratch.load();
    EnvironmentImage image{64, 32, std::vector<glm::vec3>(64 * 32, glm::vec3(1))};
    image.texels[16 * 64 + 20] = glm::vec3(500);
    NoticeList notices;
    scene.environment = map_environment(image, 3, 0, notices);
    tabulate_sky(scene.environment, SkySampling::BY_TABLE);
    const double whole = kind_shares(LightSampler::POWER, scene).environment;
    tabulate_sky(scene.environment, SkySampling::BY_TABLE_AND_BSDF);
    const double excess = kind_shares(LightSampler::POWER, scene).environment;
    const double bright = 499 * texel_solid_angle(16, 64, 32) / (4 * PI);
    EXPECT_NEAR(excess / (1 - excess) / (whole / (1 - whole)), bright / (1 + bright), 0.01);
}

TEST(LightTables, LightPathsStartByPowerWithinASphereAroundAllTriangles) {
    ScratchScene scratch;
    add_lamps_and_a_strong_one(scratch);
    scratch.options.light.suns.push_back({{0, 1, 0}, {1, 1, 1}, 0});
    scratch.options.light.environment = glm::dvec3(0.5);
    const Scene scene = scratch.load();
    const double radius = emission_radius(scene);
    for (const vec4& p : scene.positions)
        EXPECT_LT(glm::length(to_dvec3(p)), radius);
    EXPECT_LT(radius, 1.001 * scene.radius) << "no more than the corners need";

    const KindShares all = plan_emission(scene, true).kinds, noisy = plan_emission(scene, false).kinds;
    EXPECT_NEAR(all.emitters + all.environment + all.lights, 1, 1e-12);
    EXPECT_NEAR(all.environment / all.lights, 0.5 * 4 * PI, 1e-9) << "radiance over the sphere, irradiance";
    EXPECT_EQ(noisy.environment, 0) << "hits find an even sky";
    EXPECT_NEAR(noisy.emitters / noisy.lights, all.emitters / all.lights, 1e-9);

    scratch.options.light.ground = GroundOptions{glm::dvec3(0.5)};
    EXPECT_GT(emission_radius(scratch.load()), 4 * radius) << "distant light meets the ground, too";
}

} // namespace clrt
