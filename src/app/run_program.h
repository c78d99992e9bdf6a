// SPDX-License-Identifier: Apache-2.0
// Where the errors of clrt and its tools end.
#pragma once

#include <functional>

namespace clrt {

/// Runs a program and returns its exit code. What it throws becomes the line "NAME: error: ..." on stderr and
/// the error's exit code (exit_code.h). Standard output that cannot be written, to a full disk for example,
/// is an error as well.
int run_program(const char* name, const std::function<int()>& program);

} // namespace clrt
