// SPDX-License-Identifier: Apache-2.0
#include "scene/material_rules.h"

#include "scene/colour.h"
#include "scene/text_scanner.h"
#include "scene/vectors.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/common.hpp>

namespace clrt {
namespace {

constexpr double DEFAULT_NS = 10, DEFAULT_NI = 1.5;

/// What a model reflects besides its matte part.
enum class Reflection {
    NONE,
    GLOSS,          ///< Ks rough by Ns
    RAY_TRACED,     ///< Ks without Fresnel, rough by Ns below MIRROR_NS, else a mirror
    SCHLICK_MIRROR, ///< a mirror with Schlick's Fresnel from Ks
    DIELECTRIC,     ///< reflection and refraction with exact Fresnel; no matte part
    METALLIC        ///< F0 = mix(0.04, Kd, Pm) with Schlick's Fresnel, rough by Pr
};

struct Rule {
    int illum;
    Reflection reflection;
    const char* text;
};

/// The table. Models 0..9 are those of the MTL specification (Wavefront, 1995); METALLIC_RULE replaces them
/// where Pm or map_Pm is given (Hable and others' PBR extension).
constexpr Rule ILLUM_RULES[] = {
    {0, Reflection::NONE, "matte Kd"},
    {1, Reflection::NONE, "matte Kd"},
    {2, Reflection::GLOSS, "matte Kd, glossy Ks by Ns"},
    {3, Reflection::RAY_TRACED, "matte Kd, reflection Ks by Ns"},
    {4, Reflection::DIELECTRIC, "dielectric Ni, Tf"},
    {5, Reflection::SCHLICK_MIRROR, "matte Kd, mirror Ks with Fresnel"},
    {6, Reflection::DIELECTRIC, "dielectric Ni, Tf"},
    {7, Reflection::DIELECTRIC, "dielectric Ni, Tf"},
    {8, Reflection::RAY_TRACED, "matte Kd, reflection Ks by Ns"},
    {9, Reflection::DIELECTRIC, "dielectric Ni, Tf"},
};
constexpr Rule METALLIC_RULE = {-1, Reflection::METALLIC, "metallic-roughness Kd, Pm, Pr"};

bool is_positive(const std::optional<glm::dvec3>& colour) {
    return colour && largest_component(*colour) > 0;
}

/// Ks without the key is 1 with its map, else 0. Without illum: 2 if Ks > 0, else 1.
const Rule& find_rule(const MtlMaterial& mtl) {
    if (mtl.pm || mtl.map_pm)
        return METALLIC_RULE;
    const bool gloss = is_positive(mtl.ks) || (mtl.map_ks && !mtl.ks);
    return ILLUM_RULES[mtl.illum.value_or(gloss ? 2 : 1)];
}

/// GGX roughness along and across the tangent; `sqrt_x` squared is `x`, so that a map can scale it.
struct Roughness {
    double x = 0, y = 0, sqrt_x = 0, sqrt_y = 0;
    double mean() const { return std::sqrt(x * y); }
};

/// Applies the rules to one material.
class MaterialRule {
public:
    MaterialRule(const MtlMaterial& mtl, const MaterialContext& context, const LoadMap& load_map,
                 NoticeList& notices)
        : mtl_(mtl), context_(context), load_map_(load_map), notices_(notices), rule_(find_rule(mtl)) {}

    RuledMaterial apply() {
        clear();
        set_matte();
        switch (rule_.reflection) {
        case Reflection::NONE:
            note_unused_gloss();
            break;
        case Reflection::DIELECTRIC:
            set_dielectric();
            break;
        case Reflection::METALLIC:
            set_metallic();
            break;
        default:
            set_reflection();
        }
        set_emission();
        set_coverage();
        set_shape_maps();
        note_missing_lobes();
        if (largest_component(to_dvec3(m_.matte)) > 0 && !(m_.lobes & LOBE_DIELECTRIC))
            m_.lobes |= LOBE_MATTE;
        return {m_, rule_text()};
    }

private:
    void clear() {
        m_ = Material{};
        m_.transmission = to_vec4(mtl_.tf.value_or(glm::dvec3(1)), mtl_.ni.value_or(DEFAULT_NI));
        m_.fresnel = FRESNEL_NONE;
        m_.map_matte = m_.map_specular = m_.map_emission = m_.map_coverage = m_.map_roughness = NO_INDEX;
        m_.map_metallic = m_.map_normal = m_.map_bump = NO_INDEX;
    }

    std::string rule_text() const {
        std::string text =
            rule_.illum < 0 ? rule_.text : fmt::format("illum {}: {}", rule_.illum, rule_.text);
        if (!mtl_.repairs.empty())
            text += fmt::format(" (repaired: {})", fmt::join(mtl_.repairs, ", "));
        return text;
    }

    u32 load(const std::optional<MtlTexture>& map, TextureRole role) {
        return map ? load_map_(*map, role) : NO_INDEX;
    }

    /// Kd without the key: 1 with map_Kd, 0 beside Ks, Ke or Tf, else 0.8.
    void set_matte() {
        if (rule_.reflection == Reflection::DIELECTRIC)
            return;
        const bool beside = mtl_.ks || mtl_.ke || mtl_.tf;
        const glm::dvec3 kd = mtl_.kd.value_or(glm::dvec3(mtl_.map_kd ? 1.0 : beside ? 0.0 : DEFAULT_KD));
        note_hidden_map(mtl_.kd, mtl_.map_kd, "Kd");
        if (largest_component(kd) > 0)
            m_.map_matte = load(mtl_.map_kd, TextureRole::COLOUR);
        m_.matte = to_vec4(kd, 1);
    }

    /// A map multiplies its key; writers that put 0 there hide their own map.
    void note_hidden_map(const std::optional<glm::dvec3>& key, const std::optional<MtlTexture>& map,
                         const char* name) {
        if (key && map && largest_component(*key) <= 0)
            notices_.add(fmt::format("{} is 0, so map_{} has no effect", name, name), map->place);
    }

    void note_unused_gloss() {
        if (is_positive(mtl_.ks))
            notices_.add(fmt::format("Ks has no effect with illum {} (2 has gloss)", rule_.illum),
                         mtl_.place);
    }

    /// Pr times its map, else Ns, else the model's default; aniso stretches it (Burley 2012, section 5.4).
    Roughness roughness() {
        if (mtl_.pr.value_or(1) > 0)
            m_.map_roughness = load(mtl_.map_pr, TextureRole::SCALAR);
        const bool by_pr = roughness_by_pr();
        if (!by_pr && is_mirror_by_ns())
            return {};
        const double pr = by_pr ? mtl_.pr.value_or(1) : std::sqrt(alpha_of_ns(mtl_.ns.value_or(DEFAULT_NS)));
        const double root_aspect = std::sqrt(std::sqrt(1 - 0.9 * mtl_.aniso.value_or(0)));
        Roughness r;
        r.sqrt_x = pr / root_aspect;
        r.sqrt_y = pr * root_aspect;
        r.x = r.sqrt_x * r.sqrt_x;
        r.y = r.sqrt_y * r.sqrt_y;
        if (r.mean() >= SMOOTH_ALPHA)
            return r;
        m_.map_roughness = NO_INDEX;
        return {};
    }

    bool roughness_by_pr() const { return mtl_.pr || m_.map_roughness != NO_INDEX; }

    bool is_mirror_by_ns() const {
        switch (rule_.reflection) {
        case Reflection::RAY_TRACED:
            return !mtl_.ns || *mtl_.ns >= MIRROR_NS;
        case Reflection::SCHLICK_MIRROR:
        case Reflection::DIELECTRIC: // in the wild Ns on glass means nothing
            return true;
        default:
            return false;
        }
    }

    void set_roughness(const Roughness& r) {
        m_.alpha_x = float(r.x);
        m_.alpha_y = float(r.y);
        m_.roughness_sqrt_x = float(r.sqrt_x);
        m_.roughness_sqrt_y = float(r.sqrt_y);
    }

    /// Phong's exponent for the local models: Ns itself unless Pr says how rough the lobe is.
    double phong_exponent(const Roughness& r) const {
        if (r.x <= 0)
            return 0;
        const double ns = roughness_by_pr() ? ns_of_alpha(r.mean()) : mtl_.ns.value_or(DEFAULT_NS);
        return std::max(ns, SMALLEST_PHONG_EXPONENT);
    }

    /// The reflection lobe of every model but dielectrics.
    void set_lobe(const glm::dvec3& specular) {
        const Roughness r = roughness();
        set_roughness(r);
        m_.specular = to_vec4(specular, phong_exponent(r));
        m_.lobes |= r.x > 0 ? LOBE_GLOSSY : LOBE_MIRROR;
        if (r.x <= 0) // a delta lobe has no highlight: it is followed whatever the model
            m_.flags |= MATERIAL_WHITTED_MIRROR;
    }

    /// illum 2, 3, 5, 8.
    void set_reflection() {
        const bool ks_by_map = !mtl_.ks && mtl_.map_ks;
        note_hidden_map(mtl_.ks, mtl_.map_ks, "Ks");
        if (!is_positive(mtl_.ks) && !ks_by_map) {
            if (rule_.reflection != Reflection::GLOSS)
                notices_.add(fmt::format("illum {} without Ks reflects nothing", rule_.illum), mtl_.place);
            return;
        }
        m_.map_specular = load(mtl_.map_ks, TextureRole::COLOUR);
        if (ks_by_map && m_.map_specular == NO_INDEX)
            return; // an unreadable map alone says nothing about the gloss

        // Keep matte and reflection together from giving back more than they get; maps count as 1. Below
        // Fresnel's reflection the kernels see to it (scattering/bsdf_energy.h).
        glm::dvec3 kd = to_dvec3(m_.matte), ks = mtl_.ks.value_or(glm::dvec3(1));
        const bool is_coupled = rule_.reflection == Reflection::SCHLICK_MIRROR;
        const double sum = is_coupled ? 1.0 : std::max(1.0, largest_component(kd + ks));
        m_.matte = to_vec4(kd / sum, 1);
        set_lobe(ks / sum);
        if (rule_.reflection != Reflection::GLOSS)
            m_.flags |= MATERIAL_WHITTED_MIRROR;
        if (rule_.reflection == Reflection::SCHLICK_MIRROR)
            m_.fresnel = FRESNEL_SCHLICK;
    }

    /// illum 4, 6, 7, 9. Ks, Kd and Ns are ignored; Pr makes the surface rough, unless the indices are equal
    /// and nothing is bent at all.
    void set_dielectric() {
        m_.specular = to_vec4(glm::dvec3(1), 0);
        m_.lobes = LOBE_DIELECTRIC;
        if (m_.transmission.w != 1.0f)
            set_roughness(roughness());
    }

    /// Pm: F0 = mix(F, Kd, Pm), where F is the part's that is no metal; matte Kd (1 - Pm) of what the
    /// reflection leaves to it (scattering/bsdf_energy.h).
    void set_metallic() {
        if (is_positive(mtl_.ks) || mtl_.illum.value_or(2) > 2)
            notices_.add("Pm is given: metallic-roughness instead of illum and Ks", mtl_.place);
        const double pm = mtl_.pm.value_or(1);
        m_.emission.w = float(pm);
        m_.map_metallic = pm > 0 ? load(mtl_.map_pm, TextureRole::SCALAR) : NO_INDEX;
        const bool by_map = m_.map_metallic != NO_INDEX;
        const double dielectric = mtl_.dielectric_f0.value_or(DIELECTRIC_F0);
        if (dielectric > 0 && (by_map || pm < 1))
            m_.map_specular = load(mtl_.map_dielectric_f0, TextureRole::LEVEL);
        const glm::dvec3 kd = to_dvec3(m_.matte);
        glm::dvec3 f0(dielectric);

        // Where maps make the mix vary the kernels do it; a pure metal's map is the colour of its reflection.
        m_.fresnel = FRESNEL_SCHLICK;
        const bool has_colour_map = m_.map_matte != NO_INDEX || m_.map_specular != NO_INDEX;
        if (by_map || (has_colour_map && pm > 0 && pm < 1)) {
            m_.flags |= MATERIAL_METALLIC_ROUGHNESS;
        } else {
            f0 = glm::mix(f0, kd, pm);
            m_.matte = to_vec4(kd * (1 - pm), 1);
            if (pm == 1)
                std::swap(m_.map_specular, m_.map_matte);
        }
        if (m_.flags & MATERIAL_METALLIC_ROUGHNESS || largest_component(f0) > 0)
            set_lobe(f0);
        if (mtl_.pr && *mtl_.pr <= WHITTED_MIRROR_PR)
            m_.flags |= MATERIAL_WHITTED_MIRROR;
    }

    /// Ke without the key is 1 where map_Ke could be read.
    void set_emission() {
        note_hidden_map(mtl_.ke, mtl_.map_ke, "Ke");
        glm::dvec3 ke = mtl_.ke.value_or(glm::dvec3(0));
        if (mtl_.map_ke && (!mtl_.ke || largest_component(ke) > 0))
            m_.map_emission = load(mtl_.map_ke, TextureRole::COLOUR);
        if (!mtl_.ke && m_.map_emission != NO_INDEX)
            ke = glm::dvec3(1);
        m_.emission = to_vec4(ke, double(m_.emission.w));
        if (context_.two_sided && largest_component(ke) > 0)
            m_.flags |= MATERIAL_EMITS_BOTH_SIDES;
    }

    /// d wins over Tr; both multiply map_d.
    void set_coverage() {
        const double d = mtl_.d ? *mtl_.d : 1 - mtl_.tr.value_or(0);
        if (mtl_.d && mtl_.tr && std::fabs(*mtl_.d + *mtl_.tr - 1) > 1e-6)
            notices_.add("d and Tr disagree, d is taken", mtl_.place);
        if (d <= 0)
            notices_.add("d is 0: the material is invisible", mtl_.place);
        m_.matte.w = float(d);
        m_.map_coverage = d > 0 ? load(mtl_.map_d, TextureRole::COVERAGE) : NO_INDEX;
        if (m_.matte.w < 1 || m_.map_coverage != NO_INDEX)
            m_.flags |= MATERIAL_CUT_OUT;
    }

    /// Bump heights are in scene units: -bm is the height of a full-range map. Of a normal map -bm is the
    /// strength; beside a bump map it is 1.
    void set_shape_maps() {
        const auto has_effect = [](const std::optional<MtlTexture>& map) {
            return map && map->bump_multiplier != 0;
        };
        if (has_effect(mtl_.map_normal)) {
            m_.map_normal = load(mtl_.map_normal, TextureRole::NORMAL);
            m_.bump_scale = float(mtl_.map_normal->bump_multiplier);
        }
        if (has_effect(mtl_.map_bump)) {
            m_.map_bump = load(mtl_.map_bump, TextureRole::SCALAR);
            if (m_.map_bump != NO_INDEX)
                m_.bump_scale = float(mtl_.map_bump->bump_multiplier * context_.unit);
        }
    }

    /// What the keys ask for and no lobe does.
    void note_missing_lobes() {
        const auto note = [&](const char* name, const char* key, bool is_given) {
            if (is_given)
                notices_.add(fmt::format("{} has no effect here and is ignored", name), mtl_.place_of(key));
        };
        note("Pc (coat)", "pc", mtl_.pc.value_or(0) > 0);
        note("Ps (sheen)", "ps", mtl_.ps.value_or(0) > 0);
        note("map_Ps (sheen)", "map_ps", mtl_.map_ps.has_value());
        note("anisor (turn of the highlight)", "anisor",
             mtl_.aniso.value_or(0) > 0 && mtl_.anisor.value_or(0) > 0);
        note("map_Ns", "map_ns", mtl_.map_ns.has_value());
        note("map_refl", "map_refl", mtl_.map_refl.has_value());
    }

    const MtlMaterial& mtl_;
    const MaterialContext& context_;
    const LoadMap& load_map_;
    NoticeList& notices_;
    const Rule& rule_;
    Material m_{};
};

} // namespace

double alpha_of_ns(double ns) {
    return std::sqrt(2 / (ns + 2));
}

double ns_of_alpha(double alpha) {
    return std::max(2 / (alpha * alpha) - 2, 0.0);
}

std::vector<MaterialRow> material_rows() {
    std::vector<MaterialRow> rows = {{"Pm 0", METALLIC_RULE.text}};
    for (const Rule& rule : ILLUM_RULES)
        rows.push_back({fmt::format("illum {}", rule.illum), rule.text});
    return rows;
}

RuledMaterial rule_material(const MtlMaterial& mtl, const MaterialContext& context, const LoadMap& load_map,
                            NoticeList& notices) {
    return MaterialRule(mtl, context, load_map, notices).apply();
}

bool is_dielectric(const MtlMaterial& mtl) {
    return find_rule(mtl).reflection == Reflection::DIELECTRIC;
}

RuledMaterial default_material() {
    NoticeList none;
    RuledMaterial ruled = rule_material(
        {}, {}, [](const MtlTexture&, TextureRole) { return NO_INDEX; }, none);
    ruled.rule = "no material: matte Kd 0.8";
    return ruled;
}

} // namespace clrt
