// SPDX-License-Identifier: Apache-2.0
// Every effect is found where a scene calls for it, with its witness, and absent otherwise, with the reason.
#include "effects/effects.h"
#include "effects/explain.h"
#include "kernels/shared/effects.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// One quad of one material under no light; tests add what they are about.
class OneQuad : public TestScene {
public:
    explicit OneQuad(const std::string& keys = "Kd 0.5 0.5 0.5") {
        build.material("thing", keys).use("thing");
        build.textured_quad({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
        texture("map.exr", 2, 1, 3, {1, 1, 1, 0.5f, 0.5f, 0.5f});
        options.light.environment = glm::dvec3(0);
        options.effects.all = false;
    }
    Effects effects() const { return find_effects(load(), options); }
};

const Effect& find(const Effects& effects, EffectMask bit) {
    for (const Effect& effect : effects.list)
        if (effect.bit == bit)
            return effect;
    throw std::logic_error("no such effect");
}

/// Expects an effect with a witness that holds this text.
void expect_present(const OneQuad& scene, EffectMask bit, const std::string& witness) {
    const Effects effects = scene.effects();
    const Effect& effect = find(effects, bit);
    EXPECT_TRUE(effect.present) << effect.name << ": " << effect.witness;
    EXPECT_NE(effect.witness.find(witness), std::string::npos) << effect.name << ": " << effect.witness;
    EXPECT_EQ(effects.mask & bit, bit) << effect.name;
}

/// The same for an effect that no program is built without.
void expect_present_at_run_time(const OneQuad& scene, EffectMask bit, const std::string& witness) {
    const Effects effects = scene.effects();
    const Effect& effect = find(effects, bit);
    EXPECT_TRUE(effect.present && (effects.needed & bit)) << effect.name << ": " << effect.witness;
    EXPECT_NE(effect.witness.find(witness), std::string::npos) << effect.witness;
    EXPECT_EQ(effects.mask & bit, 0u);
}

void expect_absent(const OneQuad& scene, EffectMask bit) {
    const Effects effects = scene.effects();
    const Effect& effect = find(effects, bit);
    EXPECT_FALSE(effect.present) << effect.name << ": " << effect.witness;
    EXPECT_FALSE(effect.witness.empty()) << effect.name << ": the reason is missing";
    EXPECT_EQ(effects.mask & bit, 0u) << effect.name;
}

} // namespace

TEST(Effects, AMatteQuadInTheDarkCallsForOneEffect) {
    const OneQuad scene;
    EXPECT_EQ(scene.effects().mask, EFFECT_MATTE);
    for (const EffectSpec& effect : effect_table())
        if (effect.bit != EFFECT_MATTE && (effect.bit & EFFECT_ALL))
            expect_absent(scene, effect.bit);
}

TEST(Effects, EveryEffectOfTheTableIsListedInOrder) {
    const Effects effects = OneQuad().effects();
    ASSERT_EQ(effects.list.size(), effect_table().size());
    for (size_t i = 0; i < effects.list.size(); ++i) {
        EXPECT_EQ(effects.list[i].bit, effect_table()[i].bit);
        EXPECT_EQ(effects.list[i].name, effect_table()[i].name);
    }
}

TEST(Effects, MaterialsAreNamedWithTheirPlace) {
    const struct {
        const char* keys;
        EffectMask bit;
    } cases[] = {
        {"Kd 0 0 0\nKe 1 1 1", EFFECT_AREA_LIGHT},
        {"Kd 0.1 0.1 0.1", EFFECT_MATTE},
        {"Ks 0.5 0.5 0.5\nNs 50\nillum 2", EFFECT_GLOSSY},
        {"Kd 0.5 0.5 0.5\nPm 1\nPr 0.4", EFFECT_GLOSSY},
        {"Ks 1 1 1\nillum 3", EFFECT_MIRROR},
        {"Ni 1.5\nillum 7", EFFECT_REFRACTION},
        {"Ni 1.5\nillum 7\nPr 0.3", EFFECT_ROUGH_REFRACTION},
        {"map_Kd map.exr", EFFECT_TEXTURES},
        {"Kd 0.5 0.5 0.5\nnorm map.exr", EFFECT_NORMAL_MAP},
        {"Kd 0.5 0.5 0.5\nbump map.exr", EFFECT_NORMAL_MAP},
        {"Kd 0.5 0.5 0.5\nd 0.5", EFFECT_CUT_OUT},
        {"Kd 0.5 0.5 0.5\nmap_d map.exr", EFFECT_CUT_OUT},
    };
    for (const auto& [keys, bit] : cases) {
        const OneQuad scene(keys);
        SCOPED_TRACE(keys);
        expect_present(scene, bit, "material \"thing\" (" + scene.folder.file("scene.mtl") + ":1)");
    }
    expect_present(OneQuad("map_Kd map.exr"), EFFECT_MATTE, "thing");
    expect_present(OneQuad("Ni 1.5\nillum 7\nPr 0.3"), EFFECT_REFRACTION, "thing");
    expect_present(OneQuad("norm map.exr"), EFFECT_TEXTURES, "thing");
}

TEST(Effects, NeighbouringMaterialsDoNotCallForMore) {
    expect_absent(OneQuad("Ks 1 1 1\nNs 50\nillum 2"), EFFECT_MATTE);
    expect_absent(OneQuad("Ks 1 1 1\nillum 3"), EFFECT_GLOSSY);
    expect_absent(OneQuad("Ks 1 1 1\nNs 50\nillum 3"), EFFECT_MIRROR);
    expect_absent(OneQuad("Ni 1.5\nillum 7"), EFFECT_ROUGH_REFRACTION);
    expect_absent(OneQuad("Ni 1.5\nillum 7"), EFFECT_MIRROR);
    expect_absent(OneQuad("map_Kd map.exr"), EFFECT_NORMAL_MAP);
    expect_absent(OneQuad("map_Kd map.exr"), EFFECT_CUT_OUT);
    expect_absent(OneQuad("map_Kd none.exr"), EFFECT_TEXTURES); // a file that is not there
    expect_absent(OneQuad("Ke 0 0 0"), EFFECT_AREA_LIGHT);
}

TEST(Effects, MaterialsOnNoTriangleDoNotCount) {
    OneQuad scene;
    scene.build.material("unused", "Ni 1.5\nillum 7").use("unused").use("thing");
    expect_absent(scene, EFFECT_REFRACTION);
    expect_present(scene, EFFECT_MATTE, "thing");
}

TEST(Effects, LightOptionsCallForTheirKind) {
    OneQuad sky;
    sky.options.light.environment = glm::dvec3(0, 0, 0.1);
    expect_present(sky, EFFECT_ENVIRONMENT, "radiance above 0");
    expect_absent(sky, EFFECT_ENVIRONMENT_MAP);

    OneQuad map;
    map.options.light.environment.reset();
    map.options.light.environment_file = map.folder.file("map.exr");
    expect_present(map, EFFECT_ENVIRONMENT_MAP, "2 x 1 texels");
    expect_present(map, EFFECT_ENVIRONMENT, "");
    map.options.light.environment_scale = 0;
    expect_absent(map, EFFECT_ENVIRONMENT_MAP);
    expect_absent(map, EFFECT_ENVIRONMENT);

    OneQuad lights;
    lights.options.light.points.push_back({{0, 0, 1}, glm::dvec3(1)});
    lights.options.light.suns.push_back({{0, 0, 1}, glm::dvec3(1), 0});
    expect_present(lights, EFFECT_DELTA_LIGHT, "1 by --point, 1 by --sun");
    lights.options.light.points[0].intensity = lights.options.light.suns[0].irradiance = glm::dvec3(0);
    expect_absent(lights, EFFECT_DELTA_LIGHT);
}

TEST(Effects, NormalsAndFiltersAreFoundWithoutMaterials) {
    OneQuad smooth;
    smooth.build.raw("v 0 0 1\nv 1 0 1\nv 0 1 1\nvn 0 0.6 0.8\nf -3//-1 -2//-1 -1//-1");
    expect_present(smooth, EFFECT_SMOOTH_NORMALS, "triangle 2 (" + smooth.folder.file("scene.obj") + ":");

    OneQuad filtered;
    filtered.options.film.filter = Filter::GAUSSIAN;
    expect_present(filtered, EFFECT_FILTER, "--filter");
}

TEST(Effects, AllIsTheFullMaskAndChangesNoWitness) {
    OneQuad scene;
    const Effects needed = scene.effects();
    scene.options.effects.all = true;
    const Effects all = scene.effects();
    EXPECT_EQ(all.mask, EFFECT_ALL);
    for (size_t i = 0; i < all.list.size(); ++i) {
        EXPECT_EQ(all.list[i].present, needed.list[i].present);
        EXPECT_EQ(all.list[i].witness, needed.list[i].witness);
    }
}

TEST(Effects, OptionsOfTheOptionsFileAreNamedWithTheirLine) {
    OneQuad scene;
    scene.options.light.environment = glm::dvec3(1);
    scene.options.run.given["--env"] = "room.clrt:7";
    expect_present(scene, EFFECT_ENVIRONMENT, "--env (room.clrt:7)");
    const Effects effects = scene.effects();
    EXPECT_EQ(find(effects, EFFECT_ENVIRONMENT).place.file, "room.clrt");
    EXPECT_EQ(find(effects, EFFECT_ENVIRONMENT).place.line, 7u);
    scene.options.run.given["--env"] = ""; // on the command line
    EXPECT_EQ(scene.effects().list[2].witness, "--env: radiance above 0");
}

TEST(Effects, MapsAreNamedWithTheLineOfTheirStatement) {
    const OneQuad scene("Kd 0.5 0.5 0.5\nmap_Kd map.exr\nnorm map.exr");
    const std::string mtl = scene.folder.file("scene.mtl");
    expect_present(scene, EFFECT_TEXTURES, "map \"map.exr\" (" + mtl + ":3)");
    expect_present(scene, EFFECT_NORMAL_MAP, "map \"map.exr\" (" + mtl + ":4)");
    EXPECT_EQ(find(scene.effects(), EFFECT_NORMAL_MAP).place.line, 4u);
}

TEST(Effects, InterreflectionTakesAThirdSegment) {
    OneQuad scene;
    expect_present_at_run_time(scene, EFFECT_INTERREFLECTION, "4096 segments, material \"thing\"");
    scene.options.transport.max_depth = 2;
    EXPECT_FALSE(find(scene.effects(), EFFECT_INTERREFLECTION).present);
    scene.options.transport.max_depth.reset();
    scene.options.transport.integrator = Integrator::RAYCAST;
    EXPECT_FALSE(find(scene.effects(), EFFECT_INTERREFLECTION).present);
    EXPECT_EQ(find(OneQuad("Kd 0 0 0").effects(), EFFECT_INTERREFLECTION).witness, "no material reflects");
}

TEST(Effects, AListIsCompiledAndWhatItLacksIsLeftOut) {
    OneQuad scene("Ni 1.5\nillum 7\nPr 0.3");
    scene.options.light.environment = glm::dvec3(1);
    scene.options.effects.list = EFFECT_ROUGH_REFRACTION | EFFECT_MATTE;
    const Effects list = scene.effects();
    EXPECT_EQ(list.mask, EffectMask(EFFECT_ROUGH_REFRACTION | EFFECT_REFRACTION | EFFECT_MATTE));
    EXPECT_EQ(list.left_out, EFFECT_ENVIRONMENT | EFFECT_INTERREFLECTION);
    EXPECT_NE(describe_left_out(list).at(0).find("environment: black"), std::string::npos);

    scene.options.effects.list.reset();
    scene.options.effects.off = EFFECT_REFRACTION | EFFECT_MIRROR;
    const Effects without = scene.effects();
    EXPECT_EQ(without.mask, EFFECT_ENVIRONMENT);
    EXPECT_EQ(without.left_out, EffectMask(EFFECT_REFRACTION | EFFECT_ROUGH_REFRACTION));

    scene.options.effects.all = true;
    EXPECT_EQ(scene.effects().mask,
              EffectMask(EFFECT_ALL &
                         ~(EFFECT_REFRACTION | EFFECT_ROUGH_REFRACTION | EFFECT_MIRROR | EFFECT_PART_GLASS |
                           EFFECT_ATTENUATION | EFFECT_DISPERSION | EFFECT_NESTED)));
    scene.options.effects.off = 0;
    EXPECT_EQ(scene.effects().left_out, 0u);
    EXPECT_TRUE(describe_left_out(scene.effects()).empty());
}

TEST(Explain, TheTableNamesEffectsMaterialsAndFallbacks) {
    OneQuad scene("Kd 0.5 0.5 0.5\nmap_Kd none.png");
    scene.options.scene.path = "quad.obj";
    const std::string text = explain(scene.load(), scene.effects(), scene.options);
    for (const char* expected : {"quad.obj", "2 triangles", "present  matte ", "absent   refraction", "thing",
                                 "illum 1: matte Kd", "CLRT_EFFECTS=0x10", "none.png", "camera: --eye"})
        EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
}

TEST(Explain, TheJsonHoldsTheSame) {
    OneQuad scene("Ni 1.5\nillum 7");
    scene.options.run.explain = Explain::JSON;
    const auto json = nlohmann::json::parse(explain(scene.load(), scene.effects(), scene.options));
    EXPECT_EQ(json["triangles"], 2);
    ASSERT_EQ(json["effects"].size(), scene.effects().list.size());
    for (const auto& effect : json["effects"]) {
        const bool interreflection = effect["name"] == "interreflection";
        EXPECT_EQ(effect["present"], effect["name"] == "refraction" || interreflection);
        EXPECT_EQ(effect["present"], effect["compiled"]);
        EXPECT_EQ(effect["left_out"], false);
        EXPECT_FALSE(effect["witness"].get<std::string>().empty());
        EXPECT_EQ(effect["line"].is_null(), effect["present"] == false) << effect;
    }
    EXPECT_EQ(json["materials"][0]["name"], "thing");
    EXPECT_EQ(json["materials"][0]["line"], 1);
    EXPECT_EQ(json["effects_mask"], EFFECT_REFRACTION);
    EXPECT_TRUE(json["notices"].is_array());
}

} // namespace clrt
