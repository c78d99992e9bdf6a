// SPDX-License-Identifier: Apache-2.0
// Files that no reader knows: what they are.
#pragma once

#include <string>
#include <string_view>

namespace clrt {

/// What a file is, by its first bytes, and what to do with it, such as "a binary glTF file (GLB): ..."; empty
/// for one that may be an OBJ. Only what no OBJ can begin with is named.
std::string foreign_format(std::string_view bytes);

} // namespace clrt
