// SPDX-License-Identifier: Apache-2.0
// A rendered film -> a smoother picture whose error is known. A function of the film and of what its samples
// see first alone.
#pragma once

#include "denoise/denoised_error.h"
#include "device/program.h"
#include "options/denoise_options.h"

#include <optional>
#include <string>

namespace clrt {

/// A denoised picture.
struct Denoised {
    Pixels radiance;                      ///< r, g, b: the mean of the denoised halves
    std::optional<DenoisedErrors> errors; ///< none where the picture is black
    std::string method;                   ///< what did it: "filter", "oidn"
    double noisy_share = 0; ///< of the picture, on average: where denoising does not pay it stays noisy
    double seconds = 0;
};

/// How to denoise.
struct DenoiseRequest {
    DenoiseOptions options; ///< with a denoiser
    ErrorMeasure measure = ErrorMeasure::MSE;
    std::string kernels_folder; ///< replaces the embedded kernels
    std::string dump_folder;    ///< gets what is compiled, where it is not ""
    ProgramCache cache;
};

/// The program of the filter, for messages and dumped files.
inline constexpr const char* DENOISE_PROGRAM = "denoise";

/// Denoises a film without an obstacle (denoise_obstacle). Throws DeviceError and KernelBuildError.
Denoised denoise(const Device& device, const Film& film, const HitSums& hits, const DenoiseRequest& request);

} // namespace clrt
