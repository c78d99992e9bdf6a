// SPDX-License-Identifier: Apache-2.0
// What a first start costs: processor seconds of the whole command, which a busy machine does not change
// much.
#include "clrt_command.h"

#include <sys/resource.h>

namespace clrt {

namespace {

/// Seconds on all processors that ended commands took.
double seconds_of_commands() {
    rusage usage{};
    getrusage(RUSAGE_CHILDREN, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

class CompileTime : public ClrtCommand {
protected:
    double seconds_of(const std::vector<std::string>& arguments) const {
        const double before = seconds_of_commands();
        EXPECT_EQ(clrt(arguments).exit_code, 0);
        return seconds_of_commands() - before;
    }
    /// Times are promised for PoCL; other devices only have to work.
    static bool is_pocl() { return test_device_name() == "pocl"; }
};

} // namespace

TEST_F(CompileTime, APathProgramIsCompiledInSeconds) {
    write_square("scene");
    const std::vector<std::string> path = {"scene.obj", "-s", "1", "-r", "16x12", "--no-cache", "--effects"};
    std::vector<std::string> all = path, needed = path;
    all.emplace_back("all");
    needed.emplace_back("auto");
    const double full_seconds = seconds_of(all), needed_seconds = seconds_of(needed);
    RecordProperty("full", std::to_string(full_seconds));
    RecordProperty("needed", std::to_string(needed_seconds));
    if (is_pocl()) {
        EXPECT_LT(full_seconds, 8);
        EXPECT_LT(needed_seconds, 3);
    }
}

TEST_F(CompileTime, ASecondStartTakesTheProgramFromTheDriversCache) {
    write_square("scene");
    CommandSettings settings;
    settings.environment["POCL_CACHE_DIR"] = folder.file("cache");
    const std::vector<std::string> path = {"scene.obj", "-s", "1", "-r", "16x12"};
    const double start = seconds_of_commands();
    EXPECT_EQ(clrt(path, settings).exit_code, 0);
    const double cold = seconds_of_commands();
    EXPECT_EQ(clrt(path, settings).exit_code, 0);
    const double warm = seconds_of_commands() - cold;
    RecordProperty("cold", std::to_string(cold - start));
    RecordProperty("warm", std::to_string(warm));
    if (is_pocl()) {
        EXPECT_LT(warm, 0.5 * (cold - start));
    }
}

} // namespace clrt
