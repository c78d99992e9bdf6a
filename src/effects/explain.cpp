// SPDX-License-Identifier: Apache-2.0
#include "effects/explain.h"

#include "output/standard_streams.h"
#include "paths/path_report.h"
#include "scene/ground.h"
#include "scene/material_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

using Json = nlohmann::ordered_json;

Json effect_json(const Effects& effects, const Effect& effect) {
    Json json{{"name", effect.name},
              {"present", effect.present},
              {"compiled", ((effects.mask | ~EFFECT_ALL) & effect.bit) != 0},
              {"left_out", (effects.left_out & effect.bit) != 0},
              {"witness", effect.witness},
              {"file", nullptr},
              {"line", nullptr}};
    if (effect.place.line) {
        json["file"] = effect.place.file;
        json["line"] = effect.place.line;
    }
    return json;
}

Json materials_json(const Scene& scene) {
    Json list = Json::array();
    for (size_t i = 0; i < scene.materials.size(); ++i)
        list.push_back({{"name", scene.material_names[i]},
                        {"file", scene.material_places[i].file},
                        {"line", scene.material_places[i].line},
                        {"rule", scene.material_rules[i]},
                        {"became", material_summary(scene, i)}});
    return list;
}

std::string explain_json(const Scene& scene, const Effects& effects, const Options& options) {
    Json json;
    json["scene"] = input_name(options.scene.path);
    json["triangles"] = file_triangles(scene);
    json["effects"] = Json::array();
    for (const Effect& effect : effects.list)
        json["effects"].push_back(effect_json(effects, effect));
    json["effects_mask"] = effects.mask;
    json["materials"] = materials_json(scene);
    json["paths"] = paths_json(effects.paths);
    json["blind_spots"] = blind_spots_json(effects.paths.blind_spots);
    json["notices"] = scene.notices;
    return json.dump(2) + "\n";
}

} // namespace

std::string explain(const Scene& scene, const Effects& effects, const Options& options) {
    if (options.run.explain == Explain::JSON)
        return explain_json(scene, effects, options);
    std::string text = fmt::format("Effects of {} ({} triangles):\n{}", input_name(options.scene.path),
                                   file_triangles(scene), format_effects(effects));
    for (const std::string& line : describe_left_out(effects))
        text += line + "\n";
    text += fmt::format("compiled with CLRT_EFFECTS={:#x}\n\nMaterials:\n{}", effects.mask,
                        material_table(scene));
    if (effects.paths.is_asked)
        text += "\nPaths:\n" + format_paths(effects.paths);
    if (!effects.paths.blind_spots.empty())
        text += "\nNot seen:\n";
    for (const BlindSpot& spot : effects.paths.blind_spots)
        text += fmt::format("  {}: {}\n", spot.paths, spot.cause);
    if (!scene.notices.empty())
        text += "\nNotices:\n";
    for (const std::string& notice : scene.notices)
        text += "  " + notice + "\n";
    return text;
}

} // namespace clrt
