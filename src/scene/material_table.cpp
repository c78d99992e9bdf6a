// SPDX-License-Identifier: Apache-2.0
#include "scene/material_table.h"

#include "colour.h"
#include "scene/measured_store.h"
#include "scene/text_scanner.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {
namespace {

std::string colour(const vec4& v) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", v.x, v.y, v.z);
}

std::string roughness(const Material& m) {
    return m.alpha_x == m.alpha_y ? fmt::format("alpha {:.4g}", m.alpha_x)
                                  : fmt::format("alpha {:.4g} x {:.4g}{}", m.alpha_x, m.alpha_y,
                                                m.flags & MATERIAL_TURNED ? " turned" : "");
}

std::string reflection(const Material& m, const char* name) {
    const std::string kind =
        m.flags & MATERIAL_METALLIC_ROUGHNESS ? fmt::format("F0 from Kd and Pm {:.4g}", MATERIAL_METALLIC(m))
        : m.fresnel == FRESNEL_CONDUCTOR ? "index " + colour(m.transmission) + " + i " + colour(m.specular)
        : m.fresnel == FRESNEL_SCHLICK   ? "F0 " + colour(m.specular)
                                         : colour(m.specular);
    return fmt::format("{} {}", name, kind);
}

std::string glass(const Material& m, const MaterialExtension& e) {
    std::string text =
        fmt::format("{} Ni {:.4g}", m.lobes & LOBE_PANE ? "thin wall" : "dielectric", MATERIAL_INDEX(m));
    if (m.flags & MATERIAL_PART_GLASS)
        text += fmt::format(" weight {:.4g} of what is no metal", EXTENSION_TRANSMISSION(e));
    else
        text += " Tf " + colour(m.transmission);
    if (m.alpha_x > 0)
        text += " " + roughness(m);
    if (m.flags & MATERIAL_ATTENUATES)
        text += fmt::format(" absorbing {}", colour(e.attenuation));
    if (m.flags & MATERIAL_NESTED)
        text += fmt::format(" priority {:.4g}", e.priority);
    if (m.flags & MATERIAL_DISPERSES)
        text += fmt::format(" Abbe {:.4g}", (MATERIAL_INDEX(m) - 1) / e.spread);
    return text;
}

void add_covers(const Material& m, const MaterialExtension& e, std::vector<std::string>& parts) {
    if (m.lobes & LOBE_COAT)
        parts.push_back(fmt::format("coat {:.4g} alpha {:.4g}", e.coat, e.coat_alpha));
    if (m.lobes & LOBE_SHEEN)
        parts.push_back(fmt::format("sheen {} alpha {:.4g}", colour(e.sheen), EXTENSION_SHEEN_ALPHA(e)));
}

std::string measured(const Scene& scene, u32 first_word) {
    const MeasuredBrdf m = measured_at(scene.measured, first_word);
    return fmt::format("measured {}, {} x {} x {} values, head-on {}",
                       clrt::quoted(scene.measured_names.at(first_word)), m.half_count, m.difference_count,
                       m.azimuth_count, colour(m.views[MEASURED_VIEWS - 1].albedo));
}

std::vector<std::string> parts_of(const Scene& scene, const Material& m, const MaterialExtension& e) {
    std::vector<std::string> parts;
    if (m.lobes & LOBE_MATTE)
        parts.push_back("matte " + colour(m.matte));
    if (m.lobes & LOBE_GLOSSY)
        parts.push_back(reflection(m, "glossy") + " " + roughness(m));
    if (m.lobes & LOBE_MIRROR)
        parts.push_back(reflection(m, "mirror"));
    if (m.lobes & LOBES_GLASS)
        parts.push_back(glass(m, e));
    if (m.lobes & LOBE_MEASURED)
        parts.push_back(measured(scene, e.measured));
    add_covers(m, e, parts);
    if (!m.lobes)
        parts.push_back("black");
    if (m.emission.x > 0 || m.emission.y > 0 || m.emission.z > 0)
        parts.push_back("emits " + colour(m.emission) +
                        (m.flags & MATERIAL_EMITS_BOTH_SIDES ? " on both sides" : ""));
    if (m.flags & MATERIAL_CUT_OUT)
        parts.push_back(fmt::format("coverage {:.4g}", MATERIAL_COVERAGE(m)));
    return parts;
}

/// Maps and what each is of.
using Maps = std::vector<std::pair<const char*, u32>>;

Maps maps_of(const Material& m) {
    return {{"Kd", m.map_matte},     {"Ks", m.map_specular}, {"Ke", m.map_emission},   {"d", m.map_coverage},
            {"Pr", m.map_roughness}, {"Pm", m.map_metallic}, {"normal", m.map_normal}, {"bump", m.map_bump}};
}

Maps maps_of(const MaterialExtension& e) {
    return {{"transmission", e.map_transmission},
            {"Pc", e.map_coat},
            {"Pcr", e.map_coat_roughness},
            {"Ps", e.map_sheen},
            {"sheen roughness", e.map_sheen_roughness},
            {"anisotropy", e.map_anisotropy}};
}

std::string named_maps(const Maps& maps, const Scene& scene) {
    std::string text;
    for (const auto& [name, index] : maps)
        if (index != NO_INDEX)
            text += fmt::format(", {} map {}", name, clrt::quoted(scene.texture_names[index]));
    return text;
}

} // namespace

std::string describe_material(const Scene& scene, size_t index) {
    const SourcePlace& place = scene.material_places[index];
    const std::string where = place.line ? fmt::format(" ({}:{})", place.file, place.line) : "";
    return fmt::format("material \"{}\"{}", scene.material_names[index], where);
}

std::string material_summary(const Scene& scene, size_t index) {
    const Material& material = scene.materials[index];
    const MaterialExtension extension =
        scene.extensions.empty() ? MaterialExtension{} : scene.extensions[index];
    std::string text = fmt::format("{}{}", fmt::join(parts_of(scene, material, extension), ", "),
                                   named_maps(maps_of(material), scene));
    if (!scene.extensions.empty())
        text += named_maps(maps_of(extension), scene);
    return text;
}

std::string material_table(const Scene& scene) {
    size_t name_width = 8, rule_width = 4;
    std::vector<std::string> names;
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        names.push_back(scene.material_names[i].empty() ? "(none)" : scene.material_names[i]);
        name_width = std::max(name_width, names[i].size());
        rule_width = std::max(rule_width, scene.material_rules[i].size());
    }
    std::string table =
        fmt::format("{:<{}}  {:<{}}  {}\n", "material", name_width, "rule", rule_width, "became");
    for (size_t i = 0; i < scene.materials.size(); ++i)
        table += fmt::format("{:<{}}  {:<{}}  {}\n", names[i], name_width, scene.material_rules[i],
                             rule_width, material_summary(scene, i));
    return table;
}

} // namespace clrt
