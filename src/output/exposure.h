// SPDX-License-Identifier: Apache-2.0
// How bright a picture is to be shown.
#pragma once

#include "options/output_options.h"

#include <string>
#include <vector>

namespace clrt {

/// Stops that suit a picture of linear RGB, by E. Reinhard, "Parameter Estimation for Photographic Tone
/// Reproduction" (Journal of Graphics Tools 7(1), 2002): its mean of logarithms becomes a key value, 0.18
/// where it lies midway between the darkest and the brightest luminance, up to 0.72 where bright tones
/// prevail. Where dark ones do Reinhard goes down to 0.045, here 0.18 stays: a window in view makes no room
/// one that is meant to be dark. Of the pixels that show light: a black backdrop counts for nothing, and the
/// darkest and the brightest hundredth only as much as those next to them. 0 where no pixel shows light. A
/// whole number of hundredths of a stop, so that --exposure with the printed number gives the same picture; k
/// times the radiance is log2 k stops less.
double auto_exposure_ev(const std::vector<float>& rgb);

/// The stops that the options ask for, for this picture; with auto exposure, a whole number of hundredths.
double chosen_exposure_ev(const OutputOptions& options, const std::vector<float>& rgb);

/// What is said where a picture without stops is dark, or bright and no tone map shows it: those that would
/// show it. Empty where its tones ask for less than STRIKING_STOPS, and where light is in less than half of
/// it: they are the tones of something before a black backdrop.
std::string exposure_hint(const OutputOptions& options, const std::vector<float>& rgb);

/// From here on, up or down, little of a picture is seen without them.
constexpr double STRIKING_STOPS = 3;

/// What is said about stops that were chosen: the flag that gives the same picture.
std::string exposure_notice(double exposure_ev);

} // namespace clrt
