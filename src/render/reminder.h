// SPDX-License-Identifier: Apache-2.0
// What is done every so many seconds.
#pragma once

#include <chrono>
#include <optional>

namespace clrt {

/// Reminds every so often; never without an interval.
class Reminder {
public:
    explicit Reminder(const std::optional<double>& interval_seconds)
        : interval_(interval_seconds), last_(Clock::now()) {}
    bool due() {
        if (!interval_ || std::chrono::duration<double>(Clock::now() - last_).count() < *interval_)
            return false;
        last_ = Clock::now();
        return true;
    }

private:
    using Clock = std::chrono::steady_clock;
    std::optional<double> interval_;
    Clock::time_point last_;
};

} // namespace clrt
