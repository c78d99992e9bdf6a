// SPDX-License-Identifier: Apache-2.0
// What is promised in seconds and per second of a real render. Runs alone (tests.cmake).
#include "clrt_command.h"

#include <nlohmann/json.hpp>
#include <regex>

namespace clrt {

namespace {

/// A render of a second and a half that no number of samples ends.
const std::vector<std::string> TIMED_RUN = {"scene.obj", "-r", "64x48", "-t", "1.5", "--stats", "s.json"};
/// A launch aims at half a second; the last one may begin just before the time is up and take twice as long
/// as it aimed at.
constexpr double LONGEST_LAUNCH_SECONDS = 1;

class TimeLimit : public ClrtCommand {
protected:
    TimeLimit() { write_square("scene"); }
    /// Runs it and gives what it wrote on stderr.
    std::string run(std::vector<std::string> arguments) {
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        stats = nlohmann::json::parse(folder.read("s.json"));
        return result.err;
    }

    nlohmann::json stats;
};

} // namespace

TEST_F(TimeLimit, EndsTheRenderInTime) {
    run(TIMED_RUN);
    const double seconds = stats["seconds"]["render"];
    EXPECT_GT(seconds, 1.5 - LONGEST_LAUNCH_SECONDS);
    EXPECT_LT(seconds, 1.5 + LONGEST_LAUNCH_SECONDS) << "overrun by at most one launch";
    EXPECT_GT(stats["spp"], 64) << "not bounded by the default number of samples";
}

TEST_F(TimeLimit, TheProgressLineSaysWhatIsKnown) {
    std::vector<std::string> arguments = TIMED_RUN;
    arguments.insert(arguments.end(), {"--progress", "on"});
    const std::string text = run(arguments);
    // The line that a render of more than a second leaves behind.
    const std::regex line(
        R"(render  +\d+%  (\d+) spp  ([0-9.]+) s (?: ETA [^M]*)? ([0-9.]+) Mrays/s  error about ([0-9.]+) %)");
    std::smatch found;
    ASSERT_TRUE(std::regex_search(text, found, line)) << text;
    EXPECT_EQ(std::stoull(found[1]), stats["spp"]);
    EXPECT_NEAR(std::stod(found[2]) / stats["seconds"]["render"].get<double>(), 1, 0.25);
    // The rays of a sample are those of the last measurement, which had an eighth of all samples or more: the
    // same ones but for noise of a percent. The rest is for what the statistics count into the time after the
    // last launch.
    double rays = 0;
    for (const char* kind : {"primary", "secondary", "shadow"})
        rays += stats["rays"][kind].get<double>();
    const double expected = 1e-6 * rays / stats["seconds"]["render"].get<double>();
    EXPECT_NEAR(std::stod(found[3]) / expected, 1, 0.15);
}

} // namespace clrt
