// SPDX-License-Identifier: Apache-2.0
// Runs before the initialisers of the shared libraries. Linked into each program that reads or writes
// pictures.
#include "exit_code.h"

#include <fcntl.h>
#include <unistd.h>

namespace clrt {

namespace {

/// A standard stream that is closed stays unusable: the next file that is opened would get its number, and
/// be written by what is meant for the stream. What is logged goes nowhere. No library is ready yet: system
/// calls only.
void reserve_standard_streams() {
    constexpr int USELESS[] = {O_WRONLY, O_RDONLY, O_WRONLY}; // of stdin, stdout, stderr
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", USELESS[stream]) != stream)
            _exit(EXIT_SCENE);
}

/// System V ABI, section 5.4: functions of .preinit_array run before all other initialisers.
__attribute__((section(".preinit_array"), used)) void (*const run_before_all)() = reserve_standard_streams;

} // namespace

} // namespace clrt
