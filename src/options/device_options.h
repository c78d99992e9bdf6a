// SPDX-License-Identifier: Apache-2.0
// The device, and how programs for it are made and compute.
#pragma once

#include "options/names.h"
#include "options/toggle.h"

#include <string>
#include <vector>

namespace clrt {

enum class Precision { SINGLE, DOUBLE, FAST };

template <>
inline constexpr Named<Precision> NAMES<Precision>[] = {
    {Precision::SINGLE, "single"}, {Precision::DOUBLE, "double"}, {Precision::FAST, "fast"}};

struct DeviceOptions {
    std::string name; ///< as given to --device, with commas between several; empty: CLRT_DEVICE, else the
                      ///< first GPU, else the CPU
    int threads = 0;  ///< of a CPU; 0: all
    Precision precision = Precision::SINGLE;
    std::string kernels_folder; ///< replaces the embedded kernels
    std::string dump_folder;    ///< writes exactly what was compiled
    Toggle cache = Toggle::AUTO;
    std::string cache_folder; ///< default: the user's cache folder
};

/// The devices that are asked for, by --device or CLRT_DEVICE, one name each; an empty one is the default.
std::vector<std::string> device_names(const DeviceOptions& options);

/// Whether several devices share the picture.
bool shares_picture(const DeviceOptions& options);

} // namespace clrt
