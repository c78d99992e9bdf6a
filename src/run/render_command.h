// SPDX-License-Identifier: Apache-2.0
// From options to pictures: scene -> effects -> simulation -> files and report, once or for every frame of a
// turn.
#pragma once

#include "options/options.h"

namespace clrt {

/// Renders what the options ask for, writes all results and prints the report. Returns the exit code. Throws
/// UsageError, SceneError and DeviceError.
int run_render(Options options);

} // namespace clrt
