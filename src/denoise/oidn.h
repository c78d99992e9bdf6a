// SPDX-License-Identifier: Apache-2.0
// Open Image Denoise 2, loaded at run time: by its C interface, of which what is used is declared here. Its
// results repeat on a machine, and differ in last bits between processors.
#pragma once

#include "denoise/choice.h"

#include <memory>
#include <optional>
#include <string>

namespace clrt {

struct OidnFunctions;

/// The loaded library with a device on the processor.
class Oidn {
public:
    /// Loads the library: `path` (a file, or the folder that it is in), else the variable CLRT_OIDN, else
    /// where the system's loader looks. Throws DeviceError that says what was looked for, what is
    /// wrong with it, and what to do. It stays loaded.
    explicit Oidn(const std::string& path);
    ~Oidn();
    Oidn(const Oidn&) = delete;
    Oidn& operator=(const Oidn&) = delete;

    /// Such as "2.5.1".
    std::string version() const;

    /// What it makes of a half and of its quarters, guided by albedo and normal that it has smoothed first.
    /// Throws DeviceError with its message.
    DenoiseCandidate candidate(const HalfPicture& half);

private:
    /// Denoises three values a pixel; `name` is what they are: "color", "albedo" or "normal".
    Pixels filter(const char* name, const Pixels& values, const Pixels* albedo, const Pixels* normal,
                  int width, int height);
    void check(const char* doing);

    std::unique_ptr<OidnFunctions> functions_;
    void* device_ = nullptr;
};

} // namespace clrt
