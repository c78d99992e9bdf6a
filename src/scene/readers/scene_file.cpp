// SPDX-License-Identifier: Apache-2.0
#include "scene/readers/scene_file.h"

#include "output/standard_streams.h"
#include "scene/text_scanner.h"

namespace clrt {

SceneFile read_scene_file(const std::string& path) {
    return {input_name(path), read_file(path)};
}

} // namespace clrt
