// SPDX-License-Identifier: Apache-2.0
// What a first start costs: processor seconds of the whole command. Neighbours on the same cores make the
// same command take up to 1.6 times as many, so that what counts is the least of a few tries.
#include "clrt_command.h"

#include <algorithm>
#include <cmath>
#include <sys/resource.h>

namespace clrt {

namespace {

/// What the program of all effects may cost, and that of a matte square.
constexpr double FULL_SECONDS = 8, NEEDED_SECONDS = 3;
/// On slower processors, as multiples of what clang takes for a text that has nothing to do with ours: 5.4 s
/// of an EPYC (Zen 3, 2.45 GHz), where they are 11.4 to 12.4 s and 3.7 s.
constexpr double FULL_SHARE = 2.4, NEEDED_SHARE = 0.8;
const char* const OTHER_TEXT =
    "#include <regex>\n"
    "bool f(const char* s) { return std::regex_match(s, std::regex(\"a(b|c)*\")); }\n";

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
    /// The least of up to five tries; those after one below `enough` are saved.
    double least_seconds_of(const std::vector<std::string>& arguments, double enough) const {
        double least = seconds_of(arguments);
        for (int again = 0; again < 4 && is_pocl() && least >= enough; ++again)
            least = std::min(least, seconds_of(arguments));
        return least;
    }
    /// The least of three tries at OTHER_TEXT.
    double other_seconds() const {
        const std::string file = folder.write("other.cpp", OTHER_TEXT);
        double least = HUGE_VAL;
        for (int again = 0; again < 3; ++again) {
            const double before = seconds_of_commands();
            EXPECT_EQ(run_command({CLRT_CLANG, "-std=c++17", "-O2", "-c", "-o", "/dev/null", file}).exit_code,
                      0);
            least = std::min(least, seconds_of_commands() - before);
        }
        return least;
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
    const double full_seconds = least_seconds_of(all, FULL_SECONDS);
    const double needed_seconds = least_seconds_of(needed, NEEDED_SECONDS);
    RecordProperty("full", std::to_string(full_seconds));
    RecordProperty("needed", std::to_string(needed_seconds));
    if (is_pocl()) {
        const bool is_quick = full_seconds < FULL_SECONDS && needed_seconds < NEEDED_SECONDS;
        const double other = is_quick ? 0 : other_seconds();
        EXPECT_LT(full_seconds, std::max(FULL_SECONDS, FULL_SHARE * other));
        EXPECT_LT(needed_seconds, std::max(NEEDED_SECONDS, NEEDED_SHARE * other));
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
