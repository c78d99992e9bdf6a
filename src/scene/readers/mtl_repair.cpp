// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/mtl_repair.h"

#include "colour.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <utility>

namespace clrt {
namespace {

/// Blender: Ns = range (1 - roughness)^2; its Python exporter had the smaller range.
constexpr double BLENDER_NS = 1000, BLENDER_PYTHON_NS = 900;
/// The specular level and the index of refraction of a Principled BSDF that nobody touched.
constexpr double BLENDER_LEVEL = 0.5, BLENDER_IOR = 1.5;
/// Blender's Pc is this many times the weight of the coat.
constexpr double BLENDER_COAT = 4;

double mean(const glm::dvec3& c) {
    return (c.x + c.y + c.z) / 3;
}

/// Blender writes illum 1, 2, 3, 6 and 9: where another model is given somebody chose it by hand.
bool is_blender(const MtlMaterial& m) {
    const int illum = m.illum.value_or(2);
    return is_blender(m.writer.dialect) && illum != 4 && illum != 5 && illum != 7 && illum != 8;
}

bool has_pr_or_pm(const MtlMaterial& m) {
    return m.pr || m.pm || m.map_pr || m.map_pm;
}

/// Pm takes the place of illum.
bool is_glass_by_illum(const MtlMaterial& m) {
    const int illum = m.pm || m.map_pm ? 1 : m.illum.value_or(1);
    return illum == 4 || illum == 6 || illum == 7 || illum == 9;
}

// Blender. Its materials are principled BSDFs (Burley 2012 and 2015), which its exporter writes into keys
// that were made for other things.

/// Before 2.8, and only then, Ni was always 1; maps were those of hardness and of mirror reflection.
bool has_maps_of_internal(const MtlMaterial& m, const PictureFacts&) {
    return m.writer.dialect == MtlDialect::BLENDER_PYTHON && m.ni == 1.0 && (m.map_ns || m.map_refl);
}

void drop_ns_and_refl_maps(MtlMaterial& m) {
    m.map_ns.reset();
    m.map_refl.reset();
}

/// For a material without a Principled BSDF the exporter writes Ni 1, and no Ps even where it writes Pr.
bool has_lost_nodes(const MtlMaterial& m, const PictureFacts&) {
    return is_blender(m) && m.ni == 1.0 && !(has_pr_or_pm(m) && m.ps);
}

void set_usual_index(MtlMaterial& m) {
    m.ni = BLENDER_IOR;
}

bool is_default_export(const MtlMaterial& m, const PictureFacts&) {
    return is_blender(m) && !has_pr_or_pm(m);
}

/// Roughness from Ns or map_Ns, metal from Ka or map_refl. Ka is 1 without metal too: illum tells them apart.
/// A value beside its map does not count.
void read_default_export(MtlMaterial& m) {
    const double range = m.writer.dialect == MtlDialect::BLENDER ? BLENDER_NS : BLENDER_PYTHON_NS;
    const bool is_metal = m.illum == 3 || m.illum == 6;
    m.pr = m.map_ns || !m.ns ? 1 : 1 - std::sqrt(std::min(*m.ns, range) / range);
    m.pm = m.map_refl ? 1 : is_metal ? mean(m.ka.value_or(glm::dvec3(1))) : 0;
    m.map_pr = std::exchange(m.map_ns, std::nullopt);
    m.map_pm = std::exchange(m.map_refl, std::nullopt);
}

bool is_blender_material(const MtlMaterial& m, const PictureFacts&) {
    return is_blender(m);
}

/// F0 = ((Ni - 1) / (Ni + 1))^2 2 level, level = Ks (Cycles' principled BSDF). The illum says nothing more: 6
/// and 9 mean that d is below 1, 1 that the level is 0.
void read_specular_level(MtlMaterial& m) {
    const double ni = m.ni.value_or(BLENDER_IOR), root = (ni - 1) / (ni + 1);
    const double level = m.ks ? mean(*m.ks) : m.map_ks ? 1 : BLENDER_LEVEL;
    m.dielectric_f0 = std::min(root * root * 2 * level, 1.0);
    m.map_dielectric_f0 = std::exchange(m.map_ks, std::nullopt);
    m.pm = m.pm.value_or(m.map_pm ? 1 : 0);
    m.ks.reset();
    m.illum.reset();
}

bool has_replaced_kd(const MtlMaterial& m, const PictureFacts& maps) {
    return is_blender(m) && m.kd && m.kd != glm::dvec3(1) && m.map_kd &&
           maps.is_readable(*m.map_kd, TextureRole::COLOUR);
}

void set_kd_to_one(MtlMaterial& m) {
    m.kd = glm::dvec3(1);
}

// Any writer.

bool has_hidden_kd_map(const MtlMaterial& m, const PictureFacts& maps) {
    return m.kd == glm::dvec3(0) && m.map_kd && maps.is_readable(*m.map_kd, TextureRole::COLOUR);
}

bool is_opaque_by_tr(const MtlMaterial& m, const PictureFacts&) {
    return !m.d && m.tr == 1.0;
}

void drop_tr(MtlMaterial& m) {
    m.tr.reset();
}

bool has_hidden_coverage_map(const MtlMaterial& m, const PictureFacts&) {
    return m.map_d && m.d == 0.0;
}

void set_d_to_one(MtlMaterial& m) {
    m.d = 1;
}

bool is_invisible_glass(const MtlMaterial& m, const PictureFacts&) {
    return is_glass_by_illum(m) && m.ni == 1.0 && m.d.value_or(1 - m.tr.value_or(0)) == 1 && !has_pr_or_pm(m);
}

void make_opaque(MtlMaterial& m) {
    m.illum = 2;
    m.tf.reset();
}

bool is_black_glass(const MtlMaterial& m, const PictureFacts&) {
    return is_glass_by_illum(m) && m.tf == glm::dvec3(0) && m.ni.value_or(0) > 1;
}

void make_clear(MtlMaterial& m) {
    m.tf = glm::dvec3(1);
}

bool has_scaled_coat(const MtlMaterial& m, const PictureFacts&) {
    return m.pc && (*m.pc > 1 || (is_blender(m) && *m.pc > 0));
}

void scale_coat(MtlMaterial& m) {
    m.pc = std::min(*m.pc / BLENDER_COAT, 1.0);
}

/// Beside Pr and Pm Tf is the weight of transmission, below the metal. Where illum says glass already it is a
/// tint, as ever.
double transmission_share(const MtlMaterial& m) {
    if (!m.tf || !has_pr_or_pm(m) || is_glass_by_illum(m))
        return 0;
    return mean(*m.tf) * (1 - (m.map_pm ? 0 : m.pm.value_or(0)));
}

/// Partly, or of a colour that varies, which the plain dielectric has not.
bool is_partly_glass(const MtlMaterial& m, const PictureFacts&) {
    const double share = transmission_share(m);
    return share > 0 && (share < 1 || m.map_kd || m.map_pm);
}

void make_partly_glass(MtlMaterial& m) {
    m.transmission_weight = mean(*m.tf);
    m.tf.reset();
    m.illum.reset();
    m.pr = m.pr.value_or(m.map_pr ? 1 : 0);
    m.pm = m.pm.value_or(m.map_pm ? 1 : 0);
}

bool is_glass_by_tf(const MtlMaterial& m, const PictureFacts&) {
    return transmission_share(m) == 1;
}

/// Each crossing takes the root of Kd: a body, which is crossed twice, has the colour Kd (Cycles).
void make_glass(MtlMaterial& m) {
    m.illum = 7;
    m.tf = glm::sqrt(m.kd.value_or(glm::dvec3(1)));
    m.pr = m.pr.value_or(m.map_pr ? 1 : 0);
    m.pm.reset();
    m.map_pm.reset();
}

bool has_two_normal_maps(const MtlMaterial& m, const PictureFacts& maps) {
    return m.map_normal && m.map_bump && maps.is_normal_map(*m.map_bump);
}

void drop_bump_map(MtlMaterial& m) {
    m.map_bump.reset();
}

/// Blender writes no other map_Bump, whatever its texels look like.
bool has_normals_as_bumps(const MtlMaterial& m, const PictureFacts& maps) {
    return m.map_bump && (m.writer.dialect == MtlDialect::BLENDER || maps.is_normal_map(*m.map_bump));
}

void move_bump_to_normal(MtlMaterial& m) {
    m.map_normal = std::exchange(m.map_bump, std::nullopt);
}

bool has_boilerplate_ks(const MtlMaterial& m, const PictureFacts&) {
    return !m.illum && !m.ns && !m.map_ns && !has_pr_or_pm(m) &&
           (m.map_ks || (m.ks && largest_component(*m.ks) > 0));
}

void drop_ks(MtlMaterial& m) {
    m.ks.reset();
    m.map_ks.reset();
}

/// One repair: when it applies, what it changes, what is said about it and at which key.
struct Repair {
    const char* name;
    bool (*applies)(const MtlMaterial&, const PictureFacts&);
    void (*apply)(MtlMaterial&);
    const char* key; ///< lower case; "": the material's newmtl
    const char* notice;
};

/// The table, in the order of application: first what Blender means, then what any writer may do.
constexpr Repair REPAIRS[] = {
    {"old Blender maps", has_maps_of_internal, drop_ns_and_refl_maps, "map_ns",
     "map_Ns and refl of Blender before 2.8 are ignored"},
    {"lost nodes", has_lost_nodes, set_usual_index, "ni",
     "Ni 1 from Blender says that this is no Principled BSDF, and its nodes are lost; Ni 1.5 is taken"},
    {"Blender's roughness and metal", is_default_export, read_default_export, "",
     "Blender's export without PBR: roughness from Ns, metal from Ka"},
    {"Blender's level", is_blender_material, read_specular_level, "ks",
     "Blender's Ks is a specular level: F0 from it and Ni; illum 6 and 9 mean d"},
    {"Blender's base colour", has_replaced_kd, set_kd_to_one, "kd", "Blender's map_Kd replaces Kd"},
    {"map over Kd 0", has_hidden_kd_map, set_kd_to_one, "kd", "Kd is 0 beside map_Kd: Kd 1 is taken"},
    {"opaque Tr 1", is_opaque_by_tr, drop_tr, "tr",
     "Tr 1 without d is how many tools write opaque: d 1 is taken"},
    {"map over d 0", has_hidden_coverage_map, set_d_to_one, "d", "d is 0 beside map_d: d 1 is taken"},
    {"opaque Ni 1", is_invisible_glass, make_opaque, "ni",
     "glass with Ni 1 and d 1 would be invisible: illum 2 is taken"},
    {"clear Tf 0", is_black_glass, make_clear, "tf", "Tf is 0 beside an index of refraction: Tf 1 is taken"},
    {"coat weight", has_scaled_coat, scale_coat, "pc",
     "Pc is four times the weight of the coat, as Blender writes it"},
    {"weight by Tf", is_partly_glass, make_partly_glass, "tf",
     "Tf beside Pr or Pm is a weight of transmission: the surface is partly glass with Ni and Pr"},
    {"glass by Tf", is_glass_by_tf, make_glass, "tf",
     "Tf beside Pr or Pm is a weight of transmission: glass with Ni and Pr, tinted by the root of Kd"},
    {"norm over map_Bump", has_two_normal_maps, drop_bump_map, "map_bump",
     "map_Bump is a normal map beside norm and is ignored"},
    {"normal map", has_normals_as_bumps, move_bump_to_normal, "map_bump",
     "map_Bump is a normal map, -bm its strength"},
    {"no gloss", has_boilerplate_ks, drop_ks, "ks", "Ks without illum and Ns is ignored"},
};

} // namespace

MtlMaterial repair_material(const MtlMaterial& mtl, const PictureFacts& maps, NoticeList& notices) {
    MtlMaterial repaired = mtl;
    for (const Repair& repair : REPAIRS) {
        if (!repair.applies(repaired, maps))
            continue;
        repair.apply(repaired);
        repaired.repairs.push_back(repair.name);
        notices.add(repair.notice, mtl.place_of(repair.key));
    }
    return repaired;
}

void note_writers(const std::map<std::string, MtlMaterial>& library, NoticeList& notices) {
    std::map<std::string, std::string> names; // of the writers, by library
    for (const auto& [name, mtl] : library)
        names[mtl.place.file] = mtl.writer.name;
    for (const auto& [file, name] : names)
        if (!name.empty())
            notices.add(fmt::format("written by {}: read as it means its keys (--mtl auto)", name),
                        {file, 0});
}

} // namespace clrt
