// SPDX-License-Identifier: Apache-2.0
// What the terminal is like.
#pragma once

#include <cstddef>

namespace clrt {

/// Columns of the terminal behind a file descriptor; `otherwise` if it is none or does not tell.
size_t terminal_columns(int descriptor, size_t otherwise);

} // namespace clrt
