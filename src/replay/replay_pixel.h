// SPDX-License-Identifier: Apache-2.0
// Samples of single pixels: their records as text.
#pragma once

#include "replay/replay.h"

#include <optional>
#include <string>

namespace clrt {

/// The record of a sample, as text and as JSON.
struct PixelReplay {
    std::string text, json;
};

/// Whether a sample is replayed in double precision as well.
enum class ReplayTwin { NO, WHERE_FP64 };

/// Replays samples of one picture as they were rendered, in single precision (in relaxed maths where these
/// are asked for).
class PixelReplayer {
public:
    /// Compiles. The scene may be prepared without programs. Throws DeviceError and KernelBuildError.
    PixelReplayer(const PreparedScene& prepared, ReplayTwin twin);

    /// Throws DeviceError.
    PixelReplay replay(const SampleAddress& address);

private:
    PreparedScene prepared_;
    Replay first_;
    std::optional<Replay> twin_;
};

/// --pixel x,y --sample n: the sample that the options name, in double as well where the device has fp64.
/// Throws DeviceError and KernelBuildError.
PixelReplay replay_pixel(const PreparedScene& prepared);

} // namespace clrt
