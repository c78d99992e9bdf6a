// SPDX-License-Identifier: Apache-2.0
// --pixel x,y --sample n: everything from the scene to the text.
#pragma once

#include "device/device.h"
#include "options/options.h"
#include "scene/scene.h"

#include <string>

namespace clrt {

/// The record of a sample, as text and as JSON.
struct PixelReplay {
    std::string text, json;
};

/// Replays the sample that the options name, as they would render it, in single precision (in relaxed maths
/// where these are asked for) and, where the device has fp64, in double. Throws DeviceError and
/// KernelBuildError.
PixelReplay replay_pixel(const Device& device, Scene scene, Options options);

} // namespace clrt
