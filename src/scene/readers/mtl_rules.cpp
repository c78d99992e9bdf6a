// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/mtl_rules.h"

#include "colour.h"
#include "scene/build_material.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clrt {
namespace {

constexpr double DEFAULT_NS = 10;
/// Blender's roughness of a coat and of a sheen that nobody touched.
constexpr double DEFAULT_PCR = 0.03, SHEEN_ROUGHNESS = 0.5;

/// What a model reflects besides its matte part.
enum class Model {
    MATTE,
    GLOSS,          ///< Ks rough by Ns
    RAY_TRACED,     ///< Ks without Fresnel, rough by Ns below MIRROR_NS, else a mirror
    SCHLICK_MIRROR, ///< a mirror with Schlick's Fresnel from Ks
    DIELECTRIC,     ///< reflection and refraction with exact Fresnel; no matte part
    CONDUCTOR,      ///< exact Fresnel by eta and k, rough by Pr
    METALLIC,       ///< F0 = mix(0.04, Kd, Pm) with Schlick's Fresnel, rough by Pr
    MEASURED        ///< a measured BRDF, whatever the other keys say
};

struct Rule {
    int illum;
    Model model;
    const char* text;
};

/// The table. Models 0..9 are those of the MTL specification (Wavefront, 1995); METALLIC_RULE replaces them
/// where Pm or map_Pm is given, CONDUCTOR_RULE where eta is (Hable and others' PBR extension), MEASURED_RULE
/// where merl is.
constexpr Rule ILLUM_RULES[] = {
    {0, Model::MATTE, "matte Kd"},
    {1, Model::MATTE, "matte Kd"},
    {2, Model::GLOSS, "matte Kd, glossy Ks by Ns"},
    {3, Model::RAY_TRACED, "matte Kd, reflection Ks by Ns"},
    {4, Model::DIELECTRIC, "dielectric Ni, Tf"},
    {5, Model::SCHLICK_MIRROR, "matte Kd, mirror Ks with Fresnel"},
    {6, Model::DIELECTRIC, "dielectric Ni, Tf"},
    {7, Model::DIELECTRIC, "dielectric Ni, Tf"},
    {8, Model::RAY_TRACED, "matte Kd, reflection Ks by Ns"},
    {9, Model::DIELECTRIC, "dielectric Ni, Tf"},
};
constexpr Rule CONDUCTOR_RULE = {-1, Model::CONDUCTOR, "conductor eta, k, Pr"};
constexpr Rule METALLIC_RULE = {-1, Model::METALLIC, "metallic-roughness Kd, Pm, Pr"};
constexpr Rule MEASURED_RULE = {-1, Model::MEASURED, "measured BRDF merl"};

bool is_positive(const std::optional<glm::dvec3>& colour) {
    return colour && largest_component(*colour) > 0;
}

/// Ks without the key is 1 with its map, else 0. Without illum: 2 if Ks > 0, else 1.
const Rule& find_rule(const MtlMaterial& mtl) {
    if (mtl.merl)
        return MEASURED_RULE;
    if (mtl.eta)
        return CONDUCTOR_RULE;
    if (mtl.pm || mtl.map_pm)
        return METALLIC_RULE;
    const bool gloss = is_positive(mtl.ks) || (mtl.map_ks && !mtl.ks);
    return ILLUM_RULES[mtl.illum.value_or(gloss ? 2 : 1)];
}

/// A colour or number by its key: as given, else 1 where there is a map, which multiplies it, else `absent`.
template <typename T>
Mapped<T> mapped(const std::optional<T>& key, const std::optional<MtlTexture>& map, const T& absent) {
    Mapped<T> quantity{key.value_or(map ? T(1) : absent)};
    if (map)
        quantity.map = *map;
    return quantity;
}

/// Applies the rules to one material.
class MtlRule {
public:
    MtlRule(const MtlMaterial& mtl, NoticeList& notices)
        : mtl_(mtl), notices_(notices), rule_(find_rule(mtl)) {}

    MaterialDescription apply() {
        to_.name = mtl_.name;
        to_.place = mtl_.place;
        to_.rule = rule_text();
        to_.transmission = mtl_.tf.value_or(glm::dvec3(1));
        to_.ior = mtl_.ni.value_or(DEFAULT_IOR);
        set_base();
        set_reflection();
        if (mtl_.k && !mtl_.eta)
            remark("k without eta has no effect", mtl_.place_of("k"));
        set_emission();
        set_coverage();
        set_shape_maps();
        set_interior();
        set_covers();
        remark_missing_keys();
        return to_;
    }

private:
    std::string rule_text() const {
        std::string text =
            rule_.illum < 0 ? rule_.text : fmt::format("illum {}: {}", rule_.illum, rule_.text);
        if (!mtl_.repairs.empty())
            text += fmt::format(" (repaired: {})", fmt::join(mtl_.repairs, ", "));
        return text;
    }

    void remark(const std::string& text, const SourcePlace& place) {
        to_.surface_remarks.push_back({text, place});
    }

    /// A map multiplies its key; writers that put 0 there hide their own map.
    static bool is_hidden(const std::optional<glm::dvec3>& key, const std::optional<MtlTexture>& map) {
        return key && map && !is_positive(key);
    }

    static std::string hidden_text(const char* name) {
        return fmt::format("{} is 0, so map_{} has no effect", name, name);
    }

    /// Kd without the key: 1 with map_Kd, 0 beside Ks, Ke or Tf, else 0.8. Glass, metals by their index and
    /// what is measured have no matte part.
    void set_base() {
        if (rule_.model == Model::DIELECTRIC || rule_.model == Model::CONDUCTOR ||
            rule_.model == Model::MEASURED)
            return;
        const bool beside = mtl_.ks || mtl_.ke || mtl_.tf;
        to_.base = mapped(mtl_.kd, mtl_.map_kd, glm::dvec3(beside ? 0.0 : DEFAULT_REFLECTANCE));
        if (is_hidden(mtl_.kd, mtl_.map_kd))
            remark(hidden_text("Kd"), mtl_.map_kd->place);
    }

    void set_reflection() {
        switch (rule_.model) {
        case Model::MATTE:
            if (is_positive(mtl_.ks))
                remark(fmt::format("Ks has no effect with illum {} (2 has gloss)", rule_.illum), mtl_.place);
            break;
        case Model::DIELECTRIC: // Ks, Kd and Ns are ignored; Pr makes the surface rough
            to_.reflection = Reflection::DIELECTRIC;
            set_roughness();
            break;
        case Model::CONDUCTOR:
            set_conductor();
            set_roughness();
            break;
        case Model::METALLIC:
            set_metallic();
            set_roughness();
            break;
        case Model::MEASURED: // Kd, Ks, Pm and illum are what other readers take instead
            to_.reflection = Reflection::MEASURED;
            to_.measured = *mtl_.merl;
            break;
        default:
            set_specular();
            set_roughness();
        }
    }

    /// illum 2, 3, 5, 8. Ks without the key is 1 with its map; an unreadable map alone says nothing about the
    /// gloss.
    void set_specular() {
        if (is_hidden(mtl_.ks, mtl_.map_ks))
            remark(hidden_text("Ks"), mtl_.map_ks->place);
        to_.specular = mapped(mtl_.ks, mtl_.map_ks, glm::dvec3(0));
        if (!mtl_.ks)
            to_.specular.without_map = glm::dvec3(0);
        if (!is_positive(to_.specular.value)) {
            if (rule_.model != Model::GLOSS)
                remark(fmt::format("illum {} without Ks reflects nothing", rule_.illum), mtl_.place);
            return;
        }
        to_.reflection = rule_.model == Model::SCHLICK_MIRROR ? Reflection::SCHLICK : Reflection::CONSTANT;
        to_.whitted_mirror = rule_.model != Model::GLOSS;
    }

    /// Without k nothing is absorbed; Kd, Ks, Pm and illum are what other readers take instead.
    void set_conductor() {
        to_.reflection = Reflection::CONDUCTOR;
        to_.conductor = {*mtl_.eta, mtl_.k.value_or(glm::dvec3(0))};
        to_.whitted_mirror = mtl_.pr.value_or(0) <= WHITTED_MIRROR_PR;
    }

    void set_metallic() {
        if (is_positive(mtl_.ks) || mtl_.illum.value_or(2) > 2)
            remark("Pm is given: metallic-roughness instead of illum and Ks", mtl_.place);
        to_.reflection = Reflection::METALLIC;
        to_.metallic = mapped(mtl_.pm, mtl_.map_pm, 1.0);
        to_.dielectric_f0 = mapped(std::optional<double>(mtl_.dielectric_f0.value_or(DIELECTRIC_F0)),
                                   mtl_.map_dielectric_f0, DIELECTRIC_F0);
        to_.transmission_weight.value = mtl_.transmission_weight.value_or(0);
        to_.whitted_mirror = mtl_.pr && *mtl_.pr <= WHITTED_MIRROR_PR;
    }

    /// Pr times its map, else Ns, else the model's default.
    void set_roughness() {
        const double ns = mtl_.ns.value_or(DEFAULT_NS);
        const double by_ns = is_mirror_by_ns() ? 0.0 : std::sqrt(alpha_of_phong(ns));
        to_.roughness = mapped(mtl_.pr, mtl_.map_pr, by_ns);
        to_.anisotropy = mtl_.aniso.value_or(0);
        to_.anisotropy_rotation = mtl_.anisor.value_or(0);
        if (mtl_.pr)
            return;
        to_.roughness.without_map = by_ns;
        to_.phong_exponent = ns;
    }

    bool is_mirror_by_ns() const {
        switch (rule_.model) {
        case Model::RAY_TRACED:
            return !mtl_.ns || *mtl_.ns >= MIRROR_NS;
        case Model::SCHLICK_MIRROR:
        case Model::CONDUCTOR:
        case Model::DIELECTRIC: // in the wild Ns on glass means nothing
            return true;
        default:
            return false;
        }
    }

    /// Ke without the key is 1 where map_Ke could be read.
    void set_emission() {
        if (is_hidden(mtl_.ke, mtl_.map_ke))
            notices_.add(hidden_text("Ke"), mtl_.map_ke->place);
        to_.emission = mapped(mtl_.ke, mtl_.map_ke, glm::dvec3(0));
        if (!mtl_.ke)
            to_.emission.without_map = glm::dvec3(0);
    }

    /// d wins over Tr; both multiply map_d.
    void set_coverage() {
        const double d = mtl_.d ? *mtl_.d : 1 - mtl_.tr.value_or(0);
        if (mtl_.d && mtl_.tr && std::fabs(*mtl_.d + *mtl_.tr - 1) > 1e-6)
            notices_.add("d and Tr disagree, d is taken", mtl_.place);
        if (d <= 0)
            notices_.add("d is 0: the material is invisible", mtl_.place);
        to_.coverage = mapped(std::optional<double>(d), mtl_.map_d, 1.0);
    }

    /// Bump heights are in scene units: -bm is the height of a full-range map. Of a normal map -bm is the
    /// strength.
    void set_shape_maps() {
        const auto has_effect = [](const std::optional<MtlTexture>& map) {
            return map && map->bump_multiplier != 0;
        };
        if (has_effect(mtl_.map_normal)) {
            to_.normal_map = *mtl_.map_normal;
            to_.normal_strength = mtl_.map_normal->bump_multiplier;
        }
        if (has_effect(mtl_.map_bump)) {
            to_.bump_map = *mtl_.map_bump;
            to_.bump_height = mtl_.map_bump->bump_multiplier;
        }
    }

    void set_interior() {
        to_.is_thin = mtl_.thin_walled.value_or(0) > 0;
        to_.attenuation_colour = mtl_.attenuation.value_or(glm::dvec3(1));
        to_.attenuation_distance = mtl_.attenuation ? mtl_.attenuation_distance.value_or(1) : 0;
        to_.abbe = mtl_.abbe.value_or(0);
        to_.priority = mtl_.priority;
    }

    /// Pc is the coat's weight, Pcr its roughness; Ps the sheen of white fibres, for whose roughness there
    /// is no key.
    void set_covers() {
        if (rule_.model == Model::MEASURED) {
            remark_covers();
            return;
        }
        to_.coat_weight.value = std::min(mtl_.pc.value_or(0), 1.0);
        to_.coat_roughness.value = mtl_.pcr.value_or(DEFAULT_PCR);
        if (!mtl_.ps && !mtl_.map_ps)
            return;
        to_.sheen =
            mapped(mtl_.ps ? std::optional<glm::dvec3>(*mtl_.ps) : std::nullopt, mtl_.map_ps, glm::dvec3(0));
        if (!mtl_.ps)
            to_.sheen.without_map = glm::dvec3(0);
        to_.sheen_roughness.value = SHEEN_ROUGHNESS;
    }

    /// A measurement has all that lies on its surface.
    void remark_covers() {
        constexpr const char* WHAT = "has no effect beside merl";
        remark_key("Pc", "pc", mtl_.pc.value_or(0) > 0, WHAT);
        remark_key("Ps", "ps", mtl_.ps.value_or(0) > 0, WHAT);
        remark_key("map_Ps", "map_ps", mtl_.map_ps.has_value(), WHAT);
    }

    /// Keys that mean nothing here.
    void remark_missing_keys() {
        constexpr const char* WHAT = "has no effect here and is ignored";
        remark_key("map_Ns", "map_ns", mtl_.map_ns.has_value(), WHAT);
        remark_key("map_refl", "map_refl", mtl_.map_refl.has_value(), WHAT);
    }

    void remark_key(const char* name, const char* key, bool is_given, const char* what) {
        if (is_given)
            remark(fmt::format("{} {}", name, what), mtl_.place_of(key));
    }

    const MtlMaterial& mtl_;
    NoticeList& notices_;
    const Rule& rule_;
    MaterialDescription to_;
};

} // namespace

std::vector<MaterialRow> material_rows() {
    std::vector<MaterialRow> rows = {{"Pm 0", METALLIC_RULE.text}, {"conductor gold", CONDUCTOR_RULE.text}};
    for (const Rule& rule : ILLUM_RULES)
        rows.push_back({fmt::format("illum {}", rule.illum), rule.text});
    return rows;
}

MaterialDescription describe_mtl(const MtlMaterial& mtl, NoticeList& notices) {
    return MtlRule(mtl, notices).apply();
}

} // namespace clrt
