// SPDX-License-Identifier: Apache-2.0
// STEM.clrt: options that belong to a scene.
#pragma once

#include "app/option_table.h"

#include <string>
#include <vector>

namespace clrt {

/// STEM.clrt beside STEM.obj if there is such a file, otherwise "".
std::string find_options_file(const std::string& scene_path);

/// The lines of an options file: one long option a line; after the first blank (or '=') the rest of the line
/// is the value; lines that are blank or start with '#' are comments. Line ends may be LF or CRLF. Relative
/// paths in values count from the file's folder. Throws UsageError with "file:line: " for lines it cannot
/// use, SceneError when the file cannot be read.
std::vector<GivenOption> read_options_file(const std::string& path);

} // namespace clrt
