// SPDX-License-Identifier: Apache-2.0
// The table of effects, the sets that scenes can call for, and scenes from which effects were taken.
#include "effects/effect_table.h"

#include "effects/effects.h"
#include "effects/take_out.h"
#include "probes/effect_masks.h"

#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>
#include <set>

namespace clrt {

TEST(EffectTable, EveryBitOccursOnceInOrderWithAName) {
    EffectMask seen = 0;
    for (const EffectSpec& effect : effect_table()) {
        EXPECT_GT(effect.bit, seen) << effect.name;
        EXPECT_EQ(effect.bit & (effect.bit - 1), 0u) << effect.name;
        EXPECT_EQ(effect_by_name(effect.name), effect.bit);
        EXPECT_GT(std::string(effect.without).size(), 10u) << effect.name;
        seen |= effect.bit;
    }
    EXPECT_EQ(seen, EVERY_EFFECT);
    EXPECT_EQ(effect_by_name("normal-and-bump-maps"), EFFECT_NORMAL_MAP);
    EXPECT_FALSE(effect_by_name("refractio"));
}

TEST(EffectTable, ImpliedEffectsComeAndGoTogether) {
    EXPECT_EQ(with_implied(EFFECT_ROUGH_REFRACTION), EffectMask(EFFECT_ROUGH_REFRACTION | EFFECT_REFRACTION));
    EXPECT_EQ(with_implied(EFFECT_MATTE), EFFECT_MATTE);
    EXPECT_EQ(without_effects(EVERY_EFFECT, EFFECT_TEXTURES),
              EVERY_EFFECT & ~EffectMask(EFFECT_TEXTURES | EFFECT_NORMAL_MAP | EFFECT_MAPPED_EMISSION |
                                         EFFECT_TEXTURE_FILTER | EFFECT_SECOND_UV));
    EXPECT_EQ(without_effects(EVERY_EFFECT, EFFECT_ENVIRONMENT_MAP), EVERY_EFFECT & ~EFFECT_ENVIRONMENT_MAP);
    EXPECT_FALSE(is_permitted(EFFECT_ENVIRONMENT_MAP));
    EXPECT_FALSE(is_permitted(EFFECT_TEXTURES)) << "a map of nothing";
    EXPECT_TRUE(is_permitted(EFFECT_TEXTURES | EFFECT_CUT_OUT));
    EXPECT_TRUE(is_permitted(0));
}

TEST(EffectMaskFamilies, AreWhatTheyAreCalled) {
    const std::vector<EffectMask> pairwise = pairwise_effects();
    EXPECT_EQ(pairwise, pairwise_effects());
    EXPECT_LE(pairwise.size(), 20u);
    for (const EffectMask effects : all_effect_sets())
        EXPECT_TRUE(is_permitted(effects)) << describe_effects(effects);
    // Every two effects occur together, alone and not at all, as far as one does not imply the other.
    for (const EffectSpec& a : effect_table())
        for (const EffectSpec& b : effect_table()) {
            if (a.bit >= b.bit)
                continue;
            std::set<EffectMask> seen;
            for (const EffectMask effects : pairwise)
                seen.insert(effects & (a.bit | b.bit));
            const bool implied = (with_implied(a.bit) & b.bit) || (with_implied(b.bit) & a.bit);
            EXPECT_EQ(seen.size(), implied ? 3u : 4u) << a.name << " and " << b.name;
        }
}

TEST(EffectMaskFamilies, EverySetHasASceneThatCallsForIt) {
    for (const EffectMask effects : all_effect_sets()) {
        const SceneOfEffects scene(effects);
        const EffectMask needed = find_effects(scene.load(), scene.options).needed;
        EXPECT_EQ(needed, effects) << describe_effects(needed) << "\ninstead of "
                                   << describe_effects(effects);
    }
}

TEST(TakeOut, ASceneWithoutAnEffectDoesNotCallForIt) {
    for (const EffectSpec& effect : effect_table()) {
        SceneOfEffects every(EVERY_EFFECT);
        Scene scene = every.load();
        take_out_effects(effect.bit, scene, every.options);
        EXPECT_EQ(find_effects(scene, every.options).needed, without_effects(EVERY_EFFECT, effect.bit))
            << effect.name;
    }
}

TEST(TakeOut, NothingLeavesNothing) {
    SceneOfEffects every(EVERY_EFFECT);
    Scene scene = every.load();
    take_out_effects(EVERY_EFFECT, scene, every.options);
    EXPECT_EQ(find_effects(scene, every.options).needed, 0u);
}

TEST(TakeOut, AMaterialWithoutAnEffectIsOneThatNeverHadIt) {
    const struct {
        EffectMask effect;
        const char *with, *without;
    } cases[] = {
        {EFFECT_TEXTURES, "Kd 0.5 0.6 0.7\nmap_Kd colour.png\nnorm normal.exr", "Kd 0.5 0.6 0.7"},
        {EFFECT_TEXTURES, "Kd 0.5 0.6 0.7\nmap_d colour.png", "Kd 0.5 0.6 0.7"},
        {EFFECT_TEXTURES, "Kd 0.5 0.6 0.7\nd 0.5\nmap_d colour.png", "Kd 0.5 0.6 0.7\nd 0.5"},
        {EFFECT_NORMAL_MAP, "Kd 0.5 0.6 0.7\nnorm normal.exr", "Kd 0.5 0.6 0.7"},
        {EFFECT_CUT_OUT, "Kd 0.5 0.6 0.7\nd 0.5\nmap_d colour.png", "Kd 0.5 0.6 0.7"},
        {EFFECT_ROUGH_REFRACTION, "Ni 1.4\nillum 7\nPr 0.3", "Ni 1.4\nillum 7"},
        {EFFECT_ROUGH_REFRACTION, "Ni 1.4\nillum 7\nmap_Pr colour.png", "Ni 1.4\nillum 7"},
    };
    for (const auto& [effect, with, without] : cases) {
        Material materials[2];
        for (const bool has : {false, true}) {
            SceneOfEffects scene(0);
            scene.build.material("m", has ? with : without).use("m").floor(1);
            Scene loaded = scene.load();
            take_out_effects(effect, loaded, scene.options);
            materials[has] = loaded.materials.back();
        }
        EXPECT_EQ(std::memcmp(&materials[0], &materials[1], sizeof(Material)), 0) << with;
    }
}

TEST(TakeOut, AConstantSkyHasTheMeanOfTheMap) {
    SceneOfEffects every(EVERY_EFFECT);
    every.texture("sky.exr", 4, 4, 3, std::vector<float>(48, 0.25f));
    every.options.light.environment_scale = 2;
    Scene scene = every.load();
    take_out_effects(EFFECT_ENVIRONMENT_MAP, scene, every.options);
    EXPECT_TRUE(scene.environment.texels.empty());
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(scene.environment.radiance[c], 0.5, 1e-6);
}

TEST(TakeOut, FlatTrianglesKeepTheFrontThatNormalsGaveThem) {
    ScratchScene scene;
    scene.build.material("m", "Kd 1 1 1").use("m");
    scene.build.raw("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf 1//1 2//1 3//1\nvn 0 0 1\nf 1//2 2//2 3//2");
    Scene loaded = scene.load();
    const Triangle against = loaded.triangles[0], along = loaded.triangles[1];
    take_out_effects(EFFECT_SMOOTH_NORMALS, loaded, scene.options);
    EXPECT_EQ(loaded.triangles[0].v1, against.v2);
    EXPECT_EQ(loaded.triangles[0].v2, against.v1);
    EXPECT_EQ(loaded.triangles[1].v1, along.v1);
}

} // namespace clrt
