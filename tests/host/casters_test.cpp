// SPDX-License-Identifier: Apache-2.0
// The spheres at which emission is aimed.
#include "scene/casters.h"

#include "probes/scratch_scene.h"
#include "scene/light_tables.h"
#include "scene/vectors.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A floor, and balls of glass and metal that are small and far apart.
struct Balls : ScratchScene {
    Balls() {
        build.material("matte", "Kd 0.5 0.5 0.5").material("glass", "Ni 1.5\nillum 7");
        build.material("frosted", "Ni 1.5\nillum 7\nPr 0.4").material("mirror", "Ks 0.9 0.9 0.9\nillum 3");
        build.use("matte").floor(10).use("frosted").icosphere({0, 1, 0}, 1, 2);
        build.use("glass").icosphere({-5, 0.5, 0}, 0.5, 3).use("mirror").icosphere({6, 0.25, 3}, 0.25, 3);
    }
};

} // namespace

TEST(Casters, AreSmoothGlassAndMirrorsInSpheresThatHoldThem) {
    const Scene scene = Balls().load();
    const std::vector<vec4> casters = find_casters(scene);
    ASSERT_EQ(casters.size(), 2u);
    const double scale = scene.normalisation.scale;
    EXPECT_NEAR(caster_squares(casters), (0.25 + 0.0625) * scale * scale, 0.01 * scale * scale);
    size_t held = 0;
    for (const Triangle& triangle : scene.triangles)
        for (const vec4& caster : casters) {
            bool holds = true;
            for (const u32 corner : {triangle.v0, triangle.v1, triangle.v2})
                holds &= glm::length(to_dvec3(scene.positions[corner]) - to_dvec3(caster)) <=
                         double(CASTER_RADIUS(caster));
            held += holds && is_caster(scene.materials[triangle.material]);
        }
    EXPECT_EQ(held, 2u * 20 * 64) << "each triangle in one of them";
}

TEST(Casters, AreWhatReflectsAlmostAsSharply) {
    const auto is_one = [](const char* keys) {
        ScratchScene scratch;
        scratch.build.material("m", keys).use("m").floor(1);
        const Scene scene = scratch.load();
        return is_caster(scene.materials[scene.triangles[0].material]);
    };
    EXPECT_TRUE(is_one("Kd 0.8 0.8 0.8\nPm 1\nPr 0.3"));
    EXPECT_FALSE(is_one("Kd 0.8 0.8 0.8\nPm 1\nPr 0.4"));
    EXPECT_FALSE(is_one("Kd 0.8 0.8 0.8\nPm 1\nPr 0.3\naniso 0.9")) << "across, it is rough";
    EXPECT_TRUE(is_one("Kd 0.5 0.5 0.5\nKs 0.05 0.05 0.05\nNs 400\nillum 2"));
    EXPECT_FALSE(is_one("Kd 0.5 0.5 0.5\nKs 0.05 0.05 0.05\nNs 20\nillum 2"));
    EXPECT_FALSE(is_one("Ni 1.5\nillum 7\nPr 0.2")) << "rough glass has other ways through it";
}

TEST(Casters, AreNoMoreThanEachLightPathCanLookAt) {
    ScratchScene scratch;
    scratch.build.material("glass", "Ni 1.5\nillum 7").use("glass");
    for (int i = 0; i < 400; ++i)
        scratch.build.icosphere({double(i % 20), 0, double(i / 20)}, 0.01, 0);
    const std::vector<vec4> casters = find_casters(scratch.load());
    EXPECT_GT(casters.size(), 1u);
    EXPECT_LE(casters.size(), size_t(LARGEST_CASTER_COUNT));
}

TEST(Casters, TakeTheLightPathsThatWouldMeetThem) {
    Balls scratch;
    scratch.options.light.suns.push_back({{0, 1, 0}, {1, 1, 1}, 0});
    scratch.options.light.environment = glm::dvec3(0);
    Scene scene = scratch.load();
    EXPECT_EQ(plan_emission(scene, false).aimed, 1) << "not aimed";
    scene.casters = find_casters(scene);
    const double radius = emission_radius(scene);
    EXPECT_NEAR(plan_emission(scene, false).aimed, caster_squares(scene.casters) / (radius * radius), 1e-9);
}

TEST(Casters, ASphereIsSeenUnderItsCone) {
    const std::vector<vec4> casters = {{0, 0, 2, 1}, {5, 0, 0, 1}};
    const double far = 2 * PI * (1 - std::sqrt(1 - 0.04)), near = 2 * PI * (1 - std::sqrt(0.75));
    EXPECT_NEAR(caster_solid_angle(casters, {0, 0, 0}, 4 * PI), far + near, 1e-9);
    EXPECT_NEAR(caster_solid_angle(casters, {5, 0, 0}, 4 * PI), 4 * PI + 2 * PI * (1 - std::sqrt(28. / 29)),
                1e-9)
        << "all around within";
}

} // namespace clrt
