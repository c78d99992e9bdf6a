// SPDX-License-Identifier: Apache-2.0
// argv and the options file -> Options.
#pragma once

#include "options/options.h"

#include <optional>
#include <string>

namespace clrt {

/// What a command line asks for: options to run with, or text to print and exit 0 (help, version).
struct CommandLine {
    Options options;
    std::optional<std::string> print; ///< text of --help or --version
};

/// Parses argv and the options file STEM.clrt beside STEM.obj (flags win over the file). Throws UsageError
/// for unknown options (naming the nearest), bad values (naming option, value and what was expected), and
/// combinations that make no sense; for a line of the options file the message starts with "file:line: ".
/// Throws SceneError when the folder of an output is missing, so that no render is in vain.
CommandLine parse_command_line(int argc, const char* const* argv);

} // namespace clrt
