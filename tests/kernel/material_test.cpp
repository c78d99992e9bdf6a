// SPDX-License-Identifier: Apache-2.0
// scattering/material.h: constants and maps become a BSDF; normal and bump maps; shading normals that the eye
// cannot see.
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
        // a: barycentric weights 1 and 2, triangle; b: wo
        const std::string surface =
            "Hit hit; hit.t = REAL(1.0); hit.b1 = (real)a.x; hit.b2 = (real)a.y; "
            "hit_set_triangle(0u, as_uint(a.z), &hit);"
            "const Ray ray_there = ray_make((real3)(REAL(0.0)), -vector_from(b), REAL(0.0));"
            "const Surface surface = surface_at(scene, &hit, &ray_there);";
        const std::string bsdf =
            surface + "const Bsdf bsdf = material_bsdf(scene, &surface, vector_from(b), TRANSPORT_RADIANCE);";
        SceneProbe made(test_device(), {"scattering/material.h"});
        made.add("colors", bsdf + "first = probe_vec4(bsdf.matte, bsdf.alpha_x); second = "
                                  "probe_vec4(bsdf.specular, bsdf.alpha_y);"
                                  "third = probe_vec4(bsdf.transmission, bsdf.eta);");
        made.add("frame", bsdf + "first = probe_vec4(bsdf.frame.z, bsdf.wo.z); second = "
                                 "probe_vec4(bsdf.frame.x, bsdf.exponent);"
                                 "third = probe_vec4(bsdf.normal_g, vector_dot(bsdf.frame.y, "
                                 "vector_cross(bsdf.frame.z, bsdf.frame.x)));");
        made.add("labels",
                 bsdf +
                     "first = (vec4)(as_float(bsdf.lobes), as_float(bsdf.fresnel), as_float(bsdf.flags), 0);"
                     "second = (vec4)(bsdf.choose[LOBE_ROW_MATTE], bsdf.choose[LOBE_ROW_GLOSSY], 0, 0);");
        made.add("light", surface +
                              "first = probe_vec4(material_emitted(scene, &surface, vector_from(b)), "
                              "material_coverage(scene, scene->materials + surface.material, surface.uv));");
        return made;
    }();
    return instance;
}

/// The triangle (0,0,0) (1,0,0) (0,1,0), whose texture coordinates are x and y, with one material.
struct Sample {
    Scene scene;

    Sample() {
        Triangle triangle{};
        triangle.v1 = triangle.t1 = 1;
        triangle.v2 = triangle.t2 = 2;
        triangle.n0 = triangle.n1 = triangle.n2 = NO_INDEX;
        triangle.emitter = NO_INDEX;
        scene.triangles.push_back(triangle);
        scene.positions = {{0, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}};
        scene.uvs = {0, 0, 1, 0, 0, 1};
        Material m{};
        m.matte = {0.5f, 0.25f, 0.125f, 0.75f};
        m.specular = {0.3f, 0.2f, 0.1f, 40};
        m.transmission = {0.9f, 0.8f, 0.7f, 1.5f};
        m.emission = {2, 4, 6, 0};
        m.alpha_x = m.alpha_y = 0.25f;
        m.roughness_sqrt_x = m.roughness_sqrt_y = 0.5f;
        m.lobes = LOBE_MATTE;
        m.map_matte = m.map_specular = m.map_emission = m.map_coverage = NO_INDEX;
        m.map_roughness = m.map_metallic = m.map_normal = m.map_bump = NO_INDEX;
        scene.materials.push_back(m);
    }
    Material& material() { return scene.materials[0]; }
    /// A picture of rows from top to bottom; gives its index.
    u32 add_map(u32 width, u32 height, const std::vector<std::array<float, 4>>& texels) {
        Texture texture{};
        texture.first_word = u32(scene.texel_words.size());
        texture.width = width;
        texture.height = height;
        texture.format = TEXEL_FLOAT;
        texture.scale_u = texture.scale_v = texture.gain = 1;
        for (const auto& texel : texels)
            for (const float value : texel)
                scene.texel_words.push_back(float_to_bits(value));
        scene.textures.push_back(texture);
        return u32(scene.textures.size() - 1);
    }
    void set_normals(const dvec3& n0, const dvec3& n1, const dvec3& n2) {
        scene.normals = {to_vec4(n0), to_vec4(n1), to_vec4(n2)};
        scene.triangles[0].n0 = 0;
        scene.triangles[0].n1 = 1;
        scene.triangles[0].n2 = 2;
    }
    SceneProbe::Outputs at(const char* name, double x, double y, const dvec3& wo) const {
        return run(name, {to_vec4({x, y, 0})}, {to_vec4(glm::normalize(wo))});
    }
    SceneProbe::Outputs run(const char* name, const std::vector<vec4>& hits,
                            const std::vector<vec4>& wo) const {
        return probe().run(name, scene, RenderParams{}, hits, wo);
    }
};

constexpr dvec3 UP{0, 0, 1};

} // namespace

TEST(Material, ConstantsArriveUnchanged) {
    Sample sample;
    sample.material().lobes = LOBE_GLOSSY;
    sample.material().fresnel = FRESNEL_SCHLICK;
    sample.material().flags = MATERIAL_WHITTED_MIRROR;
    const SceneProbe::Outputs colors = sample.at("colors", 0.25, 0.25, UP),
                              labels = sample.at("labels", 0.25, 0.25, UP);
    EXPECT_EQ(to_dvec3(colors.first[0]), dvec3(0.5, 0.25, 0.125));
    EXPECT_EQ(to_dvec3(colors.second[0]), to_dvec3(sample.material().specular));
    EXPECT_EQ(to_dvec3(colors.third[0]), to_dvec3(sample.material().transmission));
    EXPECT_EQ(colors.first[0].w, 0.25f);
    EXPECT_EQ(float_to_bits(labels.first[0].x), LOBE_GLOSSY);
    EXPECT_EQ(float_to_bits(labels.first[0].y), FRESNEL_SCHLICK);
    EXPECT_EQ(float_to_bits(labels.first[0].z), MATERIAL_WHITTED_MIRROR);
    EXPECT_EQ(labels.second[0].y, 1); // alone, the lobe is always chosen
    EXPECT_EQ(sample.at("frame", 0.25, 0.25, UP).second[0].w, 40);
}

TEST(Material, TheIndexRatioDependsOnTheSide) {
    const Sample sample;
    EXPECT_EQ(sample.at("colors", 0.25, 0.25, UP).third[0].w, 1 / 1.5f);
    EXPECT_EQ(sample.at("colors", 0.25, 0.25, -UP).third[0].w, 1.5f);
}

TEST(Material, MapsMultiplyTheConstants) {
    Sample sample;
    sample.material().map_matte = sample.add_map(1, 1, {{0.5f, 0.2f, 0.1f, 1}});
    sample.material().map_specular = sample.add_map(1, 1, {{0.1f, 0.5f, 1, 1}});
    sample.material().map_emission = sample.add_map(1, 1, {{1, 0.5f, 0.25f, 1}});
    sample.material().map_coverage = sample.add_map(1, 1, {{0.4f, 0, 0, 1}});
    const SceneProbe::Outputs colors = sample.at("colors", 0.25, 0.25, UP),
                              light = sample.at("light", 0.25, 0.25, UP);
    EXPECT_LE(glm::length(to_dvec3(colors.first[0]) - dvec3(0.25, 0.05, 0.0125)), 1e-7);
    EXPECT_LE(glm::length(to_dvec3(colors.second[0]) - dvec3(0.03, 0.1, 0.1)), 1e-7);
    EXPECT_LE(glm::length(to_dvec3(light.first[0]) - dvec3(2, 2, 1.5)), 1e-6);
    EXPECT_NEAR(light.first[0].w, 0.75 * 0.4, 1e-7);
    sample.material().map_coverage = sample.add_map(1, 1, {{7, 0, 0, 1}});
    EXPECT_EQ(sample.at("light", 0.25, 0.25, UP).first[0].w, 1); // never above 1
    sample.material().map_coverage = sample.add_map(1, 1, {{-7, 0, 0, 1}});
    EXPECT_EQ(sample.at("light", 0.25, 0.25, UP).first[0].w, 0);
}

TEST(Material, RoughnessMapsHoldTheRootOfAlpha) {
    Sample sample;
    sample.material().alpha_y = 0.04f;
    sample.material().roughness_sqrt_y = 0.2f;
    sample.material().map_roughness = sample.add_map(1, 1, {{0.5f, 0, 0, 1}});
    const SceneProbe::Outputs got = sample.at("colors", 0.25, 0.25, UP);
    EXPECT_NEAR(got.first[0].w, 0.0625, 1e-7); // (0.5 times 0.5) squared
    EXPECT_NEAR(got.second[0].w, 0.01, 1e-7);
    sample.material().map_roughness = sample.add_map(1, 1, {{1, 0, 0, 1}});
    EXPECT_EQ(sample.at("colors", 0.25, 0.25, UP).first[0].w, 0.25f); // the constant, to the bit
    sample.material().map_roughness = sample.add_map(1, 1, {{0, 0, 0, 1}});
    EXPECT_EQ(sample.at("colors", 0.25, 0.25, UP).first[0].w, 1e-4f);
}

TEST(Material, MetallicRoughnessMixesTheReflectionFromGlassToMetal) {
    Sample sample;
    sample.material().flags = MATERIAL_METALLIC_ROUGHNESS;
    sample.material().specular = {0.04f, 0.04f, 0.04f, 40};
    for (const float metallic : {0.0f, 0.25f, 1.0f}) {
        sample.material().emission.w = metallic;
        const SceneProbe::Outputs got = sample.at("colors", 0.25, 0.25, UP);
        const dvec3 base(0.5, 0.25, 0.125), f0 = dvec3(0.04) + double(metallic) * (base - dvec3(0.04));
        EXPECT_LE(glm::length(to_dvec3(got.first[0]) - base * (1.0 - metallic)), 1e-7);
        EXPECT_LE(glm::length(to_dvec3(got.second[0]) - f0), 1e-7);
    }
    sample.material().map_metallic = sample.add_map(1, 1, {{0.5f, 0, 0, 1}}); // metallic is 1
    EXPECT_LE(
        glm::length(to_dvec3(sample.at("colors", 0.25, 0.25, UP).first[0]) - dvec3(0.25, 0.125, 0.0625)),
        1e-7);
    // The part that is no metal has its own reflectance, and a map of it.
    sample.material().specular = {0.2f, 0.2f, 0.2f, 40};
    sample.material().map_specular = sample.add_map(1, 1, {{0.5f, 0.25f, 1, 1}});
    EXPECT_LE(glm::length(to_dvec3(sample.at("colors", 0.25, 0.25, UP).second[0]) -
                          (dvec3(0.1, 0.05, 0.2) + dvec3(0.5, 0.25, 0.125)) / 2.0),
              1e-7);
}

TEST(Material, LightComesFromTheFrontUnlessBothSidesEmit) {
    Sample sample;
    EXPECT_EQ(to_dvec3(sample.at("light", 0.25, 0.25, UP).first[0]), dvec3(2, 4, 6));
    EXPECT_EQ(to_dvec3(sample.at("light", 0.25, 0.25, -UP).first[0]), dvec3(0));
    sample.material().flags = MATERIAL_EMITS_BOTH_SIDES;
    EXPECT_EQ(to_dvec3(sample.at("light", 0.25, 0.25, -UP).first[0]), dvec3(2, 4, 6));
}

TEST(Material, StretchedHighlightsFollowTheDirectionOfGrowingU) {
    Sample sample;
    sample.material().alpha_x = 0.5f;
    sample.scene.uvs = {0, 0, 1, 1, -1, 1}; // u grows along (1, -1)
    const SceneProbe::Outputs got = sample.at("frame", 0.25, 0.25, {0.1, 0.2, 1});
    EXPECT_LE(glm::length(to_dvec3(got.second[0]) - glm::normalize(dvec3(1, -1, 0))), 4 * FLOAT_U);
    EXPECT_NEAR(got.third[0].w, 1, 4 * FLOAT_U); // right-handed
}

TEST(Material, MapsOfAnisotropyStretchHighlightsAndTurnThem) {
    Sample sample;
    sample.material().alpha_x = sample.material().alpha_y = 0.25f;
    sample.material().flags = MATERIAL_TURNED;
    MaterialExtension& extension = sample.scene.extensions.emplace_back();
    const float c = float(std::cos(0.5)), s = float(std::sin(0.5));
    extension.map_anisotropy = sample.add_map(1, 1, {{0.5f + 0.5f * c, 0.5f + 0.5f * s, 0.8f, 1}});
    extension.anisotropy = 0.5f;
    extension.turn_cos = 1;
    const auto colors = [&] { return sample.at("colors", 0.25, 0.25, UP); };
    const auto way = [&] { return to_dvec3(sample.at("frame", 0.25, 0.25, UP).second[0]); };
    EXPECT_NEAR(colors().first[0].w, 0.25 + 0.75 * 0.4 * 0.4, 1e-7) << "along: mix(a, 1, s^2)";
    EXPECT_EQ(colors().second[0].w, 0.25f) << "across";
    EXPECT_LE(glm::length(way() - dvec3(c, s, 0)), 1e-6);
    // A constant turn is added.
    extension.turn_cos = 0, extension.turn_sin = 1;
    EXPECT_LE(glm::length(way() - dvec3(-s, c, 0)), 1e-6);
    // Mirrored coordinates: u grows along -x, v still along y.
    extension.turn_cos = 1, extension.turn_sin = 0;
    sample.scene.uvs = {0, 0, -1, 0, 0, 1};
    EXPECT_LE(glm::length(way() - dvec3(-c, s, 0)), 1e-6);
    // A map of no direction leaves that of growing u, and at most 1 : 10.
    sample.scene.uvs = {0, 0, 1, 0, 0, 1};
    sample.material().alpha_x = sample.material().alpha_y = 0.01f;
    extension.map_anisotropy = sample.add_map(1, 1, {{0.5f, 0.5f, 1, 1}});
    extension.anisotropy = 1;
    EXPECT_LE(glm::length(way() - dvec3(1, 0, 0)), 1e-6);
    EXPECT_EQ(colors().first[0].w, 1);
    EXPECT_NEAR(colors().second[0].w, 0.1, 1e-7);
    // What is not stretched at all keeps its alpha.
    extension.anisotropy = 0;
    EXPECT_EQ(colors().first[0].w, 0.01f);
    EXPECT_EQ(colors().second[0].w, 0.01f);
}

TEST(Material, FlatMapsLeaveTheNormal) {
    Sample sample;
    sample.material().map_normal = sample.add_map(1, 1, {{0.5f, 0.5f, 1, 1}});
    sample.material().map_bump =
        sample.add_map(2, 2, {{0.3f, 0, 0, 1}, {0.3f, 0, 0, 1}, {0.3f, 0, 0, 1}, {0.3f, 0, 0, 1}});
    sample.material().bump_scale = 10;
    for (const dvec3& wo : {dvec3(0.1, 0.2, 1), dvec3(0.1, 0.2, -1)})
        EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, wo).first[0]) - dvec3(0, 0, wo.z)),
                  4 * FLOAT_U);
}

TEST(Material, NormalMapsTurnRedTowardsUAndGreenTowardsV) {
    Sample sample;
    sample.material().map_normal = sample.add_map(1, 1, {{0.8f, 0.7f, 0.9f, 1}});
    sample.material().bump_scale = 1;
    const dvec3 exact = glm::normalize(dvec3(0.6, 0.4, 0.8));
    EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, UP).first[0]) - exact), 1e-6);
    // From behind, as when light leaves glass, it is the same surface.
    EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, -UP).first[0]) + exact), 1e-6);
    // Mirrored coordinates: u grows along -x, v still along y.
    sample.scene.uvs = {0, 0, -1, 0, 0, 1};
    EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, UP).first[0]) -
                          dvec3(-exact.x, exact.y, exact.z)),
              1e-6);
    // Without texture coordinates a map has no direction.
    sample.scene.triangles[0].t0 = NO_INDEX;
    EXPECT_EQ(to_dvec3(sample.at("frame", 0.25, 0.25, UP).first[0]), UP);
}

TEST(Material, TheStrengthOfANormalMapScalesItsTilt) {
    Sample sample;
    sample.material().map_normal = sample.add_map(1, 1, {{0.8f, 0.7f, 0.9f, 1}});
    for (const float strength : {-1.0f, 0.5f, 3.0f}) {
        sample.material().bump_scale = strength;
        const dvec3 exact = glm::normalize(dvec3(0.6 * double(strength), 0.4 * double(strength), 0.8));
        EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, UP).first[0]) - exact), 1e-6)
            << strength;
    }
    // Beside a bump map its strength is 1: the scale is that of the heights.
    sample.material().bump_scale = 7;
    sample.material().map_bump = sample.add_map(1, 1, {{0.3f, 0, 0, 1}});
    EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, UP).first[0]) -
                          glm::normalize(dvec3(0.6, 0.4, 0.8))),
              1e-6);
}

TEST(Material, BumpMapsTiltTheNormalAgainstTheSlope) {
    // Heights rise by 1 from the centre of the left column to that of the right, half a unit away.
    Sample sample;
    sample.material().map_bump = sample.add_map(2, 1, {{0, 0, 0, 1}, {1, 0, 0, 1}});
    sample.material().bump_scale = 0.2f;
    const dvec3 exact = glm::normalize(dvec3(-0.4, 0, 1));
    EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, UP).first[0]) - exact), 1e-6);
    // From behind it is the same surface, whose dents are now bumps.
    EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.25, 0.25, -UP).first[0]) + exact), 1e-6);
    // A map repeated along u is steeper.
    sample.scene.textures[0].scale_u = 2;
    EXPECT_LE(glm::length(to_dvec3(sample.at("frame", 0.125, 0.25, UP).first[0]) -
                          glm::normalize(dvec3(-0.8, 0, 1))),
              1e-6);
}

TEST(Material, TheEyeSeesTheFrontOfEveryShadingNormal) {
    Random random(1);
    std::vector<vec4> hits, wo;
    for (int i = 0; i < 20000; ++i) {
        hits.push_back(to_vec4({0.5 * random.unit(), 0.5 * random.unit(), 0}));
        const double z = i % 2 ? random.between(-1, 1) : random.signed_log(1e-7, 1);
        wo.push_back(to_vec4(direction_at(z, 2 * PI * random.unit())));
    }
    for (int round = 0; round < 8; ++round) {
        Sample sample;
        if (round == 0)
            sample.set_normals(UP, UP, UP);
        else
            sample.set_normals(glm::normalize(UP + random.direction()),
                               glm::normalize(UP + random.direction()),
                               glm::normalize(UP + random.direction()));
        const SceneProbe::Outputs got = sample.run("frame", hits, wo);
        for (size_t i = 0; i < hits.size(); ++i) {
            const dvec3 n = to_dvec3(got.first[i]), o = to_dvec3(wo[i]);
            ASSERT_NEAR(glm::length(n), 1, 8 * FLOAT_U);
            ASSERT_NEAR(got.first[i].w, glm::dot(n, o), 8 * FLOAT_U);
            // A thousandth is the least cosine of a bent normal; a plane is seen as it is.
            ASSERT_GE(got.first[i].w, round == 0 ? 0 : 0.9e-3) << round;
        }
    }
}
