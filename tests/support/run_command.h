// SPDX-License-Identifier: Apache-2.0
// Runs a program as a user would and keeps what it said.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace clrt {

/// How a command ended. A command that was killed by a signal, a crash included, has exit code -1.
struct CommandResult {
    int exit_code = -1;
    int signal = 0;       ///< that killed it
    std::string out, err; ///< what it wrote to stdout and stderr
    double seconds = 0;
};

/// Circumstances of a command.
struct CommandSettings {
    std::string folder;                             ///< where it runs; empty: here
    std::map<std::string, std::string> environment; ///< replaces or adds variables
    std::vector<std::pair<double, int>> signals;    ///< seconds after the start, and which
    /// Their seconds count from when this file of the folder is there; empty: from the start.
    std::string signals_after_file;
    double limit_seconds = 120; ///< then it is killed
    std::map<int, size_t>
        limits; ///< of setrlimit(): RLIMIT_FSIZE for a full disk, RLIMIT_AS for little memory; bytes
};

/// Runs a command (its path, then its arguments) to its end.
CommandResult run_command(const std::vector<std::string>& command, const CommandSettings& settings = {});

} // namespace clrt
