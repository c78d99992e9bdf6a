// SPDX-License-Identifier: Apache-2.0
// What a run did: printed after the render, written as JSON, stored in the picture's metadata.
#pragma once

#include "bvh/bvh.h"
#include "device/device_facts.h"
#include "effects/effects.h"
#include "output/image.h"
#include "render/error_report.h"
#include "render/integrator_choice.h"
#include "render/render.h"
#include "replay/causes.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

/// Everything the report tells about; stages fill their part.
struct Report {
    const Options& options;
    const Scene& scene;
    const Effects& effects;
    const DeviceInfo& device;
    const std::optional<DeviceFacts>& facts; ///< how it computes, where it was asked
    const Bvh& bvh;
    const Render& render;
    ErrorReport error;
    std::string bvh_reason;         ///< why the tree has its quality
    std::vector<CauseCount> causes; ///< of the bad samples that were replayed
    double load_seconds = 0, pilots_seconds = 0, compile_seconds = 0, total_seconds = 0;
    double exposure_ev = 0;                        ///< stops of the 8-bit pictures
    IntegratorChoice choice = {};                  ///< of --integrator auto
    std::optional<std::string> empty_picture = {}; ///< why the picture shows nothing, where it does not
    std::vector<std::string> lost_files = {};      ///< results that could not be written
};

/// The error that the command names, and whether the picture satisfies it.
struct ErrorTarget {
    const char* option = ""; ///< "--error" or "--denoised-error"
    double value = 0;
    bool reached = false;
};

/// None where no error is asked for.
std::optional<ErrorTarget> error_target(const Report& report);
/// "--error 2 % is not reached"
std::string missed_text(const ErrorTarget& target);

/// Largest resident memory of this process so far, bytes.
std::uint64_t peak_memory_bytes();

/// The lines that end a run, for stdout: what everybody asks and whatever is wrong, with -v all of it.
std::string format_report(const Report& report);

/// The --stats file: JSON in SI units.
std::string report_json(const Report& report);

/// The same facts as metadata of a picture.
Metadata report_metadata(const Report& report);

} // namespace clrt
