// SPDX-License-Identifier: Apache-2.0
// What the terminal is like (POSIX).
#include "console/terminal.h"

#include <sys/ioctl.h>

namespace clrt {

size_t terminal_columns(int descriptor, size_t otherwise) {
    winsize size{};
    return ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : otherwise;
}

} // namespace clrt
