// SPDX-License-Identifier: Apache-2.0
// Files of the MERL BRDF database (Matusik, Pfister, Brand and McMillan 2003).
#pragma once

#include "scene/measured_values.h"

#include <string>
#include <string_view>

namespace clrt {

/// Most samples of half angle, difference angle and azimuth: those of the database. Coarser files of the
/// same form are read too.
constexpr u32 MERL_HALF_ANGLES = 90, MERL_DIFFERENCE_ANGLES = 90, MERL_AZIMUTHS = 180;

/// What the numbers of a channel are multiplied by to give a BRDF per steradian.
constexpr double MERL_RED = 1.0 / 1500, MERL_GREEN = 1.15 / 1500, MERL_BLUE = 1.66 / 1500;

/// A BRDF above this, per steradian, is no measurement.
constexpr double MERL_LARGEST = 1e9;

/// Reads the bytes of a file: three counts (int32, little endian), then red, green and blue of all cells
/// (double), one channel after the other. Negative numbers are no measurements: above the horizon they are
/// counted and become 0; where one of the directions is below it, which is asked for by interpolation alone,
/// the value next to them stays. `path` names the file in messages. Throws SceneError for counts that are
/// none, for another length than they call for, and for numbers that are not finite or too large.
MeasuredValues parse_merl(std::string_view bytes, const std::string& path);

} // namespace clrt
