// SPDX-License-Identifier: Apache-2.0
// Runs before the initialisers of the shared libraries, which abort where the limit of the address space
// leaves them too little. Linked into each program that reads or writes pictures.
#include "device/address_space.h"
#include "exit_code.h"

#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace clrt {

namespace {

constexpr char MESSAGE[] =
    "clrt: error: not enough memory to start: expected a higher limit of the address space "
    "(ulimit -v), or none\n";

/// A standard stream that is closed stays unusable: the next file that is opened would get its number, and
/// be written by what is meant for the stream. What is logged goes nowhere.
void reserve_standard_streams() {
    constexpr int USELESS[] = {O_WRONLY, O_RDONLY, O_WRONLY}; // of stdin, stdout, stderr
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream)
        if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", USELESS[stream]) != stream)
            _exit(EXIT_SCENE);
}

/// No library is ready yet: system calls only.
void check_start() {
    reserve_standard_streams();
    if (has_address_space(START_BYTES))
        return;
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, MESSAGE, std::strlen(MESSAGE));
    _exit(EXIT_SCENE);
}

/// System V ABI, section 5.4: functions of .preinit_array run before all other initialisers.
__attribute__((section(".preinit_array"), used)) void (*const run_check_start)() = check_start;

} // namespace

} // namespace clrt
