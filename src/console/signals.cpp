// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM: the handler only sets a flag, and ends the process when it is set already.
#include "console/signals.h"

#include <atomic>
#include <csignal>
#include <unistd.h>

namespace clrt {

namespace {

/// A handler can reach nothing but a global, and threads read it.
std::atomic<int> received_signal{0};
static_assert(std::atomic<int>::is_always_lock_free, "a handler must not wait for a lock");

extern "C" void on_stop_signal(int number) {
    int none = 0;
    if (!received_signal.compare_exchange_strong(none, number))
        _exit(128 + number);
}

} // namespace

void catch_stop_signals() {
    struct sigaction action {};
    action.sa_handler = on_stop_signal;
    action.sa_flags = SA_RESTART; // reading and writing files goes on
    sigemptyset(&action.sa_mask);
    // While one handler runs the other signal waits, so that no two handlers see the flag unset.
    sigaddset(&action.sa_mask, SIGINT);
    sigaddset(&action.sa_mask, SIGTERM);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    std::signal(SIGXFSZ, SIG_IGN);
}

void report_broken_pipes() {
    std::signal(SIGPIPE, SIG_IGN);
}

int stop_signal() {
    return received_signal;
}

void request_stop() {
    int none = 0;
    received_signal.compare_exchange_strong(none, SIGINT);
}

} // namespace clrt
