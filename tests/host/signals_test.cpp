// SPDX-License-Identifier: Apache-2.0
// The first signal asks, the second ends.
#include "console/signals.h"

#include <csignal>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// Whether a request counts as the first signal, and another as none.
[[noreturn]] void request_then_raise() {
    catch_stop_signals();
    request_stop();
    request_stop();
    if (stop_signal() != SIGINT)
        _exit(1);
    std::raise(SIGTERM);
    _exit(2);
}

/// Catches two signals; the process must end at the second one.
[[noreturn]] void raise_both(int first, int second, bool is_quiet = false) {
    catch_stop_signals(is_quiet);
    std::raise(first);
    if (stop_signal() != first)
        _exit(1);
    std::raise(second);
    _exit(2);
}

} // namespace

TEST(Signals, SecondSignalEndsTheProcess) {
    testing::FLAGS_gtest_death_test_style = "threadsafe"; // starts afresh: a library may have threads
    EXPECT_EXIT(raise_both(SIGINT, SIGINT), testing::ExitedWithCode(130), "");
    EXPECT_EXIT(raise_both(SIGINT, SIGTERM), testing::ExitedWithCode(143), "");
    EXPECT_EXIT(raise_both(SIGTERM, SIGINT), testing::ExitedWithCode(130), "");
}

TEST(Signals, TheFirstIsAnsweredWhereSomebodyReads) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(raise_both(SIGINT, SIGINT), testing::ExitedWithCode(130),
                "clrt: stopping.*; a second signal stops at once");
    EXPECT_EXIT(raise_both(SIGTERM, SIGTERM, true), testing::ExitedWithCode(143), "^$");
}

TEST(Signals, ARequestIsAFirstSignal) {
    testing::FLAGS_gtest_death_test_style = "threadsafe";
    EXPECT_EXIT(request_then_raise(), testing::ExitedWithCode(143), "");
}

TEST(Signals, NoneHasComeAtFirst) {
    EXPECT_EQ(stop_signal(), 0);
}

} // namespace clrt
