// SPDX-License-Identifier: Apache-2.0
// Every repair of the table: what writers mean, before and after.
#include "scene/readers/mtl_repair.h"

#include "scene_support.h"
#include "support/blender_mtl.h"
#include "support/mtl_material.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace clrt;

namespace {

/// Files named missing* cannot be read, files named normal* are normal maps.
const PictureFacts FACTS{
    [](const TextureUse& use, TextureRole) { return use.file.rfind("missing", 0) != 0; },
    [](const TextureUse& use) { return use.file.rfind("normal", 0) == 0; },
};

struct Repaired {
    MtlMaterial m;
    std::vector<std::string> notices;

    /// The material of a name, or the first.
    explicit Repaired(const std::string& library, const std::string& name = "") {
        NoticeList list;
        for (const MtlMaterial& mtl : parse_mtl(library, "a.mtl", list))
            if (name.empty() || mtl.name == name) {
                m = repair_material(mtl, FACTS, list);
                break;
            }
        notices = list.lines();
    }
};

/// A library without a header, of one material whose newmtl is line 1.
Repaired plain(const std::string& keys) {
    return Repaired("newmtl m\n" + keys);
}

/// What the rules make of a repaired material; every map can be read.
Material ruled(const MtlMaterial& m) {
    NoticeList notices;
    u32 maps = 0;
    return rule_material(
               m, {}, [&](const TextureUse&, TextureRole) { return maps++; }, notices)
        .material;
}

void expect_colour(const vec4& v, double r, double g, double b) {
    EXPECT_FLOAT_EQ(v.x, float(r));
    EXPECT_FLOAT_EQ(v.y, float(g));
    EXPECT_FLOAT_EQ(v.z, float(b));
}

} // namespace

TEST(MtlRepair, LeavesAloneWhatMeansWhatItSays) {
    for (const char* keys :
         {"", "Kd 0.5 0.5 0.5\n", "Kd 0.2\nKs 0.5\nNs 30\nillum 2\n", "illum 7\nNi 1.5\nTf 0.9 0.8 0.7\n",
          "illum 7\nNi 1.5\nPr 0.3\nTf 1 1 1\nKd 0 0 0\n", "Kd 0.5\nPm 1\nPr 0.2\n", "d 0.5\nKe 1 1 1\n",
          "map_Kd a.png\nmap_d b.png\nbump b.png\nnorm n.png\n", "illum 2\nKs 0.5\n", "Ks 0.5\nNs 3\n",
          "illum 5\nTr 0\nKs 1\n", "illum 7\n", "Pc 0.5\nPr 0.5\n"}) {
        const Repaired r = plain(keys);
        EXPECT_TRUE(r.m.repairs.empty()) << keys << r.m.repairs[0];
        EXPECT_TRUE(r.notices.empty()) << keys;
    }
}

TEST(MtlRepair, BlendersDefaultExportIsMetallicRoughness) {
    const Repaired plastic(BLENDER_DEFAULT_MTL, "plastic");
    EXPECT_EQ(plastic.m.pm, 0);
    EXPECT_NEAR(*plastic.m.pr, 0.5, 1e-12);
    EXPECT_NEAR(*plastic.m.dielectric_f0, 0.04, 1e-12);
    EXPECT_FALSE(plastic.m.illum || plastic.m.ks);
    EXPECT_EQ(count_notices(plastic.notices, "a.mtl:4: Blender's export without PBR"), 1);
    EXPECT_EQ(count_notices(plastic.notices, "a.mtl:8: Blender's Ks is a specular level"), 1);

    const Material m = ruled(plastic.m);
    EXPECT_EQ(m.lobes, LOBE_MATTE | LOBE_GLOSSY);
    EXPECT_EQ(m.fresnel, FRESNEL_SCHLICK);
    EXPECT_FLOAT_EQ(m.alpha_x, 0.25f) << "roughness 0.5, squared";
    expect_colour(m.specular, 0.04, 0.04, 0.04);
    expect_colour(m.matte, 0.1, 0.2, 0.8);
}

TEST(MtlRepair, BlendersMetalIsInIllumAndKa) {
    const Repaired gold(BLENDER_DEFAULT_MTL, "gold");
    EXPECT_EQ(gold.m.pm, 1);
    EXPECT_NEAR(*gold.m.pr, 0.2, 1e-12);
    EXPECT_EQ(ruled(gold.m).lobes, LOBE_GLOSSY);
    expect_colour(ruled(gold.m).specular, 0.9, 0.6, 0.2);
    EXPECT_EQ(Repaired(BLENDER_DEFAULT_MTL, "half_metal").m.pm, 0.5);
}

TEST(MtlRepair, BlendersIllumSixAndNineAreCoverage) {
    const Material veil = ruled(Repaired(BLENDER_DEFAULT_MTL, "veil").m);
    EXPECT_EQ(veil.lobes, LOBE_MATTE | LOBE_GLOSSY);
    EXPECT_EQ(veil.matte.w, 0.5f);
    for (const std::string& library : {BLENDER_DEFAULT_MTL, BLENDER_PBR_MTL}) {
        const Material metal = ruled(Repaired(library, "metal_veil").m);
        EXPECT_EQ(metal.lobes, LOBE_GLOSSY);
        EXPECT_EQ(metal.matte.w, 0.5f);
        expect_colour(metal.specular, 0.8, 0.8, 0.8);
    }
}

TEST(MtlRepair, BlendersLevelAndIndexGiveTheReflectance) {
    EXPECT_EQ(Repaired(BLENDER_DEFAULT_MTL, "dull").m.dielectric_f0, 0);
    EXPECT_EQ(ruled(Repaired(BLENDER_DEFAULT_MTL, "dull").m).lobes, LOBE_MATTE);
    const Repaired gem(BLENDER_DEFAULT_MTL, "gem"); // Ni 2, level 1, roughness 0
    EXPECT_NEAR(*gem.m.dielectric_f0, 2.0 / 9, 1e-12);
    EXPECT_EQ(ruled(gem.m).lobes, LOBE_MATTE | LOBE_MIRROR);
    expect_colour(ruled(gem.m).specular, 2 / 9., 2 / 9., 2 / 9.);
    EXPECT_FLOAT_EQ(ruled(gem.m).matte.x, 0.8f);
    EXPECT_EQ(Repaired(BLENDER_HEADER + "newmtl a\nKs 1 1 1\nNi 1e30\nNs 5\n").m.dielectric_f0, 1);
    // Other writers' metallic-roughness has the usual reflectance.
    EXPECT_FALSE(plain("Kd 0.5\nKs 1 1 1\nNi 2\nPm 0\nPr 0.5\n").m.dielectric_f0);
}

TEST(MtlRepair, MaterialsThatBlenderCannotExportAreSaid) {
    for (const std::string& library : {BLENDER_DEFAULT_MTL, BLENDER_PBR_MTL}) {
        const Repaired r(library, "glass_node");
        EXPECT_EQ(r.m.ni, 1.5);
        EXPECT_NEAR(*r.m.dielectric_f0, 0.04, 1e-12);
        EXPECT_NEAR(*r.m.pr, 0.4, 1e-12);
        EXPECT_EQ(count_notices(r.notices, "no Principled BSDF"), 1);
    }
    const Repaired index_one(BLENDER_HEADER + "newmtl a\nKs 0.5\nNi 1\nPr 0.5\nPm 0\nPs 0\n");
    EXPECT_EQ(index_one.m.dielectric_f0, 0) << "a Principled BSDF may have this index";
}

TEST(MtlRepair, ModelsThatBlenderNeverWritesWereChosenByHand) {
    for (const char* illum : {"4", "5", "7", "8"}) {
        const Repaired r(BLENDER_HEADER + "newmtl a\nNs 250\nKs 0.5 0.5 0.5\nNi 1.5\nd 1\nillum " + illum +
                         "\n");
        EXPECT_TRUE(r.m.repairs.empty()) << illum;
        EXPECT_EQ(r.m.illum, illum[0] - '0');
    }
}

TEST(MtlRepair, BlendersMapsOfNsAndReflAreRoughnessAndMetal) {
    const Repaired r(BLENDER_DEFAULT_MTL, "mapped");
    EXPECT_EQ(r.m.map_pr->file, "roughness.png");
    EXPECT_EQ(r.m.map_pm->file, "metal.png");
    EXPECT_EQ(r.m.map_dielectric_f0->file, "level.png");
    EXPECT_FALSE(r.m.map_ns || r.m.map_refl || r.m.map_ks);
    EXPECT_EQ(r.m.pr, 1);
    EXPECT_EQ(r.m.pm, 1);
    EXPECT_NEAR(*r.m.dielectric_f0, 0.08, 1e-12) << "at level 1";
    const Repaired pbr(BLENDER_PBR_MTL, "mapped");
    EXPECT_EQ(pbr.m.map_pr->file, "roughness.png");
    EXPECT_EQ(pbr.m.map_pm->file, "metal.png");
    EXPECT_EQ(pbr.m.pm, 1);
    // A value beside its map does not count.
    const Repaired both(BLENDER_HEADER + "newmtl a\nNs 250\nKd 0.8 0.8 0.8\nmap_Ns r.png\nmap_Kd c.png\n");
    EXPECT_EQ(both.m.pr, 1);
    EXPECT_EQ(both.m.kd, glm::dvec3(1));
    EXPECT_EQ(count_notices(both.notices, "a.mtl:6: Blender's map_Kd replaces Kd"), 1);
    const Repaired missing(BLENDER_HEADER + "newmtl a\nNs 250\nKd 0.8 0.8 0.8\nmap_Kd missing.png\n");
    EXPECT_EQ(missing.m.kd, glm::dvec3(0.8));
}

TEST(MtlRepair, BlendersMapBumpIsANormalMapWhateverItsTexels) {
    const Repaired r(BLENDER_DEFAULT_MTL, "mapped");
    EXPECT_EQ(r.m.map_normal->file, "relief.png");
    EXPECT_EQ(r.m.map_normal->bump_multiplier, 0.7);
    EXPECT_FALSE(r.m.map_bump);
    EXPECT_EQ(ruled(r.m).bump_scale, 0.7f);
}

TEST(MtlRepair, BlendersPythonExporterHadAnotherRange) {
    const std::string header = "# Blender MTL File: 'a.blend'\n# Material Count: 1\nnewmtl a\n";
    const Repaired smooth(header + "Ns 900\nKa 1 1 1\nKs 0.5 0.5 0.5\nNi 1.45\nillum 2\nrefl m.png\n");
    EXPECT_EQ(smooth.m.pr, 0);
    EXPECT_EQ(smooth.m.map_pm->file, "m.png");
    EXPECT_NEAR(*smooth.m.dielectric_f0, std::pow(0.45 / 2.45, 2), 1e-12);
    EXPECT_NEAR(*Repaired(header + "Ns 323.999994\nNi 1.45\n").m.pr, 0.4, 1e-8);
    // Before 2.8 there was no roughness to map.
    const Repaired old(header + "Ns 96.078431\nKs 0.5 0.5 0.5\nNi 1.0\nillum 2\nmap_Ns h.png\n"
                                "map_Bump height.png\n");
    EXPECT_FALSE(old.m.map_pr || old.m.map_ns);
    EXPECT_EQ(old.m.map_bump->file, "height.png");
    EXPECT_EQ(count_notices(old.notices, "a.mtl:8: map_Ns and refl of Blender before 2.8 are ignored"), 1);
}

TEST(MtlRepair, TransmissionOfWeightOneIsGlass) {
    const Repaired glass(BLENDER_PBR_MTL, "glass");
    const Material m = ruled(glass.m);
    EXPECT_EQ(m.lobes, LOBE_DIELECTRIC);
    EXPECT_EQ(m.alpha_x, 0);
    expect_colour(m.specular, 1, 1, 1);
    expect_colour(m.transmission, 0.8, 0.9, 1); // the roots of Kd
    EXPECT_FLOAT_EQ(m.transmission.w, 1.45f);
    EXPECT_EQ(count_notices(glass.notices, "glass with Ni and Pr"), 1);
    const Material frosted = ruled(Repaired(BLENDER_PBR_MTL, "frosted").m);
    EXPECT_EQ(frosted.lobes, LOBE_DIELECTRIC) << "illum 1 and level 0 do not matter";
    EXPECT_FLOAT_EQ(frosted.alpha_x, 0.09f);

    EXPECT_EQ(plain("Kd 1 1 1\nPr 0\nPm 0\nTf 1 1 1\n").m.illum, 7) << "of any writer";
    EXPECT_EQ(plain("Kd 1 1 1\nPm 0\nTf 1 1 1\nNi 1.5\n").m.pr, 0);
    EXPECT_FALSE(plain("Kd 1 1 1\nPm 1\nPr 0\nTf 1 1 1\n").m.illum) << "metal lies over glass";
    EXPECT_FALSE(plain("Kd 1 1 1\nTf 1 1 1\n").m.illum) << "3ds Max and Maya write it for opaque";
    const Repaired black = plain("Kd 0 0 0\nPr 0\nPm 0\nTf 1 1 1\nNi 1.5\n");
    EXPECT_EQ(black.m.tf, glm::dvec3(0)) << "black glass";
    EXPECT_EQ(plain("Kd 0.2 0.3 0.4\nPr 0\nTf 1 1 1\nthin_walled 1\n").m.tf, glm::dvec3(0.2, 0.3, 0.4))
        << "crossed once";
}

TEST(MtlRepair, PartialTransmissionIsAWeight) {
    const Repaired quarter(BLENDER_PBR_MTL, "quarter_glass");
    EXPECT_EQ(ruled(quarter.m).lobes, LOBE_MATTE | LOBE_GLOSSY | LOBE_DIELECTRIC);
    EXPECT_EQ(ruled(quarter.m).flags, u32(MATERIAL_METALLIC_ROUGHNESS | MATERIAL_PART_GLASS));
    EXPECT_EQ(count_notices(quarter.notices, "the surface is partly glass"), 1);
    const Repaired most = plain("Kd 1 1 1\nPm 0.25\nPr 0.1\nTf 0.8 0.8 0.8\n");
    EXPECT_DOUBLE_EQ(*most.m.transmission_weight, 0.8) << "of what is no metal";
    EXPECT_FALSE(most.m.illum || most.m.tf);
    EXPECT_EQ(count_notices(most.notices, "a.mtl:5: Tf beside Pr or Pm"), 1);
    EXPECT_DOUBLE_EQ(*plain("map_Kd a.png\nPr 0\nTf 1 1 1\n").m.transmission_weight, 1) << "its tint varies";
    EXPECT_FALSE(plain("Kd 1 1 1\nPm 1\nPr 0.1\nTf 0.8 0.8 0.8\n").m.transmission_weight) << "all is metal";
}

TEST(MtlRepair, CoatsAreScaledAndSaid) {
    const Repaired coated(BLENDER_PBR_MTL, "coated");
    EXPECT_EQ(coated.m.pc, 1);
    EXPECT_EQ(count_notices(coated.notices, "Pc is four times"), 1);
    EXPECT_EQ(count_notices(Repaired(BLENDER_PBR_MTL, "plastic").notices, "Pc"), 0) << "Pc 0 is no coat";
    EXPECT_EQ(plain("Pr 0.5\nPc 2\n").m.pc, 0.5) << "above 1 it is Blender's";
    EXPECT_EQ(plain("Pr 0.5\nPc 0.5\n").m.pc, 0.5);
    EXPECT_EQ(Repaired(BLENDER_HEADER + "newmtl a\nPr 0\nPc 1\n").m.pc, 0.25);
    EXPECT_EQ(Repaired(BLENDER_HEADER + "newmtl a\nPr 0\nPc 9\n").m.pc, 1);
    EXPECT_TRUE(ruled(coated.m).lobes & LOBE_COAT);
}

TEST(MtlRepair, NormalMapsInMapBumpAreFound) {
    const Repaired r = plain("map_Bump -bm 2 normal.png\n");
    EXPECT_EQ(r.m.map_normal->file, "normal.png");
    EXPECT_FALSE(r.m.map_bump);
    EXPECT_EQ(count_notices(r.notices, "a.mtl:2: map_Bump is a normal map"), 1);
    EXPECT_TRUE(plain("bump height.png\n").m.map_bump);
    const Repaired two = plain("norm n.png\nbump normal.png\n");
    EXPECT_EQ(two.m.map_normal->file, "n.png");
    EXPECT_FALSE(two.m.map_bump);
    EXPECT_EQ(count_notices(two.notices, "a.mtl:3: map_Bump is a normal map beside norm"), 1);
}

TEST(MtlRepair, OpaqueScansAreVisible) {
    const Repaired r = plain("Ka 1 1 1\nKd 1 1 1\nKs 0 0 0\nTr 1.000000\nillum 1\nNs 0\nmap_Kd scan.jpg\n");
    EXPECT_EQ(ruled(r.m).matte.w, 1);
    EXPECT_EQ(count_notices(r.notices, "a.mtl:5: Tr 1 without d"), 1);
    EXPECT_EQ(plain("Tr 1\nd 0.5\n").m.tr, 1) << "d is there";
    EXPECT_EQ(plain("Tr 0.9\n").m.tr, 0.9);
    EXPECT_EQ(plain("d 0\nmap_d leaf.png\n").m.d, 1);
    EXPECT_EQ(plain("d 0\n").m.d, 0);
}

TEST(MtlRepair, OpaqueMaterialsOfMayaAreVisible) {
    const Repaired r = plain("illum 4\nKd 0.5 0.4 0.3\nKa 0 0 0\nTf 1.00 1.00 1.00\nNi 1.00\n");
    EXPECT_EQ(ruled(r.m).lobes, LOBE_MATTE);
    expect_colour(ruled(r.m).matte, 0.5, 0.4, 0.3);
    EXPECT_EQ(count_notices(r.notices, "a.mtl:6: glass with Ni 1 and d 1"), 1);
    const Repaired gloss = plain("illum 4\nKd 0.5 0.5 0.5\nTf 1 1 1\nNi 1\nKs 0.4 0.4 0.4\nNs 18\n");
    EXPECT_EQ(ruled(gloss.m).lobes, LOBE_MATTE | LOBE_GLOSSY);
    const Repaired textured = plain("illum 4\nKd 0 0 0\nTf 1 1 1\nmap_Kd wood.png\nNi 1\n");
    expect_colour(ruled(textured.m).matte, 1, 1, 1);
    EXPECT_EQ(count_notices(textured.notices, "a.mtl:3: Kd is 0 beside map_Kd"), 1);
    for (const char* glass :
         {"illum 4\nNi 1.5\n", "illum 7\nNi 1\nd 0.5\n", "illum 7\nNi 1\nPr 0.2\n", "illum 7\n"})
        EXPECT_NE(plain(glass).m.illum, 2) << glass;
}

TEST(MtlRepair, TransparentMaterialsOfMayaAreClear) {
    const Repaired r = plain("illum 4\nKd 0 0 0\nTf 0.00 0.00 0.00\nNi 1.80\n");
    expect_colour(ruled(r.m).transmission, 1, 1, 1);
    EXPECT_EQ(count_notices(r.notices, "a.mtl:4: Tf is 0"), 1);
    EXPECT_EQ(plain("illum 4\nTf 0 0 0\n").m.tf, glm::dvec3(0)) << "no index is given";
    EXPECT_EQ(plain("illum 2\nTf 0 0 0\nNi 1.5\n").m.tf, glm::dvec3(0));
}

TEST(MtlRepair, KdZeroDoesNotHideAMapThatCanBeRead) {
    EXPECT_EQ(plain("Kd 0 0 0\nmap_Kd a.png\n").m.kd, glm::dvec3(1));
    EXPECT_EQ(plain("Kd 0 0 0\nmap_Kd missing.png\n").m.kd, glm::dvec3(0));
    EXPECT_EQ(plain("Kd 0 0 0.1\nmap_Kd a.png\n").m.kd, glm::dvec3(0, 0, 0.1));
}

TEST(MtlRepair, KsWithoutAModelIsBoilerplate) {
    const Repaired r = plain("Ka 0 0 0\nKd 0.8 0.6 0.4\nKs 0.33 0.33 0.33\n");
    EXPECT_EQ(ruled(r.m).lobes, LOBE_MATTE);
    EXPECT_EQ(count_notices(r.notices, "a.mtl:4: Ks without illum and Ns is ignored"), 1);
    EXPECT_FALSE(plain("Kd 0.5\nmap_Ks s.png\n").m.map_ks);
    for (const char* model : {"illum 2\n", "Ns 10\n", "Pr 0.5\n", "Pm 0.5\n"})
        EXPECT_TRUE(plain(std::string("Ks 0.33 0.33 0.33\n") + model).m.ks) << model;
}

TEST(MtlRepair, RulesNameTheRepairsThatChangedAMaterial) {
    NoticeList notices;
    const Repaired r = plain("illum 4\nKd 0.5 0.4 0.3\nTf 1 1 1\nNi 1\nTr 1\n");
    const RuledMaterial ruled = rule_material(
        r.m, {}, [](const TextureUse&, TextureRole) { return NO_INDEX; }, notices);
    EXPECT_EQ(ruled.rule, "illum 2: matte Kd, glossy Ks by Ns (repaired: opaque Tr 1, opaque Ni 1)");
}

TEST(MtlRepair, LibrariesNameTheirWritersOnce) {
    NoticeList parsed, notices;
    std::map<std::string, MtlMaterial> library;
    for (const char* name : {"a", "b"})
        library[name] = parse_mtl(BLENDER_HEADER + "newmtl x\n", "b.mtl", parsed).at(0);
    library["c"] = parse_mtl("newmtl x\n", "plain.mtl", parsed).at(0);
    note_writers(library, notices);
    EXPECT_EQ(
        notices.lines(),
        std::vector<std::string>{"b.mtl: written by Blender 5.0.1: read as it means its keys (--mtl auto)"});
}
