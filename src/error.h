// SPDX-License-Identifier: Apache-2.0
// The errors clrt reports. Only main() catches them; each type has its exit code (exit_code.h).
#pragma once

#include <stdexcept>
#include <string>

namespace clrt {

/// A wrong command line, options file or option value (exit 2).
/// The message says what was expected, what was found and what to do next.
class UsageError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Work that is worth nothing before it is done, ended by a signal (exit 128 and its number).
class StoppedError : public std::runtime_error {
public:
    StoppedError(int signal_number, const std::string& message)
        : std::runtime_error(message), signal_number(signal_number) {}
    const int signal_number;
};

/// A file that cannot be read, understood or written (exit 1). Positions print as "file:line: message".
class SceneError : public std::runtime_error {
public:
    /// `line` counts from 1; 0 means that the whole file is meant and prints no line.
    SceneError(const std::string& file, size_t line, const std::string& message)
        : std::runtime_error(file + (line ? ":" + std::to_string(line) : std::string()) + ": " + message) {}
};

/// No such device, a failed OpenCL call, or not enough device memory (exit 3).
/// For a failed call the message holds the call's text and the error's name.
class DeviceError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The device's compiler refused a kernel (exit 3). The message holds its log and the dumped source's path.
class KernelBuildError : public DeviceError {
    using DeviceError::DeviceError;
};

} // namespace clrt
