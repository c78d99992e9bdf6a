// SPDX-License-Identifier: Apache-2.0
// What is said about a picture's error in words. The terms are explained in the manual page
// (tools/manpage.py).
#pragma once

#include "film/adaptive.h"
#include "render/error_report.h"

#include <string>

namespace clrt {

/// "8.0 %", from 1 % on with one decimal, below with two digits; never in exponent form.
std::string percent_text(double fraction);

/// What an adaptive render expects: "2.3 times less squared error with as many samples: more of them go where
/// the picture is noisy".
std::string gain_text(const AdaptiveRound& round);

/// What everybody asks: lines "error", "verdict", "cut", "not seen" and "price".
std::string format_error_report(const ErrorReport& report);

/// What says where the error comes from and how it falls: lines "slope", "worst" and "tails".
std::string format_error_details(const ErrorReport& report);

} // namespace clrt
