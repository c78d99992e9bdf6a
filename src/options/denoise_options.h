// SPDX-License-Identifier: Apache-2.0
// Denoising, and which picture 8-bit files show.
#pragma once

#include "options/names.h"

#include <optional>
#include <string>

namespace clrt {

enum class Denoiser {
    AUTO,  ///< Open Image Denoise where it is found, else the filter
    OIDN,  ///< Open Image Denoise, loaded at run time
    FILTER ///< regression on features, by kernels of ours
};

template <>
inline constexpr Named<Denoiser> NAMES<Denoiser>[] = {
    {Denoiser::AUTO, "auto"}, {Denoiser::OIDN, "oidn"}, {Denoiser::FILTER, "filter"}};

/// What 8-bit pictures show.
enum class PngFrom { RAW, DENOISED };

template <>
inline constexpr Named<PngFrom> NAMES<PngFrom>[] = {{PngFrom::RAW, "raw"}, {PngFrom::DENOISED, "denoised"}};

struct DenoiseOptions {
    std::optional<Denoiser> denoiser; ///< absent: nothing is denoised
    std::string oidn_path;            ///< the library of Open Image Denoise; empty: looked for
    PngFrom png_from = PngFrom::RAW;
};

} // namespace clrt
