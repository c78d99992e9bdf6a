// SPDX-License-Identifier: Apache-2.0
// How wrong a denoised picture is, bias included, without a reference: each half of the replicates judges
// what was made of the other one.
//
// Let f_A be made of half A alone, and B_1 ... B_h be the means of the other half's replicates: each is the
// truth t on average, and independent of the others and of f_A. So (f_A - B_k).(f_A - B_l) is |f_A - t|^2 on
// average for k != l, whatever f_A is; the mean over all pairs is mean[(f_A - B)^2 - Var B]. The picture is
// m = (f_A + f_B) / 2, and
//
//     |m - t|^2 = (|f_A - t|^2 + |f_B - t|^2) / 2 - |f_A - f_B|^2 / 4,
//
// of which the last term is known: the estimate has no bias. |f_A - f_B| alone sees what noise is left, not
// what is smeared. The pixels' estimates, or where paths serve several pixels those of the film's blocks
// (film/film_error.h), are taken as a sample, which gives the interval of their mean, 95 % by Student's
// distribution. Few pixels often decide, such as the rim of a lamp: the degrees of freedom are
// those of the sum of squared deviations, (sum of squares)^2 / sum of fourth powers (Satterthwaite 1946), 2
// to 5 on pictures of 64 x 48 pixels of the Cornell box and a caustic, where 1.96 standard errors hold 87 %
// of the errors and the interval holds 94 %. It is wider than it would have to be where the error itself
// differs from pixel to pixel, and, as that of the raw picture's error, too narrow where pixels' noise is not
// independent (film/film_error.h) or light was not seen yet (ErrorSpread::usable).
#pragma once

#include "denoise/choice.h"
#include "film/error_measure.h"

#include <optional>

namespace clrt {

/// Both errors of the same pixels, over the mean radiance of the pixels that show the scene.
struct DenoisedError {
    double raw = 0;           ///< of the picture without denoising
    double denoised = 0;      ///< 0 where the estimate of its square is negative
    double low = 0, high = 0; ///< with 95 % confidence; low is 0 where the noise hides the error
};

/// What is known of a denoised picture's error.
struct DenoisedErrors {
    DenoisedError all;           ///< over the pixels that show the scene (ErrorPixels::SCENE)
    DenoisedError without_worst; ///< without those whose error is expected to be the largest
    std::vector<size_t> worst;   ///< these: pixels of the picture, in order
    Pixels tiles; ///< in each pixel the error of its tile of ERROR_TILE_SIZE, over the same mean radiance
};

/// The part of the pixels that is left out for DenoisedErrors::without_worst.
constexpr double WORST_SHARE = 0.01;

/// The errors of the mean of both halves of a film. None where the picture is black.
std::optional<DenoisedErrors> denoised_errors(const Film& film, const std::array<DenoisedHalf, 2>& halves,
                                              ErrorMeasure measure);

} // namespace clrt
