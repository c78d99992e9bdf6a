// SPDX-License-Identifier: Apache-2.0
// By what directions of a measured BRDF are sampled.
#pragma once

#include "scene/measured_values.h"

namespace clrt {

/// The tables of the view of a number below MEASURED_VIEWS: the albedo; the probability of each cell of half
/// angles, in proportion to the light that its half vectors send to the eye under an even sky; and the share
/// of a cosine lobe beside them by which the variance is least. It is never 0, so that no direction is left
/// out.
MeasuredView sample_measured(const MeasuredValues& values, u32 view);

} // namespace clrt
