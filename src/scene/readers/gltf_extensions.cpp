// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/gltf_extensions.h"

#include <algorithm>
#include <fmt/format.h>

namespace clrt {

namespace {

bool is_read(const std::string& name) {
    const std::vector<std::string>& known = gltf_extensions();
    return std::binary_search(known.begin(), known.end(), name);
}

} // namespace

const std::vector<std::string>& gltf_extensions() {
    static const std::vector<std::string> names = {
        "EXT_mesh_gpu_instancing",
        "EXT_meshopt_compression",
        "EXT_texture_webp",
        "KHR_draco_mesh_compression",
        "KHR_lights_punctual",
        "KHR_materials_anisotropy",
        "KHR_materials_clearcoat",
        "KHR_materials_dispersion",
        "KHR_materials_emissive_strength",
        "KHR_materials_ior",
        "KHR_materials_pbrSpecularGlossiness",
        "KHR_materials_sheen",
        "KHR_materials_specular",
        "KHR_materials_transmission",
        "KHR_materials_unlit",
        "KHR_materials_volume",
        "KHR_mesh_quantization",
        "KHR_meshopt_compression",
        "KHR_texture_transform",
    };
    return names;
}

void check_gltf_extensions(const JsonDocument& json, NoticeList& notices) {
    for (const JsonValue& name : json.elements("extensionsRequired"))
        if (!is_read(name.text()))
            name.fail(fmt::format("an extension that can be read ({})", fmt::join(gltf_extensions(), ", ")));
    std::vector<std::string> ignored;
    for (const JsonValue& name : json.elements("extensionsUsed"))
        if (!is_read(name.text()))
            ignored.push_back(name.text());
    if (!ignored.empty())
        notices.add(fmt::format("extensions that are ignored: {}", fmt::join(ignored, ", ")),
                    {json.root().file(), 0});
}

} // namespace clrt
