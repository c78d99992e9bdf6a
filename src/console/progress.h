// SPDX-License-Identifier: Apache-2.0
// The one progress line on stderr: rewritten in place on a terminal, plain lines now and then otherwise.
#pragma once

#include "options/toggle.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace clrt {

/// When an error will be reached that is asked for.
struct ProgressTarget {
    double error = 0;          ///< that is asked for
    double seconds = 0;        ///< from now
    double low = 0, high = -1; ///< their interval; high is negative where nobody can name it
};

/// What the line shows; values that are not known yet are negative.
struct ProgressState {
    std::string phase;     ///< "load", "bvh", "compile", "render"
    double fraction = -1;  ///< 0..1, percentages are rounded down
    std::uint64_t spp = 0; ///< samples a pixel so far
    double rays_per_second = -1;
    double error = -1;              ///< relative
    bool error_is_measured = false; ///< at these samples; otherwise it is extrapolated
    std::optional<ProgressTarget> target = std::nullopt;
};

/// The line for a state that its phase has reached after `seconds`, without a line end: phase, percentage,
/// samples a pixel, seconds, estimated seconds to go, error and when the one that is asked for comes, rays a
/// second. What is not known is left out, and so is what does not fit `columns`, from the end: a number that
/// is cut is another number.
std::string progress_line(const ProgressState& state, double seconds,
                          size_t columns = std::numeric_limits<size_t>::max());

/// Seconds that a state's phase will still take after `seconds`, by the fraction that is done; none where
/// nobody knows, or where the error that is asked for comes first.
std::optional<double> seconds_to_go(const ProgressState& state, double seconds);

/// Is told of every state, with the seconds of its phase so far.
using ProgressWatcher = std::function<void(const ProgressState&, double seconds)>;

/// Not for several threads at once. Log lines come between two lines only: call finish() before logging.
class Progress {
public:
    using Clock = std::chrono::steady_clock;

    /// AUTO shows it when stderr is a terminal, and as plain lines every few seconds when it is not; -q
    /// switches it off. `now` tells the time.
    Progress(Toggle show, bool quiet, std::function<Clock::time_point()> now = Clock::now);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// Has another watcher told from now on, whether the line is shown or not; an empty one ends that.
    void watch(ProgressWatcher watcher) { watcher_ = std::move(watcher); }

    /// Shows a state; cheap enough to call often, prints at most a few times a second. Adds seconds and ETA.
    void update(const ProgressState& state);
    /// Ends the phase and its line, so that other output starts on a fresh one: the line of a phase that took
    /// more than a second stays, others vanish. The next update starts a phase.
    void finish();

private:
    void print(Clock::time_point now);

    std::function<Clock::time_point()> now_;
    ProgressWatcher watcher_;
    bool terminal_ = false, enabled_ = false;
    bool shown_ = false; ///< the last state has been printed
    bool open_ = false;  ///< the cursor is on a line of ours, on a terminal
    ProgressState last_; ///< empty phase: none yet
    Clock::time_point phase_start_, last_print_;
};

} // namespace clrt
