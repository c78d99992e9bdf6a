// SPDX-License-Identifier: Apache-2.0
// When other processes compile what will be wanted, with scripts in the place of the compiler.
#include "device/compile_ahead.h"
#include "probes/scratch_folder.h"

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <string>
#include <thread>

using namespace clrt;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

namespace {

ProgramRequest program(const std::string& name) {
    ProgramRequest request;
    request.name = name;
    request.source = "kernel void k() {} /* " + std::string(200000, 'x') + " */"; // more than a stream holds
    return request;
}

class CompileAheadTest : public testing::Test {
protected:
    const ScratchFolder scratch_;

    /// The path of a script that keeps what it reads in "done", after this.
    std::string helper(const std::string& first) const {
        const std::string path = scratch_.file("helper");
        std::ofstream(path) << "#!/bin/sh\n"
                            << first << "\ncat > " << scratch_.file("read") << " && mv "
                            << scratch_.file("read") << " " << scratch_.file("done") << "\n";
        fs::permissions(path, fs::perms::owner_all);
        return path;
    }
    bool is_done() const { return fs::exists(scratch_.file("done")); }
    static bool comes_true(const std::function<bool()>& what) {
        for (int tries = 0; tries < 500 && !what(); ++tries)
            std::this_thread::sleep_for(20ms);
        return what();
    }
};

} // namespace

TEST_F(CompileAheadTest, AnotherProcessCompilesWhileSomebodyWaitsForAProgram) {
    CompileAhead ahead({}, helper(""), 1);
    ahead.expect(program("next"), "render");
    {
        const auto turn = ahead.take(program("first"));
        EXPECT_TRUE(comes_true([&] { return is_done(); }));
    }
    ahead.take(program("next"));
    EXPECT_EQ(ahead.started(), 1u);
    EXPECT_GT(fs::file_size(scratch_.file("done")), program("next").source.size());
}

TEST_F(CompileAheadTest, WhoWantsAProgramWaitsForTheProcessThatCompilesIt) {
    CompileAhead ahead({}, helper("sleep 1"), 1);
    ahead.expect(program("next"), "render");
    {
        const auto turn = ahead.take(program("first"));
        EXPECT_TRUE(comes_true([&] { return ahead.started() == 1; }));
    }
    EXPECT_FALSE(is_done());
    ahead.take(program("next"));
    EXPECT_TRUE(is_done());
}

// Who waits for a process leaves a processor idle.
TEST_F(CompileAheadTest, AnotherProcessRunsInThePlaceOfAThreadThatWaits) {
    CompileAhead ahead({}, helper("sleep 2"), 1);
    ahead.expect(program("other"), "render");
    ahead.expect(program("next"), "render");
    ahead.expect(program("next"), "render"); // as it is already
    {
        const auto turn = ahead.take(program("first"));
        EXPECT_TRUE(comes_true([&] { return ahead.started() == 1; }));
        std::this_thread::sleep_for(200ms);
        EXPECT_EQ(ahead.started(), 1u);
    }
    ahead.take(program("next")); // expected last, begun first
    EXPECT_TRUE(is_done());
    EXPECT_EQ(ahead.started(), 2u);
}

TEST_F(CompileAheadTest, NothingIsStartedWhereProgramsAreCached) {
    CompileAhead ahead({}, helper(""), 1);
    ahead.expect(program("next"), "render");
    for (int i = 0; i < 10; ++i) {
        const auto turn = ahead.take(program("first"));
        std::this_thread::sleep_for(60ms);
    }
    EXPECT_EQ(ahead.started(), 0u);
}

TEST_F(CompileAheadTest, WhatIsTakenAlreadyIsNotStarted) {
    CompileAhead ahead({}, helper(""), 2);
    ahead.expect(program("first"), "render");
    const auto turn = ahead.take(program("first"));
    std::this_thread::sleep_for(800ms);
    EXPECT_EQ(ahead.started(), 0u);
}

TEST_F(CompileAheadTest, WhatIsNotWantedAnyMoreIsEnded) {
    CompileAhead ahead({}, helper("exec sleep 100"), 1);
    ahead.expect(program("next"), "render");
    ahead.expect(program("later"), "render");
    {
        const auto turn = ahead.take(program("first"));
        EXPECT_TRUE(comes_true([&] { return ahead.started() == 1; }));
    }
    ahead.forget_all_but(program("first"));
    const auto start = std::chrono::steady_clock::now();
    ahead.take(program("next"));
    ahead.take(program("later"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, 50s);
    EXPECT_EQ(ahead.started(), 1u);
}

TEST_F(CompileAheadTest, TheEndOfTheRunEndsProcesses) {
    const auto start = std::chrono::steady_clock::now();
    {
        CompileAhead ahead({}, helper("exec sleep 100"), 1);
        ahead.expect(program("next"), "render");
        const auto turn = ahead.take(program("first"));
        EXPECT_TRUE(comes_true([&] { return ahead.started() == 1; }));
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, 50s);
}

TEST_F(CompileAheadTest, AHelperThatIsNotThereIsNoHindrance) {
    CompileAhead ahead({}, scratch_.file("nowhere"), 1);
    ahead.expect(program("next"), "render");
    const auto turn = ahead.take(program("first"));
    std::this_thread::sleep_for(600ms);
    ahead.take(program("next"));
    EXPECT_EQ(ahead.started(), 0u);
}
