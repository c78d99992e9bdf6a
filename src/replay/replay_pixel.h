// SPDX-License-Identifier: Apache-2.0
// --pixel x,y --sample n: the record of one sample as text.
#pragma once

#include "render/prepared_scene.h"

#include <string>

namespace clrt {

/// The record of a sample, as text and as JSON.
struct PixelReplay {
    std::string text, json;
};

/// Replays the sample that the options name, as they would render it, in single precision (in relaxed maths
/// where these are asked for) and, where the device has fp64, in double. The scene may be prepared without
/// programs. Throws DeviceError and KernelBuildError.
PixelReplay replay_pixel(const PreparedScene& prepared);

} // namespace clrt
