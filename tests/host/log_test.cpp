// SPDX-License-Identifier: Apache-2.0
// What the log prints at each verbosity.
#include "app/log.h"

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

namespace clrt {

namespace {

/// Everything that is logged at a verbosity.
std::string logged(int verbosity) {
    testing::internal::CaptureStderr();
    start_log(verbosity);
    spdlog::debug("detail {}", 1);
    spdlog::info("notice {}%", 2);
    spdlog::warn("odd");
    spdlog::error("wrong");
    return testing::internal::GetCapturedStderr();
}

} // namespace

TEST(Log, PrefixesWarningsAndErrorsOnly) {
    EXPECT_EQ(logged(1), "detail 1\nnotice 2%\nclrt: warning: odd\nclrt: error: wrong\n");
}

TEST(Log, SaysLessAtLowerVerbosity) {
    EXPECT_EQ(logged(0), "notice 2%\nclrt: warning: odd\nclrt: error: wrong\n");
    EXPECT_EQ(logged(-1), "clrt: error: wrong\n");
}

} // namespace clrt
