// SPDX-License-Identifier: Apache-2.0
// Options that are fine one by one and make no sense together.
#pragma once

#include "options/options.h"

namespace clrt {

/// Throws UsageError that names the options, their values and what was expected.
void check_combinations(const Options& options);

} // namespace clrt
