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

bool has_define(const PathPlan& plan, const std::string& define) {
    const std::vector<std::string> defines = path_defines(plan);
    return std::find(defines.begin(), defines.end(), define) != defines.end();
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
    EXPECT_TRUE(has_define(scene.plan("LSE"), "PATH_NEXT=0x0u,0x0u"));
}

TEST(PathPlan, AFiniteLanguageBoundsTheLoop) {
    LampScene scene;
    EXPECT_TRUE(has_define(scene.plan("LDE"), "PATH_SEGMENTS=2u"));
    EXPECT_TRUE(has_define(scene.plan("LD?D?E"), "PATH_SEGMENTS=3u"));
    EXPECT_TRUE(has_define(scene.plan("LD?S*E"), "PATH_SEGMENTS=2u")) << "nothing is specular";
    EXPECT_EQ(scene.plan("LDD*E").segments, std::nullopt);
    scene.options.transport.max_depth = 2;
    EXPECT_TRUE(has_define(scene.plan("LD?D?E"), "PATH_SEGMENTS=2u"));
}

TEST(PathPlan, TheTablesHoldSuccessorsLightsAndDistances) {
    LampScene scene;
    const PathPlan plan = scene.plan("LDE");
    EXPECT_TRUE(has_define(plan, "PATH_NEXT=0x0u,0x2u,0x0u")) << "from the start D leads to state 2";
    const u32 start = STATE_CONTINUES | STATE_SPLITS | 1u << STATE_DISTANCE_SHIFT,
              end = KIND_AREA | STATE_CONTINUES;
    char words[64];
    std::snprintf(words, sizeof words, "PATH_STATES=0x0u,%#xu,%#xu", start, end);
    EXPECT_TRUE(has_define(plan, words)) << words;
    // Behind the last surface before a point light a ray finds nothing.
    scene.options.light.points.push_back({{0, 1, 0}, glm::dvec3(1)});
    std::snprintf(words, sizeof words, "PATH_STATES=0x0u,%#xu,%#xu", start, KIND_POINT);
    EXPECT_TRUE(has_define(scene.plan("LpDE"), words)) << words;
}

TEST(PathPlan, LightSamplingLeavesLightsAloneThatEndNoPath) {
    LampScene scene;
    scene.options.light.points.push_back({{0, 1, 0}, glm::dvec3(1)});
    const auto params = [&](const char* paths) {
        const PathPlan plan = scene.plan(paths);
        RenderParams p = make_render_params(scene.load(), scene.options, {});
        restrict_lights(plan, p);
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
    EXPECT_TRUE(has_define(plan, "PATH_LAYERS=2"));
    EXPECT_TRUE(has_define(plan, "PATH_LAYER_KINDS=0x0u,0x10u,0x1u,0x0u"));
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
