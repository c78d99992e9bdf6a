// SPDX-License-Identifier: Apache-2.0
#include "effects/explain.h"

#include "paths/path_report.h"
#include "scene/material_rules.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

std::string explain_json(const Scene& scene, const Effects& effects) {
    nlohmann::ordered_json json;
    json["triangles"] = scene.triangles.size();
    json["effects"] = nlohmann::ordered_json::array();
    for (const Effect& effect : effects.list)
        json["effects"].push_back({{"name", effect.name},
                                   {"present", effect.present},
                                   {"compiled", (effects.mask & effect.bit) != 0},
                                   {"witness", effect.witness}});
    json["paths"] = paths_json(effects.paths);
    json["notices"] = scene.notices;
    return json.dump(2) + "\n";
}

} // namespace

std::string explain(const Scene& scene, const Effects& effects, const Options& options) {
    if (options.explain == Explain::JSON)
        return explain_json(scene, effects);
    std::string text = fmt::format("Effects of {} ({} triangles):\n{}", options.scene_path, scene.triangles.size(),
                                   format_effects(effects));
    text += fmt::format("compiled with CLRT_EFFECTS={:#x}\n\nMaterials:\n{}", effects.mask, material_table(scene));
    if (effects.paths.is_asked)
        text += "\nPaths:\n" + format_paths(effects.paths);
    if (!scene.notices.empty())
        text += "\nNotices:\n";
    for (const std::string& notice : scene.notices)
        text += "  " + notice + "\n";
    return text;
}

} // namespace clrt
