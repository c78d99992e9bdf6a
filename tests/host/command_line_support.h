// SPDX-License-Identifier: Apache-2.0
// Parsing for the tests of the command line.
#pragma once

#include "app/command_line.h"
#include "error.h"

#include <string>
#include <vector>

namespace clrt {

/// Parses "clrt" and the arguments.
inline CommandLine parse_all(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv = {"clrt"};
    for (const std::string& argument : arguments)
        argv.push_back(argument.c_str());
    return parse_command_line(static_cast<int>(argv.size()), argv.data());
}

/// Parses the arguments and a scene.
inline Options parse(std::vector<std::string> arguments) {
    arguments.emplace_back("scene.obj");
    return parse_all(arguments).options;
}

/// The message of the UsageError that parsing ends with.
inline std::string refusal(const std::vector<std::string>& arguments) {
    try {
        parse_all(arguments);
    } catch (const UsageError& error) {
        return error.what();
    }
    return "accepted";
}

} // namespace clrt
