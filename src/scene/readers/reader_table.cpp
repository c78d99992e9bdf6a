// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/reader_table.h"

#include "error.h"
#include "scene/readers/foreign_format.h"
#include "scene/readers/gltf_file.h"
#include "scene/readers/gltf_reader.h"
#include "scene/readers/obj_scene.h"
#include "scene/readers/ply_header.h"
#include "scene/readers/ply_reader.h"
#include "scene/readers/stl_reader.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>

namespace clrt {

namespace {

std::string extension_of(const std::string& name) {
    std::string extension = std::filesystem::path(name).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

} // namespace

const std::vector<SceneReader>& scene_readers() {
    static const std::vector<SceneReader> readers = {
        {"a glTF file", ".glb", is_gltf, read_gltf_scene, true},
        {"a PLY file", ".ply", is_ply, read_ply_scene},
        {"an STL file", ".stl", is_stl, read_stl_scene},
        {"a Wavefront OBJ", ".obj", nullptr, read_obj_scene},
    };
    return readers;
}

std::string reader_names() {
    std::string names;
    const std::vector<SceneReader>& readers = scene_readers();
    for (auto reader = readers.rbegin(); reader != readers.rend(); ++reader)
        names += (names.empty()                  ? ""
                  : reader + 1 == readers.rend() ? " or "
                                                 : ", ") +
                 std::string(reader->name);
    return names;
}

const SceneReader& find_reader(const SceneFile& file) {
    for (const SceneReader& reader : scene_readers())
        if (reader.recognises && reader.recognises(file.bytes))
            return reader;
    if (const std::string other = foreign_format(file.bytes); !other.empty())
        throw SceneError(file.name, 0, fmt::format("expected {}, found {}", reader_names(), other));
    for (const SceneReader& reader : scene_readers())
        if (extension_of(file.name) == reader.extension)
            return reader;
    return scene_readers().back();
}

} // namespace clrt
