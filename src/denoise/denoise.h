// SPDX-License-Identifier: Apache-2.0
// A rendered film -> a smoother picture whose error is known. A function of the film and of what its samples
// see first alone.
#pragma once

#include "denoise/denoised_error.h"
#include "device/program.h"
#include "options/denoise_options.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace clrt {

/// A denoised picture.
struct Denoised {
    Pixels radiance;                      ///< r, g, b: the mean of the denoised halves
    std::optional<DenoisedErrors> errors; ///< none where the picture is black
    std::string method;                   ///< what did it: "filter", "oidn"
    std::uint64_t samples = 0;            ///< a pixel, of the film
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

class FeatureFilter;
class Oidn;

/// A denoiser that is compiled or loaded, for one film after the other. Refers to the device.
class FilmDenoiser {
public:
    /// Throws DeviceError and KernelBuildError.
    FilmDenoiser(const Device& device, const DenoiseRequest& request);
    ~FilmDenoiser();

    /// Denoises a film without an obstacle (denoise_obstacle). Throws DeviceError.
    Denoised denoise(const Film& film, const HitSums& hits);

private:
    std::array<DenoisedHalf, 2> halves(const Film& film, const HitSums& hits);

    ErrorMeasure measure_;
    std::unique_ptr<Oidn> oidn_; ///< null: the filter
    std::unique_ptr<FeatureFilter> filter_;
};

} // namespace clrt
