// SPDX-License-Identifier: Apache-2.0
// What every run on a device begins with.
#pragma once

#include "console/progress.h"
#include "device/device.h"
#include "options/options.h"
#include "scene/scene.h"

#include <vector>

namespace clrt {

/// The devices that the options name, open; says what platforms and the cache of programs lack. Throws
/// DeviceError.
std::vector<Device> open_chosen_devices(const Options& options);

/// The same where only one is asked for.
Device open_chosen_device(const Options& options);

/// The scene of a run, whose results are known not to replace what it was loaded from; the options take over
/// the picture's size where the scene gives it. Throws SceneError and UsageError.
Scene load_for_run(Options& options, Progress& progress);

} // namespace clrt
