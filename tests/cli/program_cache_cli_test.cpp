// SPDX-License-Identifier: Apache-2.0
// The cache of compiled programs as a user meets it.
#include "clrt_command.h"
#include "support/instruction_sets.h"

#include <fstream>
#include <thread>

namespace clrt {

namespace {

class ProgramCacheCommand : public ClrtCommand {
protected:
    /// The words of a command that renders scene.obj into a picture with the cache on.
    static std::vector<std::string> cached(const std::string& picture) {
        std::vector<std::string> words = quick({"scene.obj", "--cache", "on", "--cache-dir", "cache", "-v"});
        words.insert(words.end(), {"-o", picture});
        return words;
    }
    /// PoCL's cache in a new folder: it compiles.
    CommandSettings cold_cache(const std::string& name) const {
        CommandSettings settings;
        settings.environment["POCL_CACHE_DIR"] = folder.file(name);
        std::filesystem::create_directory(folder.file(name));
        return settings;
    }
    size_t entries() const {
        size_t count = 0;
        for (const auto& file : std::filesystem::directory_iterator(folder.file("cache")))
            count += file.path().extension() == ".clrtprogram";
        return count;
    }
};

} // namespace

TEST_F(ProgramCacheCommand, TwoRunsAtOnceShareOneEntryAndTheNextOneUsesIt) {
    write_square("scene");
    std::string words;
    for (const std::string& word : cached(""))
        words += word.empty() ? "" : " " + word;
    CommandSettings settings;
    settings.folder = path();
    settings.environment["CLRT_DEVICE"] = test_device_name();
    const std::string clrt_command = std::string(CLRT_EXECUTABLE) + words;
    const CommandResult both = run_command({"/bin/sh", "-c",
                                            clrt_command + " a.ppm & first=$!; " + clrt_command +
                                                " b.ppm; second=$?; wait $first && exit $second"},
                                           settings);
    EXPECT_EQ(both.exit_code, 0) << both.err;
    EXPECT_EQ(folder.read("a.ppm"), folder.read("b.ppm"));
    EXPECT_EQ(entries(), 1u);
    const auto third = clrt(cached("c.ppm"));
    EXPECT_EQ(third.exit_code, 0);
    EXPECT_EQ(folder.read("c.ppm"), folder.read("a.ppm"));
    EXPECT_EQ(entries(), 1u);
}

TEST_F(ProgramCacheCommand, ADamagedEntryIsAMissAndNoErrorAndOffKeepsNothing) {
    write_square("scene");
    EXPECT_EQ(clrt(cached("a.ppm")).exit_code, 0);
    for (const auto& file : std::filesystem::directory_iterator(folder.file("cache")))
        std::filesystem::resize_file(file.path(), 1000);
    const auto again = clrt(cached("b.ppm"));
    EXPECT_EQ(again.exit_code, 0);
    EXPECT_TRUE(holds(again.err, {"is damaged or not ours; it will be replaced"}));
    EXPECT_EQ(folder.read("a.ppm"), folder.read("b.ppm"));
    EXPECT_FALSE(holds(clrt(cached("c.ppm")).err, {"is damaged"}));
    EXPECT_EQ(clrt(quick({"scene.obj", "--no-cache", "--cache-dir", "none"})).exit_code, 0);
    EXPECT_FALSE(exists("none"));
}

TEST_F(ProgramCacheCommand, OffCompilesWhereNoOtherRunTakesProgramsAway) {
    write_square("scene");
    CommandSettings settings;
    settings.environment["XDG_CACHE_HOME"] = folder.file("home");
    settings.environment["TMPDIR"] = folder.file("temporary");
    for (const char* name : {"home", "temporary"})
        std::filesystem::create_directory(folder.file(name));
    EXPECT_EQ(clrt(quick({"scene.obj", "--no-cache"}), settings).exit_code, 0);
    EXPECT_FALSE(exists("home/pocl/uncached"));
    EXPECT_TRUE(std::filesystem::is_empty(folder.file("temporary"))) << "nothing is left behind";
}

// A room long enough for pilots, of which several programs are wanted.
TEST_F(ProgramCacheCommand, WhatWillBeWantedIsCompiledAheadWhereNothingIsCached) {
    write_square("scene");
    std::vector<std::string> room = {"scene.obj", "-s", "64", "-r", "192x144", "-v"};
    room.insert(room.end(), {"-o", "a.ppm"});
    const CommandSettings cold = cold_cache("pocl");
    const CommandResult first = clrt(room, cold);
    EXPECT_EQ(first.exit_code, 0) << first.err;
    const CommandResult second = clrt(room, cold);
    EXPECT_EQ(second.exit_code, 0) << second.err;
    if (test_device_name() == "pocl" && std::thread::hardware_concurrency() > 1) {
        EXPECT_TRUE(holds(first.err, {"was compiled ahead in"})) << first.err;
    }
    const std::string picture = folder.read("a.ppm");
    room.emplace_back("--no-cache");
    EXPECT_FALSE(holds(clrt(room).err, {"compiled ahead"}));
    EXPECT_EQ(folder.read("a.ppm"), picture);
}

// Compilers count their warnings on stderr whoever asked for the program. On processors without 512-bit or
// 256-bit vectors kernels in double, and without the latter all, once had dozens.
TEST_F(ProgramCacheCommand, ACompilerSaysNothingOfItsOwnOnAnyInstructionSet) {
    write_square("scene");
    const auto expect_silence = [&](const std::string& set, const std::string& precision) {
        CommandSettings cold = cold_cache("pocl-" + set + precision);
        cold.environment[InstructionSet::VARIABLE] = set;
        const auto result = clrt(quick({"scene.obj", "-q", "--precision", precision}), cold);
        EXPECT_EQ(result.exit_code, 0) << set << " " << precision;
        EXPECT_EQ(result.err, "") << set << " " << precision;
    };
    for (const InstructionSet& set : instruction_sets())
        expect_silence(set.name, "double");
    if (!instruction_sets().empty()) // the oldest: in single precision newer ones hold all vectors
        expect_silence(instruction_sets().front().name, "single");
}

// Of kernels that somebody changes, PoCL says "1 warning generated." and not which.
TEST_F(ProgramCacheCommand, WhatTheCompilerSaysAboutOnesOwnKernelsIsInTheVerboseLog) {
    write_square("scene");
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    std::ofstream(folder.file("kernels/integrators/raycast.cl"), std::ios::app)
        << "\n#warning an_unfinished_idea\n";
    const auto result = clrt(quick({"scene.obj", "--kernels", "kernels", "-v"}), cold_cache("pocl"));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.err, {"the compiler about the program raycast", "an_unfinished_idea"}));
}

} // namespace clrt
