// SPDX-License-Identifier: Apache-2.0
// The values of --paths and --aov.
#pragma once

#include "app/option_values.h"

#include <string>

namespace clrt {

/// Reads a path expression. Throws UsageError that says where the value is from.
void check_paths(const OptionValue& value, const std::string& expression);

/// Understands none, names of layers, strategies[:K] and NAME=EXPR; adds to the layers that other occurrences
/// of the option name. Sets aovs, strategies and path_layers. Throws UsageError.
void apply_aov(Options& options, const OptionValue& value);

} // namespace clrt
