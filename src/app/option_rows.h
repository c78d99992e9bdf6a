// SPDX-License-Identifier: Apache-2.0
// The rows of the option table, a file a group of --help.
#pragma once

#include "app/option_table.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace clrt {

constexpr std::int64_t LARGEST_U32 = std::numeric_limits<std::uint32_t>::max();

constexpr Repeat REPEATABLE = Repeat::YES;
constexpr InFile COMMAND_LINE_ONLY = InFile::NO;

std::vector<OptionSpec> work_options();
std::vector<OptionSpec> picture_options();
std::vector<OptionSpec> camera_options();
std::vector<OptionSpec> light_options();
std::vector<OptionSpec> promise_options();
std::vector<OptionSpec> run_options();

} // namespace clrt
