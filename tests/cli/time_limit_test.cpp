// SPDX-License-Identifier: Apache-2.0
// What is promised in seconds and per second of a real render. Runs alone (tests.cmake).
#include "clrt_command.h"

#include <cmath>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <regex>

namespace clrt {

namespace {

/// A render of a second and a half that no number of samples ends.
const std::vector<std::string> TIMED_RUN = {"scene.obj", "-i",  "path",    "-r",    "64x48",
                                            "-t",        "1.5", "--stats", "s.json"};
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

    /// A render inside a closed room whose walls reflect nearly all light: a pass takes seconds and many
    /// launches. By one thread: seconds are what matters here, with a second thread they cost twice as much,
    /// and one keeps its pace while another program runs. Pilots of path reuse would choose by what the run
    /// may take, and two runs of other limits are compared.
    CommandResult run_slow(std::vector<std::string> arguments, const CommandSettings& settings = {}) {
        folder.write("room.mtl", "newmtl wall\nKd .98 .98 .98\nKe .02 .02 .02\n");
        folder.write("room.obj",
                     "mtllib room.mtl\nusemtl wall\nv -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\n"
                     "v 1 -1 1\nv 1 1 1\nv -1 1 1\nf 1 2 3 4\nf 8 7 6 5\nf 1 4 8 5\nf 2 6 7 3\nf 1 5 6 2\n"
                     "f 4 3 7 8\n");
        if (std::find(arguments.begin(), arguments.end(), "-r") == arguments.end())
            arguments.insert(arguments.end(), {"-r", "136x102"});
        arguments.insert(arguments.end(), {"room.obj", "-i", "path", "--path-reuse", "off", "--eye", "0,0,0",
                                           "--at", "0,0,-1", "--stats", "s.json", "--threads", "1"});
        const CommandResult result = clrt(arguments, settings);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        stats = nlohmann::json::parse(folder.read("s.json"));
        return result;
    }
    double seconds(const char* key) const { return stats["seconds"][key]; }

    /// The size at which a pass of the slow render takes about so many seconds on this machine.
    std::string size_of_pass(double wanted) {
        run_slow({"--spp", "1"});
        const double factor = std::sqrt(wanted / seconds("render"));
        return std::to_string(int(136 * factor)) + "x" + std::to_string(int(102 * factor));
    }

    nlohmann::json stats;
};

/// The number of the last match in a text; NaN: there is none.
double last_number(const std::string& text, const std::string& expression) {
    double number = std::nan("");
    const std::regex regex(expression);
    for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
        number = std::stod((*match)[1]);
    return number;
}

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
        R"(render  +\d+%  (\d+) spp  ([0-9.]+) s (?: ETA [^e]*)? error ([0-9.]+) %  ([0-9.]+) Mrays/s)");
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
    EXPECT_NEAR(std::stod(found[4]) / expected, 1, 0.15);
}

TEST_F(TimeLimit, TheLastProgressLineIsTheFinalState) {
    const std::string text =
        run({"scene.obj", "-i", "path", "-r", "256x192", "-t", "1.6", "--env", "0,0,0", "--point",
             "0,0,2,9,9,9", "--filter", "gaussian", "--stats", "s.json", "--progress", "on"});
    EXPECT_EQ(last_number(text, "([0-9]+) spp  "), stats["spp"]) << text;
    EXPECT_NEAR(last_number(text, "error ([0-9.]+) %"), 100 * stats["error"]["rel_rmse"].get<double>(),
                0.0501)
        << text;
    EXPECT_NE(text.find("render  100%"), std::string::npos) << text;
}

TEST_F(TimeLimit, RaysASecondAreKnownInTheFirstPass) {
    const CommandResult slow = run_slow({"--spp", "1", "--progress", "on", "-r", size_of_pass(4)});
    const double mrays = last_number(slow.err, "  ([0-9.]+) Mrays/s");
    EXPECT_NEAR(mrays / (1e-6 * stats["rays_per_second"].get<double>()), 1, 0.15) << slow.err;
}

// What a pass takes is measured first: the machine may be slow.
TEST_F(TimeLimit, APassThatCannotEndInTimeIsNotBegun) {
    run_slow({"--spp", "1", "-o", "one.exr"});
    const double pass = seconds("render");
    const CommandResult timed = run_slow({"--time", std::to_string(2.6 * pass), "-o", "timed.exr"});
    EXPECT_LE(seconds("render"), 2.6 * pass + seconds("longest_launch"));
    EXPECT_LE(seconds("longest_launch"), 2 * LONGEST_LAUNCH_SECONDS) << "launches are short";
    const unsigned spp = stats["spp"];
    EXPECT_TRUE(holds(timed.err, {"--time"}));
    run_slow({"--spp", std::to_string(spp), "-o", "counted.exr"});
    EXPECT_EQ(ReadPicture(folder.file("timed.exr")).values, ReadPicture(folder.file("counted.exr")).values);
}

TEST_F(TimeLimit, TheFirstPassIsFinishedAndSaidToOverrun) {
    const std::string size = size_of_pass(1);
    const CommandResult result = run_slow({"--time", "0.2", "-r", size});
    EXPECT_EQ(stats["spp"], 1);
    EXPECT_EQ(stats["stop"]["rule"], "time");
    EXPECT_NEAR(stats["stop"]["overrun_seconds"], seconds("render") - 0.2, 0.5);
    EXPECT_TRUE(holds(result.err, {"--time 0.2 s is over by ", "the first pass is always finished"}));
}

// The process is halted in the second group of launches, once the film of the first is there, until the time
// is over: the picture is that of the first. (An adaptive one begins with a sample of each replicate.)
TEST_F(TimeLimit, APassThatTheTimeInterruptsIsDropped) {
    for (const bool adaptive : {false, true}) {
        const unsigned group = adaptive ? 4 : 1;
        const std::vector<std::string> size = {"-r", adaptive ? "128x104" : "180x136"};
        const auto with = [&](std::vector<std::string> more) {
            more.insert(more.end(), size.begin(), size.end());
            if (adaptive)
                more.emplace_back("--adaptive");
            return more;
        };
        // The second group is begun if it takes less than 1.7 times what was measured, and its film is kept
        // if it takes more than .6 times that (passes.cpp): a machine that changes by more gets another try.
        std::string said;
        double dropped = 0;
        for (int attempt = 0; attempt < 6 && dropped == 0; ++attempt) {
            run_slow(with({"--spp", std::to_string(2 * group)}));
            const double pace = seconds("render") / 2;
            CommandSettings settings;
            settings.signals_after_file = "saved.film";
            settings.signals = {{0.2 * pace, SIGSTOP}, {2.7 * pace, SIGCONT}};
            std::filesystem::remove(folder.file("saved.film"));
            said = run_slow(with({"--time", std::to_string(3 * pace), "--checkpoint", "saved.film,0.01s",
                                  "-o", "timed.exr"}),
                            settings)
                       .err;
            dropped = stats["stop"]["dropped_seconds"];
        }
        EXPECT_GT(dropped, 0);
        EXPECT_TRUE(holds(said, {"an unfinished pass was dropped"}));
        EXPECT_EQ(stats["spp"], group);
        run_slow({"--spp", std::to_string(group), "-o", "counted.exr", size[0], size[1]});
        EXPECT_EQ(ReadPicture(folder.file("timed.exr")).values,
                  ReadPicture(folder.file("counted.exr")).values);
    }
}

// Nobody knows how long a pass takes that this run has not done yet.
TEST_F(TimeLimit, AResumedFilmSurvivesAPassThatIsDropped) {
    const std::string size = size_of_pass(2);
    run_slow({"--spp", "2", "--checkpoint", "two.film", "-o", "two.exr", "-r", size});
    const double longest = seconds("longest_launch");
    const CommandResult result = run_slow(
        {"--time", "0.1", "--resume", "two.film", "--checkpoint", "on.film", "-o", "on.exr", "-r", size});
    EXPECT_EQ(stats["spp"], 2);
    EXPECT_LE(seconds("render"), 0.1 + std::max(1.0, 2 * longest));
    EXPECT_TRUE(holds(result.err, {"an unfinished pass was dropped"}));
    EXPECT_EQ(ReadPicture(folder.file("on.exr")).values, ReadPicture(folder.file("two.exr")).values);
    run_slow({"--spp", "3", "--resume", "on.film", "-o", "three.exr", "-r", size});
    run_slow({"--spp", "3", "-o", "counted.exr", "-r", size});
    EXPECT_EQ(ReadPicture(folder.file("three.exr")).values, ReadPicture(folder.file("counted.exr")).values);
}

// Without a cache every program is compiled anew: half of the programs fit the time. Those of a ray tree are
// small.
TEST_F(TimeLimit, TheLedgerKeepsItsTime) {
    const std::string scene = CLRT_SCENES_FOLDER "/caustic/caustic.obj";
    CommandResult result;
    nlohmann::json bill;
    double compile = 0; // seconds a program
    const auto make_ledger = [&](double time) {
        result = clrt({scene, "-i", "whitted", "--ledger", "--time", std::to_string(time), "--no-cache", "-r",
                       "64x48", "--stats", "bill.json"});
        EXPECT_EQ(result.exit_code, 0) << result.err;
        bill = nlohmann::json::parse(folder.read("bill.json"));
        // The picture's program is compiled once more, and then beside each other one.
        compile = bill["compile_seconds"].get<double>() / (3 + 2 * double(bill["effects"].size()));
    };
    make_ledger(0.1); // no effect fits
    const double time = 9 * compile;
    make_ledger(time);
    EXPECT_LE(bill["seconds"], std::max(time, 3 * compile) + 2 * compile) << result.out;
    EXPECT_FALSE(bill["not_measured"].empty());
    EXPECT_TRUE(holds(result.err, {"warning", "the ledger of ", " effects takes ", " of them fit --time "}));
    EXPECT_TRUE(holds(result.out, {"Not measured, for want of time: "}));
}

} // namespace clrt
