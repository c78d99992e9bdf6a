// SPDX-License-Identifier: Apache-2.0
// The formats of scenes: one row each. A new one is a row and its files.
#pragma once

#include "console/progress.h"
#include "options/scene_options.h"
#include "scene/notices.h"
#include "scene/readers/scene_file.h"
#include "scene/scene_description.h"

#include <string>
#include <string_view>
#include <vector>

namespace clrt {

/// What a reader is given beside the file.
struct ReadContext {
    Progress& progress;
    NoticeList& notices; ///< for every fallback that is taken
    const PictureFacts& pictures;
    MtlReading mtl;
    GltfReading gltf{};
    Toggle instances = Toggle::AUTO; ///< SceneOptions::instances
    bool is_key_frame = false;       ///< of two: what is scaled to nothing stays, it may show in the other
};

struct SceneReader {
    const char* name;      ///< of a file, such as "a Wavefront OBJ"
    const char* extension; ///< lower case, with its dot
    /// Whether bytes are of this format, where that shows; null for a format without a mark.
    bool (*recognises)(std::string_view bytes);
    /// Understands any bytes or throws SceneError: file, line or byte, what was expected and what was found.
    SceneDescription (*read)(SceneFile file, const ReadContext& context);
    bool plays_animations = false; ///< it takes GltfReading::time
};

/// All formats that can be read; the last takes what no other one knows.
const std::vector<SceneReader>& scene_readers();

/// "a Wavefront OBJ", "a Wavefront OBJ or an STL file": all formats.
std::string reader_names();

/// The reader of a file: by its bytes, else by its extension, else the last one. Throws SceneError that names
/// the format where none can read it.
const SceneReader& find_reader(const SceneFile& file);

} // namespace clrt
