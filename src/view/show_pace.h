// SPDX-License-Identifier: Apache-2.0
// How often the picture so far is shown.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

namespace clrt {

/// Says when the next picture is shown: at once at first, then so that showing takes a small part of the
/// render.
class ShowPace {
public:
    using Clock = std::chrono::steady_clock;
    explicit ShowPace(std::function<Clock::time_point()> now = Clock::now) : now_(std::move(now)) {}
    bool is_due() const { return !end_ || now_() >= *end_ + pause_; }
    void begin() { begin_ = now_(); }
    void end();

private:
    std::function<Clock::time_point()> now_;
    Clock::time_point begin_;
    std::optional<Clock::time_point> end_; ///< of the last; none: none was shown
    Clock::duration pause_{};
};

} // namespace clrt
