// SPDX-License-Identifier: Apache-2.0
// Files that a scene names: relative to the file that names them, written on any system.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace clrt {

/// The path of a file named in `referrer`: tried as written, with backslashes as separators, and (if
/// `by_base_name`) by its last part beside the referrer, for paths of the machine it was made on; then both
/// again without regard to the case of A to Z, the first by name of several. A relative name is relative to
/// the referrer's folder. Nothing if there is no such file.
std::optional<std::string> find_file(std::string_view name, const std::string& referrer,
                                     bool by_base_name = true);

} // namespace clrt
