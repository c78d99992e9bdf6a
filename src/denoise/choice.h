// SPDX-License-Identifier: Apache-2.0
// Which of several smoothed versions of a half each pixel takes, and where the noisy one stays. The choice is
// made within the half: it is a part of the denoiser, whose result the other half judges without bias.
#pragma once

#include "denoise/half_picture.h"

namespace clrt {

/// What some filter makes of a half.
struct DenoiseCandidate {
    std::array<Pixels, 2> quarter; ///< of each quarter, without the noise of the other one
    Pixels half;                   ///< of both
};

/// A denoised half.
struct DenoisedHalf {
    Pixels radiance; ///< r, g, b
    /// What the half itself expects of its squared error, summed over channels and smoothed over a few
    /// pixels. Biased: it is the least of several estimates.
    Pixels expected;
    Pixels noisy; ///< share of the noisy pixel in each
};

/// Takes of the candidates and the half itself, which is the first one, what has the least squared error
/// around each pixel, by what each quarter tells of the other one's result. Lit pixels decide for lit ones.
DenoisedHalf choose_candidates(const HalfPicture& half, const std::vector<DenoiseCandidate>& candidates);

} // namespace clrt
