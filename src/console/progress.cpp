// SPDX-License-Identifier: Apache-2.0
// The one progress line on stderr.
#include "console/progress.h"

#include "console/terminal.h"
#include "seconds.h"

#include <cmath>
#include <cstdio>
#include <cstring>
#include <fmt/format.h>
#include <unistd.h>
#include <utility>

namespace clrt {

namespace {

using std::chrono::duration;

/// Seconds between two prints: readable on a terminal, few lines in a log file.
constexpr double TERMINAL_INTERVAL = 0.2, PLAIN_INTERVAL = 5;
/// A phase that took longer leaves a line behind when it ends, seconds.
constexpr double WORTH_A_LINE = 1;
/// Columns of a terminal that does not tell.
constexpr size_t DEFAULT_COLUMNS = 80;

/// "7.3 s", "4 m 05 s", "2 h 07 m".
std::string duration_text(double seconds) {
    if (seconds < 59.95)
        return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(std::llround(seconds));
    if (whole < 3600)
        return fmt::format("{} m {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} m", whole / 3600, whole / 60 % 60);
}

/// The same in whole seconds: a forecast is no more exact.
std::string rough_text(double seconds) {
    return seconds < 59.5 ? fmt::format("{:.0f} s", seconds) : duration_text(seconds);
}

/// "error about 4.2 % -> 2 % in 35 s (80 %: 28 s to 47 s)".
std::string error_text(const ProgressState& state) {
    std::string text =
        fmt::format("error {}{:.1f} %", state.error_is_measured ? "" : "about ", 100 * state.error);
    if (const std::optional<ProgressTarget>& target = state.target)
        text += fmt::format(" -> {:g} % in {} (80 %: {})", 100 * target->error, rough_text(target->seconds),
                            target->high < 0 ? rough_text(target->low) + " or more"
                                             : rough_text(target->low) + " to " + rough_text(target->high));
    return text;
}

/// What stands behind the phase.
std::vector<std::string> line_parts(const ProgressState& state, double seconds) {
    std::vector<std::string> parts;
    if (state.fraction >= 0)
        parts.push_back(
            fmt::format("{:3}%", static_cast<int>(std::floor(100 * std::fmin(state.fraction, 1)))));
    if (state.spp > 0)
        parts.push_back(fmt::format("{} spp", state.spp));
    parts.push_back(duration_text(seconds));
    if (const std::optional<double> to_go = seconds_to_go(state, seconds))
        parts.push_back("ETA " + duration_text(*to_go));
    if (state.error >= 0)
        parts.push_back(error_text(state));
    if (state.rays_per_second >= 0)
        parts.push_back(fmt::format("{:.1f} Mrays/s", state.rays_per_second * 1e-6));
    return parts;
}

} // namespace

std::optional<double> seconds_to_go(const ProgressState& state, double seconds) {
    if (!(state.fraction > 0 && state.fraction < 1))
        return std::nullopt;
    const double to_go = seconds * (1 / state.fraction - 1);
    // Another limit than the error comes first, or there is no other.
    return state.target && to_go >= state.target->low ? std::nullopt : std::optional(to_go);
}

std::string progress_line(const ProgressState& state, double seconds, size_t columns) {
    std::string line = fmt::format("{:<7} ", state.phase);
    const char* gap = "";
    for (const std::string& part : line_parts(state, seconds)) {
        if (line.size() + std::strlen(gap) + part.size() > columns)
            break;
        line += gap + part;
        gap = "  ";
    }
    return line.substr(0, columns);
}

Progress::Progress(Toggle show, bool quiet, std::function<Clock::time_point()> now)
    : now_(std::move(now)), terminal_(isatty(STDERR_FILENO) != 0), enabled_(show != Toggle::OFF && !quiet) {}

Progress::~Progress() {
    finish();
}

void Progress::update(const ProgressState& state) {
    if (!enabled_ && !watcher_)
        return;
    const Clock::time_point now = now_();
    if (state.phase != last_.phase) {
        finish();
        phase_start_ = last_print_ = now;
    }
    const bool first = last_.phase.empty();
    last_ = state;
    shown_ = false;
    if (watcher_)
        watcher_(state, seconds_between(phase_start_, now));
    const double interval = terminal_ ? TERMINAL_INTERVAL : PLAIN_INTERVAL;
    if (enabled_ && ((first && terminal_) || seconds_between(last_print_, now) >= interval))
        print(now);
}

void Progress::finish() {
    if (last_.phase.empty())
        return;
    const Clock::time_point now = now_();
    const bool worth_a_line = enabled_ && seconds_between(phase_start_, now) > WORTH_A_LINE;
    if (worth_a_line && !shown_)
        print(now);
    if (open_)
        std::fputs(worth_a_line ? "\n" : "\r\033[K", stderr);
    open_ = false;
    last_ = {};
}

void Progress::print(Clock::time_point now) {
    const double seconds = seconds_between(phase_start_, now);
    // The last column stays free: a full line would wrap, and a wrapped line cannot be rewritten.
    if (terminal_)
        std::fprintf(
            stderr, "\r%s\033[K",
            progress_line(last_, seconds, terminal_columns(STDERR_FILENO, DEFAULT_COLUMNS) - 1).c_str());
    else
        std::fprintf(stderr, "%s\n", progress_line(last_, seconds).c_str());
    std::fflush(stderr);
    open_ = terminal_;
    shown_ = true;
    last_print_ = now;
}

} // namespace clrt
