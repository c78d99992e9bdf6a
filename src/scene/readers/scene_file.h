// SPDX-License-Identifier: Apache-2.0
// The bytes of a scene's file.
#pragma once

#include <string>

namespace clrt {

struct SceneFile {
    std::string name; ///< for messages; what the file names is looked for beside it
    std::string bytes;
};

/// Reads a file, or the standard input ("-"), whose name is then "stdin". Throws SceneError.
SceneFile read_scene_file(const std::string& path);

} // namespace clrt
