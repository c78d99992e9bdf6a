// SPDX-License-Identifier: Apache-2.0
// The log goes to stderr; results and statistics go to stdout.
#pragma once

#include <string>

namespace clrt {

/// Sets the log up: -1 errors only (-q), 0 notices and warnings, 1 everything (-v). Messages are printed with
/// spdlog::info / warn / debug as plain lines with a prefix only for warnings and errors,
/// which begins with the program's name.
/// A progress line that is open is ended first (Progress::finish), by whoever logs.
void start_log(int verbosity, const std::string& program = "clrt");

} // namespace clrt
