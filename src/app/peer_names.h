// SPDX-License-Identifier: Apache-2.0
// What other renderers call an option, for people who type it out of habit.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// Names of other renderers' options with what clrt calls them, as one would type it ("--device gpu"). None
/// is a name of clrt's own.
const std::vector<std::pair<const char*, const char*>>& peer_names();

/// What clrt calls this name of another renderer, in any spelling with capitals, dashes and underscores; ""
/// if none does.
std::string name_here(const std::string& typed);

} // namespace clrt
