// SPDX-License-Identifier: Apache-2.0
// --denoised-error: when a render looks at what denoising makes of it, and when that is good enough.
//
// A render that ends where the stated error happens to be low ends too early: on the Cornell box (64 x 48
// pixels, looked at after 8, 16, 32 and 64 samples) pictures said to have 19 % had 43 %. So it is the upper
// end of the error's interval that has to come down to the target, of a picture whose noise is known to be
// seen (ErrorSpread::usable); of the same pictures, and of a caustic's, none that ended so then had more than
// the target.
#pragma once

#include "denoise/denoise.h"
#include "options/options.h"
#include "render/render.h"

#include <cstdint>
#include <functional>
#include <optional>

namespace clrt {

/// How to denoise what the options render.
DenoiseRequest denoise_request(const Options& options);

/// Whether the film's error can be believed and the denoised error of the same film is `target` or less with
/// 95 % confidence.
bool denoised_error_reached(const Film& film, const std::optional<Denoised>& denoised, ErrorMeasure measure,
                            double target);

/// Denoises the film of one render now and then. Where it does follows from the film and its rays alone, so
/// that the clock does not change a bit of the picture. Refers to the options.
class DenoisedTarget {
public:
    explicit DenoisedTarget(const Options& options) : options_(options) {}

    /// Whether it is worth looking at a film of this error, for which rays() rays were traced, which is asked
    /// last: at good counts (good_counts.h) from so many rays a pixel on; between doublings only where
    /// the denoised error may have come down to the target since the last look. Once before, where the error
    /// as it is rendered is at the target.
    bool is_due(const Film& film, const std::optional<FilmError>& error,
                const std::function<std::uint64_t()>& rays);
    /// Denoises the film of a render into Render::denoised and notes it in Render::looks. A film that cannot
    /// be denoised yet is left alone. What fails is said, and then there is no further look.
    void look(const Device& device, Progress& progress, Render& render);
    /// Whether the last look was at this film, and what it saw satisfies the target.
    bool reached(const Render& render) const;

    /// Denoising takes as long as a quarter of so many rays a pixel (Cornell box, PoCL: the filter 190, Open
    /// Image Denoise 460), and doublings follow: what is denoised before the last look, which is the
    /// picture's, costs about a tenth of the render.
    static constexpr std::uint64_t RAYS_BEFORE_LOOKS = 800, RAYS_BEFORE_OIDN = 2000;

private:
    const Options& options_;
    std::optional<FilmDenoiser> denoiser_;
    const Device* device_ = nullptr; ///< of the denoiser
    bool has_failed_ = false, is_first_due_ = true;
    double last_high_ = 0;           ///< upper end of the interval at the last look,
    std::uint64_t last_samples_ = 0; ///< and the samples a pixel there
};

} // namespace clrt
