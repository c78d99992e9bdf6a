// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM: the handler only sets a flag, and ends the process when it is set already.
#include "console/signals.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>
#include <unistd.h>

namespace clrt {

namespace {

/// A handler can reach nothing but a global, and threads read it.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a handler must not wait for a lock");

/// What the first signal is answered by: in a terminal below "^C" and the progress line. Set before handlers
/// are.
std::string_view answer;

extern "C" void on_stop_signal(int number) {
    int none = 0;
    if (!received_signal.compare_exchange_strong(none, number))
        _exit(128 + number);
    const int error = errno;
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, answer.data(), answer.size());
    errno = error;
}

} // namespace

void catch_stop_signals(bool is_quiet) {
    const std::string_view text =
        "\nclrt: stopping, as soon as a whole pass can be saved; a second signal stops at once\n";
    answer = is_quiet ? "" : isatty(STDERR_FILENO) ? text : text.substr(1);
    struct sigaction action {};
    action.sa_handler = on_stop_signal;
    action.sa_flags = SA_RESTART; // reading and writing files goes on
    sigemptyset(&action.sa_mask);
    // While one handler runs the other signal waits, so that no two handlers see the flag unset.
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

void report_failed_writes() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

int stop_signal() {
    return received_signal;
}

void request_stop() {
    int none = 0;
    received_signal.compare_exchange_strong(none, SIGINT);
}

} // namespace clrt
