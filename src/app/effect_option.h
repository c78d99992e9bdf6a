// SPDX-License-Identifier: Apache-2.0
// The value of --effects.
#pragma once

#include "app/option_values.h"

namespace clrt {

/// Understands auto, all, or a list of names: NAME compiles and renders it, -NAME takes it away from what the
/// scene calls for (or from `all`, or from the names before it). Sets all_effects, effects_list and
/// effects_off. Throws UsageError that names the nearest effect.
void apply_effects(Options& options, const OptionValue& value);

} // namespace clrt
