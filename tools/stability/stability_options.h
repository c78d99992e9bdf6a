// SPDX-License-Identifier: Apache-2.0
// The command line of clrt-stability.
#pragma once

#include "stability/stability_case.h"

#include <optional>
#include <string>
#include <vector>

namespace clrt {

struct StabilityOptions {
    std::string device; ///< as for clrt; empty: CLRT_DEVICE, else the first GPU, else the CPU
    Tier tier = Tier::QUICK;
    std::vector<std::string> cases; ///< beginnings of ids; empty: all
    bool list = false;
    bool run_cases = true, costs = true;
    std::optional<int> rounds; ///< of every timing; none: CHOICE_ROUNDS and PICTURE_ROUNDS
    std::string page_path, stats_path, kernels_folder; ///< empty: none
    std::vector<std::string> command;                  ///< argv as given
    std::optional<std::string> print;                  ///< text of --help or --version, to print and exit
};

/// Parses argv. Throws UsageError.
StabilityOptions parse_stability_options(int argc, const char* const* argv);

/// "quick", "night", "long".
const char* tier_name(Tier tier);

} // namespace clrt
