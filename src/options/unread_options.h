// SPDX-License-Identifier: Apache-2.0
// Options that a render does not read.
#pragma once

#include "options/options.h"

#include <string>
#include <vector>

namespace clrt {

/// What was given on the command line and changes nothing, a sentence each: options of other integrators than
/// the one that renders, and what turns or scales an environment that is not there. Options files of scenes
/// are for all integrators; and what is refused is not told here.
std::vector<std::string> unread_options(const Options& options);

} // namespace clrt
