// SPDX-License-Identifier: Apache-2.0
// argv -> options with their values, and the rest. Tokens only; their meaning is the option table's.
#pragma once

#include "app/option_table.h"

#include <string>
#include <vector>

namespace clrt {

/// A command line, split but not yet understood.
struct Arguments {
    std::vector<GivenOption> options; ///< in the table's order; occurrences of one option in their own order
    std::vector<std::string> scenes;  ///< what is neither an option nor a value
};

/// Splits argv the GNU way: --name value, --name=value, -n value, -nvalue, -qv, and "--" before names that
/// start with a dash. A value may start with a dash (--eye -1,2,3). Throws UsageError for unknown options and
/// missing values; with --help or --version among the options nothing is refused.
Arguments split_arguments(int argc, const char* const* argv);

} // namespace clrt
