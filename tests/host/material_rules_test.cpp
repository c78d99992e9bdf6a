// SPDX-License-Identifier: Apache-2.0
// Every rule of the MTL table, and what it makes for the kernels.
#include "scene/readers/mtl_rules.h"

#include "scene/conductors.h"
#include "scene/material_table.h"
#include "scene_support.h"
#include "support/mtl_material.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace clrt;

namespace {

/// A material made from MTL text; maps are "read" in the order of their loading, files named missing* are
/// not.
struct Ruled {
    Material m;
    std::string rule;
    std::vector<std::string> loaded, notices;

    explicit Ruled(const std::string& text, const MaterialContext& context = {}) {
        NoticeList list;
        const std::vector<MtlMaterial> parsed = parse_mtl("newmtl m\n" + text, "a.mtl", list);
        const RuledMaterial ruled = rule_material(
            parsed.at(0), context,
            [&](const TextureUse& use, TextureRole) {
                if (use.file.rfind("missing", 0) == 0)
                    return NO_INDEX;
                loaded.push_back(use.file);
                return u32(loaded.size() - 1);
            },
            list);
        m = ruled.material;
        rule = ruled.rule;
        notices = list.lines();
    }

    std::string file(u32 map) const { return map == NO_INDEX ? "" : loaded.at(map); }
};

void expect_colour(const vec4& v, double r, double g, double b) {
    EXPECT_FLOAT_EQ(v.x, float(r));
    EXPECT_FLOAT_EQ(v.y, float(g));
    EXPECT_FLOAT_EQ(v.z, float(b));
}

} // namespace

TEST(MaterialRules, IllumZeroAndOneAreMatte) {
    for (const char* illum : {"0", "1"}) {
        const Ruled r(std::string("illum ") + illum +
                      "\nKd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nNs 100\nmap_Ks s.png\n");
        EXPECT_EQ(r.m.lobes, LOBE_MATTE);
        expect_colour(r.m.matte, 0.1, 0.2, 0.3);
        EXPECT_EQ(r.m.specular.w, 0);
        EXPECT_TRUE(r.loaded.empty()) << "maps without effect are not loaded";
        EXPECT_EQ(count_notices(r.notices, "Ks has no effect"), 1);
    }
}

TEST(MaterialRules, IllumTwoIsMatteAndGloss) {
    const Ruled r("illum 2\nKd 0.1 0.2 0.3\nKs 0.4 0.5 0.6\nNs 30\n");
    EXPECT_EQ(r.m.lobes, LOBE_MATTE | LOBE_GLOSSY);
    EXPECT_EQ(r.m.fresnel, FRESNEL_NONE);
    expect_colour(r.m.specular, 0.4, 0.5, 0.6);
    EXPECT_FLOAT_EQ(r.m.alpha_x, 0.25f); // sqrt(2 / 32)
    EXPECT_FLOAT_EQ(r.m.alpha_y, 0.25f);
    EXPECT_FLOAT_EQ(r.m.roughness_sqrt_x, 0.5f);
    EXPECT_EQ(r.m.specular.w, 30) << "the local models use Ns itself";
    EXPECT_EQ(r.m.flags, 0u);
}

TEST(MaterialRules, IllumTwoStaysRoughForLargeNs) {
    const Ruled r("illum 2\nKs 0.5 0.5 0.5\nNs 100000\n");
    EXPECT_EQ(r.m.lobes, LOBE_GLOSSY);
    EXPECT_FLOAT_EQ(r.m.alpha_x, float(std::sqrt(2 / 100002.)));
}

TEST(MaterialRules, IllumThreeAndEightReflectWithoutFresnel) {
    for (const char* illum : {"illum 3\n", "illum 8\n"}) {
        const Ruled rough(std::string(illum) + "Kd 0.1 0.1 0.1\nKs 0.5 0.6 0.7\nNs 998\n");
        EXPECT_EQ(rough.m.lobes, LOBE_MATTE | LOBE_GLOSSY);
        EXPECT_FLOAT_EQ(rough.m.alpha_x, float(std::sqrt(2 / 1000.)));
        EXPECT_EQ(rough.m.specular.w, 998);
        EXPECT_EQ(rough.m.fresnel, FRESNEL_NONE);
        EXPECT_EQ(rough.m.flags, MATERIAL_WHITTED_MIRROR);
        for (const char* ns : {"", "Ns 1000\n", "Ns 100000\n"}) {
            const Ruled mirror(std::string(illum) + "Kd 0.1 0.1 0.1\nKs 0.5 0.6 0.7\n" + ns);
            EXPECT_EQ(mirror.m.lobes, LOBE_MATTE | LOBE_MIRROR) << ns;
            EXPECT_EQ(mirror.m.alpha_x, 0);
            EXPECT_EQ(mirror.m.specular.w, 0) << "a mirror has no highlight";
            EXPECT_EQ(mirror.m.flags, MATERIAL_WHITTED_MIRROR);
        }
    }
}

TEST(MaterialRules, IllumFiveIsAMirrorWithSchlicksFresnel) {
    for (const char* ns : {"", "Ns 10\n", "Ns 1000\n"}) {
        const Ruled r(std::string("illum 5\nKd 0.01 0.01 0.01\nKs 0.95 0.95 0.95\n") + ns);
        EXPECT_EQ(r.m.lobes, LOBE_MATTE | LOBE_MIRROR) << ns;
        EXPECT_EQ(r.m.fresnel, FRESNEL_SCHLICK);
        EXPECT_EQ(r.m.flags, MATERIAL_WHITTED_MIRROR);
        expect_colour(r.m.specular, 0.95, 0.95, 0.95);
    }
}

TEST(MaterialRules, TheOtherModelsAreSmoothDielectrics) {
    for (const char* illum : {"4", "6", "7", "9"}) {
        const Ruled r(std::string("illum ") + illum +
                      "\nKd 1 1 1\nKs 0.2 0.2 0.2\nNs 50\nNi 1.33\nTf 0.9 0.8 0.7\nmap_Kd a.png\n");
        EXPECT_EQ(r.m.lobes, LOBE_DIELECTRIC) << illum;
        EXPECT_EQ(r.m.alpha_x, 0) << "Ns on glass means nothing";
        EXPECT_FLOAT_EQ(r.m.transmission.w, 1.33f);
        expect_colour(r.m.transmission, 0.9, 0.8, 0.7);
        EXPECT_EQ(r.m.specular.w, 0);
        EXPECT_TRUE(r.loaded.empty());
    }
    EXPECT_EQ(Ruled("illum 7\nNi 1\n").m.transmission.w, 1) << "an index of exactly 1 is allowed";
    EXPECT_EQ(Ruled("illum 7\nNi 1\nPr 0.5\n").m.alpha_x, 0) << "equal indices bend nothing, roughly or not";
}

TEST(MaterialRules, AbsentIllumIsTwoWithKsAndOneWithout) {
    EXPECT_EQ(Ruled("Kd 0.5\nKs 0 0.1 0\n").rule.substr(0, 7), "illum 2");
    EXPECT_EQ(Ruled("Kd 0.5\nKs 0 0 0\n").rule.substr(0, 7), "illum 1");
    EXPECT_EQ(Ruled("Kd 0.5\n").rule.substr(0, 7), "illum 1");
    EXPECT_EQ(Ruled("Kd 0.5\nmap_Ks s.png\n").rule.substr(0, 7), "illum 2");
}

TEST(MaterialRules, AbsentNsIsTenForGloss) {
    const Ruled r("Ks 0.5\n");
    EXPECT_FLOAT_EQ(r.m.alpha_x, float(std::sqrt(2 / 12.)));
    EXPECT_EQ(r.m.specular.w, 10);
}

TEST(MaterialRules, AbsentNiDAndTf) {
    const Ruled r("illum 7\n");
    EXPECT_EQ(r.m.transmission.w, 1.5f);
    EXPECT_EQ(r.m.matte.w, 1);
    expect_colour(r.m.transmission, 1, 1, 1);
}

TEST(MaterialRules, AbsentKdDependsOnItsNeighbours) {
    expect_colour(Ruled("").m.matte, 0.8, 0.8, 0.8);
    expect_colour(Ruled("Ns 5\nd 0.5\n").m.matte, 0.8, 0.8, 0.8);
    for (const char* neighbour : {"Ks 0.5\n", "Ke 1\n", "Tf 1\n"}) {
        expect_colour(Ruled(neighbour).m.matte, 0, 0, 0);
        const Ruled with_map(std::string(neighbour) + "map_Kd a.png\n");
        EXPECT_GT(with_map.m.matte.x, 0.6f) << neighbour; // 1, or 1 / 1.5 with Ks
        EXPECT_EQ(with_map.file(with_map.m.map_matte), "a.png");
    }
    expect_colour(Ruled("map_Kd a.png\n").m.matte, 1, 1, 1);
    expect_colour(Ruled("map_Kd missing.png\n").m.matte, 1, 1, 1);
    expect_colour(build_material({}, {}, {}).matte, 0.8, 0.8, 0.8);
    EXPECT_EQ(build_material({}, {}, {}).lobes, LOBE_MATTE);
}

TEST(MaterialRules, MapsAloneSetTheirConstantToOneOnlyIfTheyCanBeRead) {
    const Ruled gloss("Kd 0.2\nmap_Ks s.png\n");
    expect_colour(gloss.m.specular, 1 / 1.2, 1 / 1.2, 1 / 1.2);
    EXPECT_EQ(gloss.file(gloss.m.map_specular), "s.png");
    EXPECT_EQ(Ruled("Kd 0.2\nmap_Ks missing.png\n").m.lobes, LOBE_MATTE);
    expect_colour(Ruled("map_Ke e.png\n").m.emission, 1, 1, 1);
    expect_colour(Ruled("map_Ke missing.png\n").m.emission, 0, 0, 0);
}

TEST(MaterialRules, KeyAndMapMultiplyAndAZeroKeyHidesItsMap) {
    const Ruled r("Kd 0.5\nmap_Kd a.png\nKe 2 3 4\nmap_Ke e.png\n");
    expect_colour(r.m.matte, 0.5, 0.5, 0.5);
    expect_colour(r.m.emission, 2, 3, 4);
    EXPECT_EQ(r.file(r.m.map_matte), "a.png");
    EXPECT_EQ(r.file(r.m.map_emission), "e.png");
    const Ruled hidden("Kd 0 0 0\nmap_Kd a.png\nKe 0 0 0\nmap_Ke e.png\n");
    EXPECT_TRUE(hidden.loaded.empty());
    EXPECT_EQ(count_notices(hidden.notices, "Kd is 0, so map_Kd has no effect"), 1);
    EXPECT_EQ(count_notices(hidden.notices, "Ke is 0, so map_Ke has no effect"), 1);
}

TEST(MaterialRules, MatteAndReflectionTogetherGiveBackAtMostWhatTheyGet) {
    for (const char* illum : {"illum 2\n", "illum 3\n", "illum 8\n"}) {
        const Ruled r(std::string(illum) + "Kd 0.9 0.2 0.3\nKs 0.6 0.3 0.1\nNs 20\n");
        expect_colour(r.m.matte, 0.6, 0.2 / 1.5, 0.2); // the largest sum is 1.5, in red
        expect_colour(r.m.specular, 0.4, 0.2, 0.1 / 1.5);
    }
    expect_colour(Ruled("Kd 0.5\nKs 0.5\n").m.matte, 0.5, 0.5, 0.5);
    expect_colour(Ruled("illum 1\nKd 1\nKs 1\n").m.matte, 1, 1, 1);
}

TEST(MaterialRules, EtaMakesAConductor) {
    const Ruled r("Kd 0.9 0.7 0.2\nKs 1\nPm 1\nPr 0.5\neta 0.2 1.1 1.2\nk 3.9 2.4 2.2\n");
    EXPECT_EQ(r.rule, "conductor eta, k, Pr");
    EXPECT_EQ(r.m.fresnel, FRESNEL_CONDUCTOR);
    EXPECT_EQ(r.m.lobes, LOBE_GLOSSY) << "nothing below a metal's surface is seen";
    expect_colour(r.m.transmission, 0.2, 1.1, 1.2);
    expect_colour(r.m.specular, 3.9, 2.4, 2.2);
    EXPECT_FLOAT_EQ(r.m.alpha_x, 0.25f);
    const Ruled polished("conductor gold\nNs 20\n");
    EXPECT_EQ(polished.m.lobes, LOBE_MIRROR);
    EXPECT_TRUE(polished.m.flags & MATERIAL_WHITTED_MIRROR);
    // What has no reflectance, or no float to square, is kept away from the kernels.
    const Ruled odd("eta 0 1e30 1\nk 0 1e30 0\n");
    expect_colour(odd.m.transmission, CONDUCTOR_SMALLEST_ETA, CONDUCTOR_LARGEST_INDEX, 1);
    expect_colour(odd.m.specular, 0, CONDUCTOR_LARGEST_INDEX, 0);
    EXPECT_EQ(count_notices(Ruled("k 2\nKd 1\n").notices, "k without eta has no effect"), 1);
    EXPECT_EQ(Ruled("k 2\nKd 1\n").m.lobes, LOBE_MATTE);
}

TEST(MaterialRules, MetalsHaveTheColoursThatTheyAreKnownBy) {
    const auto head_on = [](const char* name) { return conductor_head_on(*find_conductor(name)); };
    const glm::dvec3 gold = head_on("gold"), copper = head_on("copper"), silver = head_on("silver");
    EXPECT_GT(gold.x, 0.95);
    EXPECT_LT(gold.z, 0.4);
    EXPECT_GT(copper.x, copper.y + 0.2);
    EXPECT_GT(copper.y, copper.z);
    for (int c = 0; c < 3; ++c) {
        EXPECT_GT(silver[c], 0.95);
        EXPECT_NEAR(head_on("aluminium")[c], 0.92, 0.02);
        EXPECT_NEAR(head_on("iron")[c], 0.57, 0.03);
    }
}

TEST(MaterialRules, PrIsTheRoughnessOfWhateverLobeThereIs) {
    const Ruled gloss("illum 2\nKs 0.5\nNs 10\nPr 0.5\n");
    EXPECT_FLOAT_EQ(gloss.m.alpha_x, 0.25f);
    EXPECT_FLOAT_EQ(gloss.m.roughness_sqrt_x, 0.5f);
    EXPECT_FLOAT_EQ(gloss.m.specular.w, 30) << "2 / alpha^2 - 2";
    const Ruled reflection("illum 3\nKs 0.5\nNs 100000\nPr 0.5\n");
    EXPECT_EQ(reflection.m.lobes, LOBE_GLOSSY);
    EXPECT_EQ(reflection.m.flags, MATERIAL_WHITTED_MIRROR);
    EXPECT_FLOAT_EQ(reflection.m.specular.w, 30);
    const Ruled mirror("illum 5\nKs 0.5\nPr 0.5\n");
    EXPECT_EQ(mirror.m.lobes, LOBE_GLOSSY);
    EXPECT_EQ(mirror.m.fresnel, FRESNEL_SCHLICK);
    const Ruled glass("illum 7\nPr 0.5\n");
    EXPECT_EQ(glass.m.lobes, LOBE_DIELECTRIC);
    EXPECT_FLOAT_EQ(glass.m.alpha_x, 0.25f);
    EXPECT_EQ(glass.m.specular.w, 0);
    EXPECT_EQ(Ruled("illum 1\nPr 0.5\n").m.alpha_x, 0);
}

TEST(MaterialRules, VerySmallRoughnessIsAMirror) {
    const Ruled gloss("illum 2\nKs 0.5\nPr 0.0099\n"); // alpha 0.98e-4
    EXPECT_EQ(gloss.m.lobes, LOBE_MIRROR);
    EXPECT_EQ(gloss.m.alpha_x, 0);
    EXPECT_EQ(gloss.m.specular.w, 0);
    EXPECT_EQ(gloss.m.flags, MATERIAL_WHITTED_MIRROR) << "a mirror without a highlight must be followed";
    EXPECT_EQ(Ruled("illum 2\nKs 0.5\nPr 0.0101\n").m.lobes, LOBE_GLOSSY);
    EXPECT_EQ(Ruled("illum 7\nPr 0.0099\n").m.alpha_x, 0);
    EXPECT_EQ(Ruled("illum 3\nKs 1\nPr 0\nmap_Pr p.png\n").loaded.size(), 0u);
}

TEST(MaterialRules, TheWidestHighlightIsStillAHighlight) {
    EXPECT_GT(Ruled("illum 2\nKs 0.5\nNs 0\n").m.specular.w, 0);
    EXPECT_GT(Ruled("illum 2\nKs 0.5\nPr 1\n").m.specular.w, 0);
    EXPECT_EQ(Ruled("illum 2\nKs 0.5\nNs 0\n").m.alpha_x, 1);
}

TEST(MaterialRules, RoughnessMapsMultiplyPr) {
    const Ruled both("illum 2\nKs 0.5\nPr 0.5\nmap_Pr p.png\n");
    EXPECT_FLOAT_EQ(both.m.roughness_sqrt_x, 0.5f);
    EXPECT_EQ(both.file(both.m.map_roughness), "p.png");
    const Ruled alone("illum 3\nKs 0.5\nmap_Pr p.png\n");
    EXPECT_EQ(alone.m.lobes, LOBE_GLOSSY);
    EXPECT_EQ(alone.m.roughness_sqrt_x, 1);
    const Ruled missing("illum 2\nKs 0.5\nNs 30\nmap_Pr missing.png\n");
    EXPECT_FLOAT_EQ(missing.m.alpha_x, 0.25f) << "without its map Ns counts again";
    EXPECT_EQ(missing.m.specular.w, 30);
}

TEST(MaterialRules, AnisotropyStretchesTheLobe) {
    const Ruled r("illum 2\nKs 0.5\nPr 0.5\naniso 0.7\n");
    const double aspect = std::sqrt(1 - 0.9 * 0.7);
    EXPECT_FLOAT_EQ(r.m.alpha_x, float(0.25 / aspect));
    EXPECT_FLOAT_EQ(r.m.alpha_y, float(0.25 * aspect));
    EXPECT_FLOAT_EQ(r.m.roughness_sqrt_x * r.m.roughness_sqrt_x, r.m.alpha_x);
    EXPECT_FLOAT_EQ(r.m.roughness_sqrt_y * r.m.roughness_sqrt_y, r.m.alpha_y);
}

TEST(MaterialRules, MetallicRoughnessReplacesIllum) {
    const Ruled r("illum 7\nKd 0.5 0.25 0.1\nKs 1 1 1\nPm 0.5\nPr 0.5\n");
    EXPECT_EQ(r.m.lobes, LOBE_MATTE | LOBE_GLOSSY);
    EXPECT_EQ(r.m.fresnel, FRESNEL_SCHLICK);
    EXPECT_EQ(r.m.flags, 0u) << "without maps the mix is resolved";
    expect_colour(r.m.specular, 0.27, 0.145, 0.07);
    expect_colour(r.m.matte, 0.25, 0.125, 0.05);
    EXPECT_FLOAT_EQ(r.m.specular.w, 30);
    EXPECT_EQ(count_notices(r.notices, "Pm is given"), 1);
    EXPECT_EQ(Ruled("Kd 0.5\nPm 1\nPr 0.5\n").m.lobes, LOBE_GLOSSY) << "a metal has no matte part";
}

TEST(MaterialRules, ColoursBelowFresnelsReflectionStayWhatTheyAre) {
    const Ruled plastic("Kd 1\nPm 0\nPr 0.5\n");
    expect_colour(plastic.m.matte, 1, 1, 1);
    expect_colour(plastic.m.specular, 0.04, 0.04, 0.04);
    const Ruled metal("Kd 1\nPm 1\nPr 0.5\n");
    expect_colour(metal.m.specular, 1, 1, 1);
    expect_colour(Ruled("Kd 1\nPm 1\nmap_Pm p.png\nPr 0.5\n").m.matte, 1, 1, 1);
    const Ruled mirror("illum 5\nKd 0.8\nKs 0.5\n");
    expect_colour(mirror.m.matte, 0.8, 0.8, 0.8);
    expect_colour(mirror.m.specular, 0.5, 0.5, 0.5);
}

TEST(MaterialRules, MapsMakeTheMetallicMixPerTexel) {
    const Ruled by_pm("Kd 0.5\nPm 0.7\nmap_Pm p.png\nPr 0.5\n");
    EXPECT_EQ(by_pm.m.flags, MATERIAL_METALLIC_ROUGHNESS);
    EXPECT_EQ(by_pm.m.lobes, LOBE_MATTE | LOBE_GLOSSY);
    expect_colour(by_pm.m.matte, 0.5, 0.5, 0.5);
    EXPECT_FLOAT_EQ(by_pm.m.emission.w, 0.7f);
    EXPECT_EQ(by_pm.file(by_pm.m.map_metallic), "p.png");

    const Ruled by_kd("Pm 0.7\nmap_Kd k.png\nPr 0.5\n");
    EXPECT_EQ(by_kd.m.flags, MATERIAL_METALLIC_ROUGHNESS);
    EXPECT_EQ(by_kd.file(by_kd.m.map_matte), "k.png");

    EXPECT_EQ(Ruled("map_Pm p.png\n").m.emission.w, 1) << "map_Pm alone means Pm 1";
    EXPECT_EQ(Ruled("map_Pm missing.png\nKd 0.5\n").m.flags, 0u);
}

TEST(MaterialRules, PureMetalsAndDielectricsNeedNoMixPerTexel) {
    const Ruled metal("Pm 1\nmap_Kd k.png\nPr 0.5\n");
    EXPECT_EQ(metal.m.flags, 0u);
    EXPECT_EQ(metal.m.lobes, LOBE_GLOSSY);
    EXPECT_EQ(metal.file(metal.m.map_specular), "k.png") << "the colour of a metal is its reflection's";
    EXPECT_EQ(metal.m.map_matte, NO_INDEX);
    const Ruled plastic("Pm 0\nmap_Kd k.png\nPr 0.5\n");
    EXPECT_EQ(plastic.m.flags, 0u);
    EXPECT_EQ(plastic.file(plastic.m.map_matte), "k.png");
    expect_colour(plastic.m.specular, 0.04, 0.04, 0.04);
}

TEST(MaterialRules, WhittedFollowsPolishedMetals) {
    EXPECT_TRUE(Ruled("Kd 0.5\nPm 1\nPr 0.1\n").m.flags & MATERIAL_WHITTED_MIRROR);
    EXPECT_FALSE(Ruled("Kd 0.5\nPm 1\nPr 0.11\n").m.flags & MATERIAL_WHITTED_MIRROR);
    EXPECT_TRUE(Ruled("Kd 0.5\nPm 1\nPr 0\n").m.lobes & LOBE_MIRROR);
}

TEST(MaterialRules, CoverageIsDThenTrAndItsMap) {
    EXPECT_EQ(Ruled("d 0.25\n").m.matte.w, 0.25f);
    EXPECT_EQ(Ruled("Tr 0.25\n").m.matte.w, 0.75f);
    const Ruled both("Tr 0.25\nd 0.5\n");
    EXPECT_EQ(both.m.matte.w, 0.5f) << "d wins over Tr";
    EXPECT_EQ(count_notices(both.notices, "d and Tr disagree"), 1);
    EXPECT_EQ(count_notices(Ruled("Tr 0.25\nd 0.75\n").notices, "disagree"), 0);
    EXPECT_EQ(both.m.flags, MATERIAL_CUT_OUT);
    EXPECT_EQ(Ruled("d 1\n").m.flags, 0u);
    const Ruled mapped("map_d leaf.png\n");
    EXPECT_EQ(mapped.m.flags, MATERIAL_CUT_OUT);
    EXPECT_EQ(mapped.file(mapped.m.map_coverage), "leaf.png");
    EXPECT_EQ(Ruled("map_d missing.png\n").m.flags, 0u);
    EXPECT_EQ(count_notices(Ruled("d 0\n").notices, "invisible"), 1);
}

TEST(MaterialRules, EmissionIsOneSidedUnlessAsked) {
    const Ruled r("Ke 10 5 2\n");
    expect_colour(r.m.emission, 10, 5, 2);
    EXPECT_EQ(r.m.flags, 0u);
    EXPECT_EQ(Ruled("Ke 10 5 2\n", {1, true}).m.flags, MATERIAL_EMITS_BOTH_SIDES);
    EXPECT_EQ(Ruled("Kd 1\n", {1, true}).m.flags, 0u) << "what is dark emits on no side";
}

TEST(MaterialRules, BumpHeightsAreInSceneUnits) {
    const Ruled r("map_Bump -bm 3 b.png\nnorm n.png\n", {0.25, false});
    EXPECT_FLOAT_EQ(r.m.bump_scale, 0.75f);
    EXPECT_EQ(r.file(r.m.map_bump), "b.png");
    EXPECT_EQ(r.file(r.m.map_normal), "n.png");
    EXPECT_EQ(Ruled("bump -bm 0 b.png\n").m.map_bump, NO_INDEX);
}

TEST(MaterialRules, NormalMapsAloneHaveAStrength) {
    EXPECT_EQ(Ruled("norm n.png\n", {0.25, false}).m.bump_scale, 1);
    EXPECT_EQ(Ruled("norm -bm 0.7 n.png\n", {0.25, false}).m.bump_scale, 0.7f);
    EXPECT_EQ(Ruled("norm -bm 0 n.png\n").m.map_normal, NO_INDEX);
    const Ruled missing("norm -bm 0.7 n.png\nbump -bm 3 missing.png\n", {0.25, false});
    EXPECT_EQ(missing.m.bump_scale, 0.7f) << "an unreadable bump map does not count";
}

TEST(MaterialRules, KeysWithoutAMeaningAreSaid) {
    const Ruled r("Pr 0.5\nmap_Ns n.png\nmap_refl r.png\n");
    for (const char* notice : {"a.mtl:3: map_Ns has no effect", "a.mtl:4: map_refl has no effect"})
        EXPECT_EQ(count_notices(r.notices, notice), 1) << notice;
}

TEST(MaterialRules, CoatsSheensAndTurnedHighlightsAreLobesOfAnyModel) {
    const Ruled bare("Pr 0.5\nPc 0\nPcr 0.03\nPs 0\naniso 0\nanisor 0.5\n");
    EXPECT_TRUE(bare.notices.empty());
    EXPECT_FALSE(bare.m.lobes & (LOBE_COAT | LOBE_SHEEN));
    EXPECT_FALSE(bare.m.flags & MATERIAL_TURNED) << "what is not stretched has no direction";
    EXPECT_EQ(Ruled("illum 1\nKd 1 1 1\nPc 0.5\nPs 0.5\n").m.lobes, LOBE_MATTE | LOBE_COAT | LOBE_SHEEN);
    EXPECT_TRUE(Ruled("Pm 1\nPr 0.5\naniso 0.5\nanisor 0.25\n").m.flags & MATERIAL_TURNED);
}

TEST(MaterialRules, PanesAndSolidsThatAbsorb) {
    EXPECT_EQ(Ruled("illum 7\nthin_walled 1\n").m.lobes, LOBE_PANE);
    const char* const honey = "illum 7\nattenuation 0.5 0.5 0.5\n";
    EXPECT_TRUE(Ruled(honey).m.flags & MATERIAL_ATTENUATES);
    EXPECT_FALSE(Ruled(std::string(honey) + "thin_walled 1\n").m.flags & MATERIAL_ATTENUATES) << "no inside";
    EXPECT_FALSE(Ruled(std::string(honey) + "Ke 1 1 1\n").m.flags & MATERIAL_ATTENUATES);
    EXPECT_FALSE(Ruled("illum 1\nattenuation 0.5 0.5 0.5\n").m.flags & MATERIAL_ATTENUATES) << "no glass";
}

TEST(MaterialRules, SolidGlassWithAnAbbeNumberDisperses) {
    const Ruled flint("illum 7\nNi 1.6\nabbe 30\n");
    EXPECT_TRUE(flint.notices.empty());
    EXPECT_TRUE(flint.m.flags & MATERIAL_DISPERSES);
    for (const char* const keys : {"illum 7\nNi 1.6\nabbe 0\n", "illum 7\nNi 1\nabbe 30\n",
                                   "illum 2\nabbe 30\n", "illum 7\nthin_walled 1\nabbe 30\n"})
        EXPECT_FALSE(Ruled(keys).m.flags & MATERIAL_DISPERSES) << keys;
}

TEST(MaterialRules, SolidsAreNestedWhereAnyHasAPriority) {
    const MaterialContext nested{1, false, true};
    EXPECT_TRUE(Ruled("illum 7\n", nested).m.flags & MATERIAL_NESTED);
    EXPECT_FALSE(Ruled("illum 7\n").m.flags & MATERIAL_NESTED);
    for (const char* const keys : {"illum 2\n", "illum 7\nthin_walled 1\n"})
        EXPECT_FALSE(Ruled(keys, nested).m.flags & MATERIAL_NESTED) << keys << " has no inside";
}

TEST(MaterialRules, TheExtensionIsInUnitsOfTheKernels) {
    MaterialDescription d;
    d.abbe = 25;
    d.reflection = Reflection::METALLIC;
    d.base.value = glm::dvec3(0.5);
    d.transmission_weight.value = 0.25;
    d.attenuation_colour = {0.5, 1, 0};
    d.attenuation_distance = 2;
    d.roughness.value = 0.5;
    d.anisotropy = 0.5;
    d.anisotropy_rotation = 0.25;
    d.coat_weight.value = 0.75;
    d.coat_roughness.value = 0.5;
    const MaterialContext half{0.5, false};
    const MaterialExtension e = build_extension(d, build_material(d, half, {}), half, {}).extension;
    EXPECT_FLOAT_EQ(e.attenuation.x, float(std::log(2.0))) << "behind one unit of the frame half is left";
    EXPECT_EQ(e.attenuation.y, 0);
    EXPECT_TRUE(std::isfinite(e.attenuation.z));
    EXPECT_EQ(EXTENSION_TRANSMISSION(e), 0.25f);
    EXPECT_EQ(e.spread, 0.02f) << "an index of 1.5";
    EXPECT_NEAR(e.turn_cos, 0, 1e-7);
    EXPECT_EQ(e.turn_sin, 1);
    EXPECT_EQ(e.coat, 0.75f);
    EXPECT_EQ(e.coat_alpha, 0.25f);
}

TEST(MaterialRules, TheReflectanceOfTheDielectricPartCanBeGiven) {
    NoticeList notices;
    const auto with_f0 = [&](const std::string& text, double f0, const char* map) {
        MtlMaterial mtl = parse_mtl("newmtl m\n" + text, "a.mtl", notices).at(0);
        mtl.dielectric_f0 = f0;
        if (map) {
            mtl.map_dielectric_f0.emplace();
            mtl.map_dielectric_f0->file = map;
        }
        u32 maps = 0;
        return rule_material(
                   mtl, {}, [&](const TextureUse&, TextureRole) { return maps++; }, notices)
            .material;
    };
    const Material plain = with_f0("Kd 1\nPm 0\nPr 0.5\n", 0.2, nullptr);
    expect_colour(plain.specular, 0.2, 0.2, 0.2);
    EXPECT_EQ(plain.matte.x, 1.0f);
    const Material mixed = with_f0("Kd 0.6\nPm 0.5\nPr 0.5\n", 0.2, nullptr);
    expect_colour(mixed.specular, 0.4, 0.4, 0.4);
    const Material mapped = with_f0("Kd 0.6\nPm 0.5\nPr 0.5\n", 0.2, "f0.png");
    EXPECT_EQ(mapped.flags, MATERIAL_METALLIC_ROUGHNESS);
    expect_colour(mapped.specular, 0.2, 0.2, 0.2);
    EXPECT_EQ(mapped.map_specular, 0u);
    EXPECT_EQ(with_f0("Kd 0.6\nPm 0\nPr 0.5\n", 0.2, "f0.png").flags, 0u) << "no mix is needed";
    EXPECT_EQ(with_f0("Kd 0.6\nPm 1\nPr 0.5\n", 0.2, "f0.png").map_specular, NO_INDEX) << "all is metal";
    EXPECT_EQ(with_f0("Kd 0.6\nPm 0\nPr 0.5\n", 0, "f0.png").lobes, LOBE_MATTE);
}

TEST(MaterialRules, ReflectionWithoutKsIsNoted) {
    const Ruled r("illum 3\nKd 0.5\n");
    EXPECT_EQ(r.m.lobes, LOBE_MATTE);
    EXPECT_EQ(count_notices(r.notices, "illum 3 without Ks reflects nothing"), 1);
    EXPECT_EQ(Ruled("illum 2\nKd 0.5\nKs 0 0 0\n").notices.size(), 0u);
}

TEST(MaterialRules, BlackMaterialsHaveNoLobes) {
    EXPECT_EQ(Ruled("Kd 0 0 0\nKs 0 0 0\n").m.lobes, 0u);
}

TEST(MaterialTable, ShowsNameRuleAndResult) {
    Scene scene;
    for (const char* text : {"Kd 0.5\nKs 0.25\nNs 30\n", "illum 7\nTf 0.5\n", "Ke 3\nd 0.5\n"}) {
        const Ruled ruled(text);
        scene.materials.push_back(ruled.m);
        scene.material_names.push_back("m" + std::to_string(scene.materials.size()));
        scene.material_rules.push_back(ruled.rule);
    }
    const std::string table = material_table(scene);
    EXPECT_NE(table.find("m1        illum 2: matte Kd, glossy Ks by Ns  matte 0.5 0.5 0.5, glossy 0.25 0.25 "
                         "0.25 alpha 0.25\n"),
              std::string::npos)
        << table;
    EXPECT_NE(table.find("dielectric Ni 1.5 Tf 0.5 0.5 0.5"), std::string::npos) << table;
    EXPECT_NE(table.find("black, emits 3 3 3, coverage 0.5"), std::string::npos) << table;
}
