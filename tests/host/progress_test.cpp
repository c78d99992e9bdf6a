// SPDX-License-Identifier: Apache-2.0
// The progress line: its text, and when it appears.
#include "console/progress.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace clrt {

namespace {

using std::chrono::milliseconds;

ProgressState at(const std::string& phase, double fraction, std::uint64_t spp = 0,
                 double rays_per_second = -1) {
    ProgressState state;
    state.phase = phase;
    state.fraction = fraction;
    state.spp = spp;
    state.rays_per_second = rays_per_second;
    return state;
}

/// A clock that stands still until it is moved on.
class TestClock {
public:
    void pass(milliseconds time) { now_ += time; }
    /// For Progress; the clock must outlive it.
    std::function<Progress::Clock::time_point()> reader() {
        return [this] { return now_; };
    }

private:
    Progress::Clock::time_point now_ = Progress::Clock::now();
};

/// Makes stderr a terminal of so many columns until end().
class Terminal {
public:
    explicit Terminal(unsigned short columns)
        : master_(posix_openpt(O_RDWR | O_NOCTTY)), stderr_(dup(STDERR_FILENO)) {
        EXPECT_TRUE(master_ >= 0 && grantpt(master_) == 0 && unlockpt(master_) == 0);
        const int slave = open(ptsname(master_), O_RDWR | O_NOCTTY);
        winsize size{};
        size.ws_col = columns;
        ioctl(slave, TIOCSWINSZ, &size);
        dup2(slave, STDERR_FILENO);
        close(slave);
        fcntl(master_, F_SETFL, O_NONBLOCK);
    }
    ~Terminal() {
        close(master_);
        close(stderr_);
    }

    /// Gives stderr back and returns what was printed.
    std::string end() {
        fflush(stderr);
        dup2(stderr_, STDERR_FILENO);
        std::string text;
        char part[4096];
        for (ssize_t count; (count = read(master_, part, sizeof part)) > 0;)
            text.append(part, static_cast<size_t>(count));
        return text;
    }

private:
    int master_, stderr_;
};

} // namespace

TEST(ProgressLine, SaysWhatIsKnown) {
    EXPECT_EQ(progress_line(at("load", -1), 0.04), "load    0.0 s");
    EXPECT_EQ(progress_line(at("render", 0.25, 16, 12.34e6), 10),
              "render   25%  16 spp  10.0 s  ETA 30.0 s  12.3 Mrays/s");
    EXPECT_EQ(progress_line(at("render", 1, 64), 75), "render  100%  64 spp  1 m 15 s");
    EXPECT_EQ(progress_line(at("bvh", 0), 1), "bvh       0%  1.0 s");
}

TEST(ProgressLine, ALongPhaseIsFollowedByABlank) {
    EXPECT_EQ(progress_line(at("textures", -1), 1), "textures 1.0 s");
    EXPECT_EQ(progress_line(at("textures", 1), 1), "textures 100%  1.0 s");
}

TEST(ProgressLine, AnErrorIsAboutRightUntilItIsMeasured) {
    ProgressState state = at("render", 1, 64);
    state.error = 0.0801;
    EXPECT_EQ(progress_line(state, 7), "render  100%  64 spp  7.0 s  error about 8.0 %");
    state.error_is_measured = true;
    EXPECT_EQ(progress_line(state, 7), "render  100%  64 spp  7.0 s  error 8.0 %");
}

TEST(ProgressLine, SaysWhenTheErrorThatIsAskedForComes) {
    ProgressState state = at("render", 0.25, 64, 12.34e6);
    state.error = 0.042;
    state.target = ProgressTarget{0.02, 30, 24, 47};
    EXPECT_EQ(
        progress_line(state, 10),
        "render   25%  64 spp  10.0 s  error about 4.2 % -> 2 % in 30 s (80 %: 24 s to 47 s)  12.3 Mrays/s");
    state.target->high = 75;
    EXPECT_NE(progress_line(state, 10).find("(80 %: 24 s to 1 m 15 s)"), std::string::npos);
    state.target->high = -1;
    EXPECT_NE(progress_line(state, 10).find("(80 %: 24 s or more)"), std::string::npos)
        << "nobody can name it";
    state.fraction = 0.5; // --spp or --time comes first
    EXPECT_NE(progress_line(state, 10).find("  10.0 s  ETA 10.0 s  error about"), std::string::npos);
}

TEST(ProgressLine, NoNumberIsCut) {
    ProgressState state = at("render", 0.25, 64, 12.34e6);
    state.error = 0.042;
    state.target = ProgressTarget{0.02, 30, 24, 47};
    EXPECT_EQ(progress_line(state, 10, 40), "render   25%  64 spp  10.0 s");
    EXPECT_EQ(progress_line(state, 10, 84),
              "render   25%  64 spp  10.0 s  error about 4.2 % -> 2 % in 30 s (80 %: 24 s to 47 s)");
    EXPECT_EQ(progress_line(state, 10, 18), "render   25%");
    EXPECT_EQ(progress_line(state, 10, 5), "rende");
}

TEST(ProgressLine, PercentagesAreRoundedDown) {
    EXPECT_NE(progress_line(at("render", 0.9999), 1).find(" 99%"), std::string::npos);
    EXPECT_NE(progress_line(at("render", 0.999), 1).find(" 99%"), std::string::npos);
    EXPECT_NE(progress_line(at("render", 1.5), 1).find("100%"), std::string::npos);
}

TEST(ProgressLine, DurationsHaveReadableUnits) {
    EXPECT_NE(progress_line(at("render", -1), 59.94).find("59.9 s"), std::string::npos);
    EXPECT_NE(progress_line(at("render", -1), 59.96).find("1 m 00 s"), std::string::npos);
    EXPECT_NE(progress_line(at("render", -1), 3599.4).find("59 m 59 s"), std::string::npos);
    EXPECT_NE(progress_line(at("render", -1), 7500).find("2 h 05 m"), std::string::npos);
    EXPECT_NE(progress_line(at("render", 0.01), 80).find("ETA 2 h 12 m"), std::string::npos);
}

TEST(Progress, WithoutATerminalAShortPhasePrintsNothing) {
    TestClock clock;
    testing::internal::CaptureStderr();
    {
        Progress progress(Toggle::AUTO, false, clock.reader());
        for (int i = 0; i < 1000; ++i)
            progress.update(at("load", i / 1000.0));
        clock.pass(milliseconds(900));
        progress.update(at("render", 0.5));
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Progress, WithoutATerminalALongPhaseLeavesOneLine) {
    TestClock clock;
    testing::internal::CaptureStderr();
    {
        Progress progress(Toggle::AUTO, false, clock.reader());
        progress.update(at("render", 0));
        clock.pass(milliseconds(1100));
        progress.update(at("render", 1, 64));
        progress.finish();
        progress.finish();
    }
    const std::string text = testing::internal::GetCapturedStderr();
    EXPECT_EQ(text, "render  100%  64 spp  1.1 s\n");
}

TEST(Progress, CanBeSwitchedOff) {
    for (const bool quiet : {false, true}) {
        Terminal terminal(80);
        Progress progress(quiet ? Toggle::ON : Toggle::OFF, quiet);
        progress.update(at("render", 0));
        progress.finish();
        EXPECT_EQ(terminal.end(), "");
    }
}

TEST(Progress, WhoeverWatchesIsToldOfEveryStateShownOrNot) {
    for (const Toggle show : {Toggle::ON, Toggle::OFF}) {
        TestClock clock;
        Progress progress(show, false, clock.reader());
        std::vector<std::pair<std::string, double>> told;
        progress.watch(
            [&](const ProgressState& state, double seconds) { told.emplace_back(state.phase, seconds); });
        testing::internal::CaptureStderr();
        progress.update(at("load", -1));
        clock.pass(milliseconds(2000));
        progress.update(at("load", -1));
        progress.update(at("render", 0));
        progress.watch({});
        progress.update(at("render", 1));
        progress.finish();
        const std::string printed = testing::internal::GetCapturedStderr();
        EXPECT_EQ(told,
                  (std::vector<std::pair<std::string, double>>{{"load", 0}, {"load", 2}, {"render", 0}}));
        EXPECT_EQ(printed.empty(), show == Toggle::OFF) << printed;
    }
}

TEST(Progress, TheTimeToGoIsThatOfTheNearestLimit) {
    ProgressState state = at("render", 0.25);
    EXPECT_EQ(seconds_to_go(state, 10), 30);
    state.target = ProgressTarget{0.02, 20, 15, 40};
    EXPECT_FALSE(seconds_to_go(state, 10)) << "the error comes first";
    EXPECT_FALSE(seconds_to_go(at("load", -1), 10));
    EXPECT_FALSE(seconds_to_go(at("render", 1), 10));
}

TEST(Progress, OnATerminalOneLineIsRewritten) {
    TestClock clock;
    Terminal terminal(80);
    Progress progress(Toggle::AUTO, false, clock.reader());
    progress.update(at("render", 0));
    for (int i = 0; i < 100; ++i)
        progress.update(at("render", 0.1));
    clock.pass(milliseconds(300));
    progress.update(at("render", 0.5));
    const std::string text = terminal.end();
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0);
    EXPECT_EQ(std::count(text.begin(), text.end(), '%'), 2) << text;
    EXPECT_EQ(text.find("\rrender    0%"), 0u) << text;
    EXPECT_NE(text.find("\033[K\rrender   50%"), std::string::npos) << text;
}

TEST(Progress, OnATerminalTheLineOfAShortPhaseVanishes) {
    Terminal terminal(80);
    Progress progress(Toggle::ON, false);
    progress.update(at("load", 0.5));
    progress.finish();
    const std::string text = terminal.end(), erased = "\r\033[K";
    EXPECT_EQ(text.substr(text.size() - erased.size()), erased) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 0);
}

TEST(Progress, OnATerminalTheLineOfALongPhaseStaysWithItsLastState) {
    TestClock clock;
    Terminal terminal(80);
    Progress progress(Toggle::ON, false, clock.reader());
    progress.update(at("render", 0));
    clock.pass(milliseconds(1100));
    progress.update(at("render", 0.9));
    progress.update(at("render", 1, 8));
    progress.finish();
    const std::string text = terminal.end();
    EXPECT_NE(text.find("\rrender  100%  8 spp  1.1 s\033[K"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), text.size() - 1) << text;
}

TEST(Progress, LineIsCutToTheTerminal) {
    Terminal terminal(20);
    Progress progress(Toggle::AUTO, false);
    progress.update(at("render", 0.25, 123456, 1e9));
    const std::string text = terminal.end();
    EXPECT_EQ(text, "\rrender   25%\033[K") << "a number that is cut is another number";
}

} // namespace clrt
