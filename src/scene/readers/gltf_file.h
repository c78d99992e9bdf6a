// SPDX-License-Identifier: Apache-2.0
// The two containers of glTF: a JSON text, and the binary GLB with the JSON and the first buffer in chunks.
#pragma once

#include "scene/readers/gltf_json.h"
#include "scene/readers/scene_file.h"

#include <optional>
#include <string>
#include <string_view>

namespace clrt {

/// Whether bytes are a GLB, or a JSON text with an "asset".
bool is_gltf(std::string_view bytes);

/// A file with its JSON.
class GltfFile {
public:
    /// Throws SceneError: byte or JSON path, expected, found.
    explicit GltfFile(SceneFile file);

    const std::string& name() const { return file_.name; }
    const JsonDocument& json() const { return *json_; }

    /// The second chunk of a GLB; absent where there is none.
    std::optional<std::string_view> binary() const { return binary_; }

private:
    std::string_view split_chunks();

    SceneFile file_;
    std::optional<std::string_view> binary_;
    std::optional<JsonDocument> json_;
};

} // namespace clrt
