// SPDX-License-Identifier: Apache-2.0
// A plan is that of the scene as it is rendered, witnesses being those of the scene as it was given.
#include "effects/planned_scene.h"

#include "effects/effect_table.h"
#include "effects/take_out.h"
#include "probes/effect_masks.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A mirror and a matte quad under a lamp and a point light.
class MirrorScene : public TestScene {
public:
    MirrorScene() {
        options.effects.all = false;
        options.light.points.push_back({{0, 2, 0}, {1, 1, 1}});
        build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3").material("wall", "Kd 0.5 0.5 0.5");
        build.material("lamp", "Kd 0 0 0\nKe 1 1 1");
        for (const char* const name : {"mirror", "wall", "lamp"})
            build.use(name).floor(1);
    }
};

std::string witness(const PathPlan& plan, const std::string& symbol) {
    for (const PathLetter& letter : plan.letters)
        if (letter.symbol == symbol)
            return letter.witness;
    throw std::logic_error("no such letter");
}

} // namespace

TEST(PlannedScene, PathsAreThoseOfTheSceneAsItIsRendered) {
    MirrorScene scene;
    scene.options.transport.paths = "LaDE|LpRDE"; // point lights by way of a mirror only
    const auto whole = plan_scene(scene.load(), scene.options);
    EXPECT_NE(witness(whole->effects.paths, "R"), "");
    EXPECT_EQ(accepted_kinds(whole->effects.paths), unsigned(KIND_AREA | KIND_POINT));

    scene.options.effects.off = EFFECT_MIRROR;
    const auto planned = plan_scene(scene.load(), scene.options);
    EXPECT_EQ(planned->effects.left_out, EFFECT_MIRROR);
    EXPECT_EQ(find_effects(planned->scene, planned->options).needed & EFFECT_MIRROR, 0u);
    EXPECT_EQ(witness(planned->effects.paths, "R"), "") << "no mirror is left that could write it";
    EXPECT_EQ(accepted_kinds(planned->effects.paths), unsigned(KIND_AREA));
    for (const Effect& effect : planned->effects.list)
        if (effect.bit == EFFECT_MIRROR)
            EXPECT_TRUE(effect.present) << "of the scene as it was given";
}

TEST(PlannedScene, CausticsFallOnWhateverHasADensity) {
    for (const char* receiver : {"Kd 0.5 0.5 0.5", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.6"})
        for (const char* caster : {"Kd 0 0 0\nKs 1 1 1\nillum 3", "Kd 0.8 0.8 0.8\nPm 1\nPr 0.2", ""}) {
            SCOPED_TRACE(std::string(receiver) + " and " + caster);
            TestScene scene;
            scene.build.material("receiver", receiver).use("receiver").floor(1);
            if (*caster)
                scene.build.material("caster", caster).use("caster").floor(1, 1);
            EXPECT_EQ(has_caustics(*plan_scene(scene.load(), scene.options)), *caster != 0);
        }
}

TEST(PlannedScene, PathConnectsToWhatPanesAloneCast) {
    TestScene scene;
    scene.build.material("lamp", "Kd 0 0 0\nKe 1 1 1").material("glass", "Ni 1.5\nillum 7");
    scene.build.use("glass").box({-1, 1, -1}, {1, 1.1, 1});
    EXPECT_FALSE(path_connects_to_caustics(*plan_scene(scene.load(), scene.options))) << "no lamps";
    scene.build.use("lamp").floor(1, 2);
    EXPECT_TRUE(path_connects_to_caustics(*plan_scene(scene.load(), scene.options)));
    scene.options.light.points.push_back({{0, 3, 0}, {1, 1, 1}});
    EXPECT_FALSE(path_connects_to_caustics(*plan_scene(scene.load(), scene.options))) << "no ray meets points";
    scene.options.light.points.clear();
    scene.build.material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3").use("mirror").floor(1, 3);
    EXPECT_FALSE(path_connects_to_caustics(*plan_scene(scene.load(), scene.options)));
}

TEST(PlannedScene, PathsThatAreNotToldApartAreAll) {
    MirrorScene scene;
    scene.options.transport.paths = "LaDE";
    scene.options.effects.off = EFFECT_PATH_FILTER;
    const auto planned = plan_scene(scene.load(), scene.options);
    EXPECT_FALSE(planned->effects.paths.is_asked);
    EXPECT_FALSE(planned->effects.paths.is_filter);
    EXPECT_EQ(planned->options.transport.paths, "");
}

TEST(PlannedScene, WhatTurnsTrianglesIsKnown) {
    // Normals against the corners, so that taking them out turns the triangle.
    SceneOfEffects every(EVERY_EFFECT);
    every.build.raw("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 -1\nf -3//-1 -2//-1 -1//-1");
    const Scene scene = every.load();
    for (const EffectSpec& effect : effect_table()) {
        Scene reduced = scene;
        Options options = every.options;
        take_out_effects(effect.bit, reduced, options);
        bool is_turned = false;
        for (size_t i = 0; i < scene.triangles.size(); ++i) {
            const Triangle &a = scene.triangles[i], &b = reduced.triangles[i];
            is_turned |= a.v0 != b.v0 || a.v1 != b.v1 || a.v2 != b.v2;
        }
        const EffectMask with_those_that_imply_it = EVERY_EFFECT & ~without_effects(EVERY_EFFECT, effect.bit);
        EXPECT_EQ(turns_triangles(with_those_that_imply_it), is_turned) << effect.name;
    }
}

} // namespace clrt
