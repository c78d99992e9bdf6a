// SPDX-License-Identifier: Apache-2.0
// What --pixel says: the path of one sample, in single and in double precision side by side.
#pragma once

#include "replay/twins.h"

#include <string>

namespace clrt {

/// One replayed sample and what its record refers to.
struct ReplayReport {
    const Options& options;
    const Scene& scene;
    const DeviceInfo& device;
    double quantum = 1;              ///< of the film, radiance
    SampleTrace first;               ///< in the picture's precision, or single where that is double
    std::optional<SampleTrace> twin; ///< in double, where the device has it
};

/// The record as a table: quantities in scene units; with `hex`, below each line the numbers of the kernel,
/// which lie in the normalised frame, to the last bit.
std::string format_replay(const ReplayReport& report, bool hex);

/// The same as JSON: each event with its values in scene units and the kernel's numbers as hexadecimal
/// floats.
std::string replay_json(const ReplayReport& report);

} // namespace clrt
