// SPDX-License-Identifier: Apache-2.0
// What --paths comes to in a scene: its letters, whether anything is left, and what the kernel is told.
#include "paths/path_plan.h"

#include "effects/effects.h"
#include "effects/explain.h"
#include "kernels/shared/effects.h"
#include "kernels/shared/render_types.h"
#include "paths/path_report.h"
#include "render/render_params.h"
#include "support/render_scene.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A matte quad and a lamp; tests add what they are about.
class LampScene : public TestScene {
public:
    LampScene() {
        options.effects.all = false;
        build.material("thing", "Kd 0.5 0.5 0.5").material("lamp", "Kd 0 0 0\nKe 1 1 1");
        quad("thing");
        quad("lamp");
    }
    void quad(const std::string& material) {
        build.use(material).polygon({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
    }
    PathPlan plan(const std::string& paths) {
        options.transport.paths = paths;
        return plan_paths(load(), options);
    }
};

const PathLetter& letter(const PathPlan& plan, const std::string& symbol) {
    return *std::find_if(plan.letters.begin(), plan.letters.end(),
                         [&](const auto& l) { return l.symbol == symbol; });
}

/// The number of a state's word.
u32 number_of(u32 state) {
    return state & STATE_NUMBER_MASK;
}

/// The state in which the paths of a plan start.
u32 start_of(const PathPlan& plan) {
    return path_tables(plan).states[0].next[LETTER_MATTE];
}

/// The state behind a state and a letter.
u32 behind(const PathPlan& plan, u32 state, u32 letter) {
    return path_tables(plan).states.at(number_of(state)).next[letter];
}

/// Most segments that kernels follow paths of a plan for.
u32 segments_of(const TestScene& scene, const PathPlan& plan) {
    RenderParams params = make_render_params(scene.load(), scene.options, {});
    restrict_to_paths(plan, params);
    return params.max_depth;
}

} // namespace

TEST(PathPlan, EveryLetterOfTheSceneHasItsWitness) {
    LampScene scene;
    scene.build.material("unused", "illum 7\nNi 1.5").material("mirror", "Kd 0 0 0\nKs 1 1 1\nillum 3");
    scene.build.material("frosted", "illum 7\nNi 1.5\nPr 0.5").material("flat", "illum 7\nNi 1");
    scene.options.scene.mtl = MtlReading::PLAIN; // "flat" is glass that bends nothing
    scene.options.light.points.push_back({{0, 1, 0}, glm::dvec3(1)});
    PathPlan plan = scene.plan("L.*E");
    EXPECT_EQ(plan.alphabet.letters, 1u << LETTER_MATTE) << "materials on no triangle count for nothing";
    EXPECT_EQ(plan.alphabet.kinds, unsigned(KIND_AREA | KIND_POINT));
    EXPECT_NE(letter(plan, "D").witness.find("thing"), std::string::npos);
    EXPECT_NE(letter(plan, "La").witness.find("lamp"), std::string::npos);
    scene.quad("mirror");
    EXPECT_EQ(scene.plan("L.*E").alphabet.letters, 1u << LETTER_MATTE | 1u << LETTER_MIRROR);
    scene.quad("frosted");
    EXPECT_NE(letter(scene.plan("L.*E"), "G").witness.find("frosted"), std::string::npos);
    EXPECT_TRUE(letter(scene.plan("L.*E"), "T").witness.empty()) << "rough refraction is glossy";
    scene.quad("flat");
    EXPECT_NE(letter(scene.plan("L.*E"), "T").witness.find("flat"), std::string::npos);
    scene.options.light.suns.push_back({{0, 1, 0}, glm::dvec3(1), 0});
    scene.options.light.environment = glm::dvec3(1);
    plan = scene.plan("L.*E");
    EXPECT_EQ(plan.alphabet.kinds, unsigned(KINDS_ALL));
    EXPECT_EQ(plan.found_by_rays, unsigned(KIND_AREA | KIND_SKY)) << "a sun without a disc is never hit";
    scene.options.light.suns.back().diameter_degrees = 1;
    EXPECT_EQ(scene.plan("L.*E").found_by_rays, unsigned(KIND_AREA | KIND_SKY | KIND_SUN));
}

TEST(PathPlan, WithoutAnExpressionNothingIsAsked) {
    LampScene scene;
    const PathPlan plan = scene.plan("");
    EXPECT_FALSE(plan.is_asked || plan.is_filter || plan.is_empty);
    EXPECT_TRUE(path_defines(plan).empty());
    const u32 start = start_of(plan);
    EXPECT_EQ(start >> STATE_KINDS_SHIFT & KINDS_ALL, u32(KINDS_ALL));
    EXPECT_EQ(start & STATE_CONTINUES, STATE_CONTINUES);
    for (u32 letter = 0; letter < LETTER_COUNT; ++letter)
        EXPECT_EQ(behind(plan, start, letter), start) << "one state accepts every path";
    EXPECT_EQ(find_effects(scene.load(), scene.options).mask & EFFECT_PATH_FILTER, 0u);
    EXPECT_EQ(explain(scene.load(), find_effects(scene.load(), scene.options), scene.options).find("Paths:"),
              std::string::npos);
}

TEST(PathPlan, ALanguageThatHoldsAllPathsOfTheSceneIsNoFilter) {
    LampScene scene;
    for (const char* all : {"L(D|S)*E", "L.*E", "LaD*E", "ED*L", "LE|LD+E"}) {
        EXPECT_FALSE(scene.plan(all).is_filter) << all;
        EXPECT_EQ(find_effects(scene.load(), scene.options).mask & EFFECT_PATH_FILTER, 0u) << all;
    }
    for (const char* part : {"LDE", "LD+E", "LpD*E", "LE"})
        EXPECT_TRUE(scene.plan(part).is_filter) << part;
    EXPECT_EQ(find_effects(scene.load(), scene.options).mask & EFFECT_PATH_FILTER, EFFECT_PATH_FILTER);
}

TEST(PathPlan, SaysWhenNoPathIsLeft) {
    LampScene scene;
    PathPlan plan = scene.plan("LS+DE");
    EXPECT_TRUE(plan.is_empty);
    EXPECT_NE(path_summary(plan).find("no path of this scene matches (surfaces: D; lights: La)"),
              std::string::npos);
    EXPECT_TRUE(scene.plan("LpDE").is_empty);
    EXPECT_FALSE(scene.plan("LDDDE").is_empty);
    scene.options.transport.max_depth = 3;
    plan = scene.plan("LDDDE");
    EXPECT_TRUE(plan.is_empty);
    EXPECT_NE(path_summary(plan).find("4 segments, more than --max-depth allows"), std::string::npos);
    EXPECT_FALSE(scene.plan("LDDE").is_empty);
}

TEST(PathPlan, PathsStartInAStateOfTheTableEvenIfItIsDead) {
    LampScene scene;
    const PathPlan plan = scene.plan("LSE");
    EXPECT_EQ(start_of(plan), 1u) << "nothing ends or goes on there";
    EXPECT_EQ(behind(plan, 1, LETTER_MATTE), STATE_DEAD);
}

TEST(PathPlan, AFiniteLanguageBoundsTheLoop) {
    LampScene scene;
    EXPECT_EQ(segments_of(scene, scene.plan("LDE")), 2u);
    EXPECT_EQ(segments_of(scene, scene.plan("LD?D?E")), 3u);
    EXPECT_EQ(segments_of(scene, scene.plan("LD?S*E")), 2u) << "nothing is specular";
    EXPECT_EQ(scene.plan("LDD*E").segments, std::nullopt);
    EXPECT_EQ(segments_of(scene, scene.plan("LDD*E")), u32(USUAL_PATH_DEPTH));
    scene.options.transport.max_depth = 2;
    EXPECT_EQ(segments_of(scene, scene.plan("LD?D?E")), 2u);
}

TEST(PathPlan, TheTablesHoldSuccessorsLightsAndDistances) {
    LampScene scene;
    PathPlan plan = scene.plan("LDE");
    const u32 start = 1 | STATE_CONTINUES | STATE_SPLITS | 1u << STATE_DISTANCE_SHIFT;
    EXPECT_EQ(start_of(plan), start);
    EXPECT_EQ(behind(plan, start, LETTER_MATTE), 2 | KIND_AREA << STATE_KINDS_SHIFT | STATE_CONTINUES);
    EXPECT_EQ(behind(plan, start, LETTER_GLOSSY), STATE_DEAD);
    EXPECT_EQ(behind(plan, 2, LETTER_MATTE), STATE_DEAD);
    // Behind the last surface before a point light a ray finds nothing.
    scene.options.light.points.push_back({{0, 1, 0}, glm::dvec3(1)});
    plan = scene.plan("LpDE");
    EXPECT_EQ(start_of(plan), start);
    EXPECT_EQ(behind(plan, start, LETTER_MATTE), 2 | KIND_POINT << STATE_KINDS_SHIFT);
}

TEST(PathPlan, LightSamplingLeavesLightsAloneThatEndNoPath) {
    LampScene scene;
    scene.options.light.points.push_back({{0, 1, 0}, glm::dvec3(1)});
    const auto params = [&](const char* paths) {
        const PathPlan plan = scene.plan(paths);
        RenderParams p = make_render_params(scene.load(), scene.options, {});
        restrict_to_paths(plan, p);
        return p;
    };
    EXPECT_EQ(params("").choose_emitter, 0.5f);
    EXPECT_EQ(params("LaDE").choose_emitter, 1.0f);
    EXPECT_EQ(params("LaDE").choose_light, 0.0f);
    EXPECT_EQ(params("LpDE").choose_light, 1.0f);
    EXPECT_EQ(params("LDE").choose_light, 0.5f);
}

TEST(PathPlan, LayersAreTold) {
    LampScene scene;
    scene.options.output.path_layers = {{"direct", "LDE"}, {"lamp", "LE"}};
    const PathPlan plan = scene.plan("");
    EXPECT_TRUE(plan.is_filter);
    EXPECT_EQ(path_defines(plan), std::vector<std::string>{"PATH_LAYERS=2"});
    const u32 start = start_of(plan), behind_matte = behind(plan, start, LETTER_MATTE);
    const std::vector<PathState> rows = path_tables(plan).states;
    EXPECT_EQ(rows[number_of(start)].layers, KIND_AREA << LAYER_KINDS_BITS) << "the second layer, \"lamp\"";
    EXPECT_EQ(rows[number_of(behind_matte)].layers, KIND_AREA);
    EXPECT_EQ(rows[number_of(behind(plan, behind_matte, LETTER_MATTE))].layers, 0u);
    const auto json = paths_json(plan);
    EXPECT_TRUE(json["expression"].is_null());
    EXPECT_EQ(json["layers"][1]["expression"], "LE");
    EXPECT_NE(format_paths(plan).find("layer direct: LDE"), std::string::npos);
}

TEST(PathPlan, TheStatesAreExplained) {
    LampScene scene;
    const std::string text = format_paths(scene.plan("LDE"));
    EXPECT_NE(text.find("  absent  T"), std::string::npos) << text;
    EXPECT_NE(text.find("\n      1  -          2    -    -    -\n      2  La         -    -    -    -\n"),
              std::string::npos)
        << text;
}

} // namespace clrt
