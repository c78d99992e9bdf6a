// SPDX-License-Identifier: Apache-2.0
// What --help says about integrators, from their rows (options/integrators.h).
#pragma once

#include "options/integrators.h"

#include <string>

namespace clrt {

/// "path (what it simulates), ... or auto (...) (default path)": those that simulate most come first.
std::string integrator_choices();

/// "default 4096, whitted 10, raycast always 2": longest paths without --max-depth, the default integrator's
/// first.
std::string depth_defaults();

/// "path: ", the integrators that take an option.
std::string takers(IntegratorOption option);

} // namespace clrt
