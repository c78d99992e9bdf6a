// SPDX-License-Identifier: Apache-2.0
// Options of the camera that are fine one by one and make no sense together.
#pragma once

#include "options/options.h"

#include <optional>
#include <string>

namespace clrt {

/// What is wrong with the camera's options, naming them; nothing if they fit together.
std::optional<std::string> find_camera_fault(const Options& options);

} // namespace clrt
