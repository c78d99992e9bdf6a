// SPDX-License-Identifier: Apache-2.0
// How 8-bit pictures show radiance: options that clrt and clrt-merge share.
#pragma once

#include "app/option_values.h"

namespace clrt {

/// --exposure: stops, "auto", or "auto+1" and "auto-0.5" for as many stops from there. Throws UsageError.
void apply_exposure(Options& options, const OptionValue& value);

/// --tonemap: the name of a curve. Throws UsageError.
void apply_tonemap(Options& options, const OptionValue& value);

extern const char* const EXPOSURE_HELP;
extern const char* const TONEMAP_HELP;

} // namespace clrt
