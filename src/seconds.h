// SPDX-License-Identifier: Apache-2.0
// Seconds by the clock on the wall, and of the processor.
#pragma once

#include <chrono>
#include <ctime>

namespace clrt {

inline double seconds_between(std::chrono::steady_clock::time_point from,
                              std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return seconds_between(start, std::chrono::steady_clock::now());
}

/// Seconds that all threads of this process were at work so far.
inline double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

} // namespace clrt
