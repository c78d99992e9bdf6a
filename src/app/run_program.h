// SPDX-License-Identifier: Apache-2.0
// Where the errors of clrt and its tools end.
#pragma once

#include <functional>

namespace clrt {

/// Runs a program and returns its exit code. What it throws becomes the line "NAME: error: ..." on stderr and
/// the error's exit code (exit_code.h).
int run_program(const char* name, const std::function<int()>& program);

} // namespace clrt
