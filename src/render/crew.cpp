// SPDX-License-Identifier: Apache-2.0
#include "render/crew.h"

#include "error.h"
#include "film/sample_ranges.h"
#include "render/launch_size.h"
#include "render/pace.h"
#include "seconds.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <utility>

namespace clrt {

namespace {

using Clock = std::chrono::steady_clock;

/// A range is at most this part of what a member may expect of the samples that are left, so that all members
/// end at nearly the same time.
constexpr double LARGEST_PART = 0.5;
/// Between two looks at the work, seconds.
constexpr double LOOK_SECONDS = 0.1;
/// Seconds between two looks that count as silence. Where there were more, all of the process stood still.
constexpr double LONGEST_LOOK = 1;

/// Has exit() end the process at once, with its exit code: what drivers clean up at their end may wait for a
/// thread that hangs in them.
void exit_without_drivers() {
    on_exit(
        [](int code, void*) {
            std::fflush(nullptr);
            std::_Exit(code);
        },
        nullptr);
}

} // namespace

Crew::Crew(std::vector<std::shared_ptr<CrewMember>> members, CrewHooks hooks, bool has_picture)
    : members_(std::move(members)), hooks_(std::move(hooks)), shares_(members_.size()),
      benches_(members_.size()), has_picture_(has_picture) {}

size_t Crew::count_left() const {
    return size_t(std::count_if(shares_.begin(), shares_.end(),
                                [](const CrewShare& share) { return share.failure.empty(); }));
}

double Crew::fastest_pass() const {
    double fastest = 0;
    for (size_t member = 0; member < benches_.size(); ++member)
        if (const double seconds = benches_[member].pass_seconds; is_left(member) && seconds > 0)
            fastest = fastest > 0 ? std::min(fastest, seconds) : seconds;
    return fastest;
}

std::vector<SampleRange> Crew::run(const std::vector<SampleRange>& work) {
    work_ = work;
    first_sample_ = work.empty() ? 0 : work.front().first;
    delivered_.clear();
    is_stopped_ = false;
    finished_ = 0;
    // What a member lost after the others had left is work for another round.
    for (size_t left = 0; !work_.empty() && !is_stopped_ && left != count_left();) {
        left = count_left();
        round();
        if (error_)
            std::rethrow_exception(std::exchange(error_, nullptr));
        if (count_left() == 0)
            throw DeviceError("no device is left to render on: " + shares_.back().failure);
    }
    return delivered_;
}

/// Sets all members to work and waits until none finds more to do.
void Crew::round() {
    busy_ = count_left();
    threads_ = std::vector<std::thread>(members_.size());
    for (size_t member = 0; member < members_.size(); ++member)
        if (is_left(member)) // none changes this before it is at work
            threads_[member] = std::thread([self = shared_from_this(), member] { self->work(member); });
    const auto is_done = [&] { return busy_ == 0; };
    auto last = Clock::now();
    for (bool done = false; !done;) {
        std::unique_lock lock(mutex_);
        done = changed_.wait_for(lock, std::chrono::duration<double>(LOOK_SECONDS), is_done);
        find_hung(std::min(seconds_since(last), LONGEST_LOOK));
        last = Clock::now();
        lock.unlock();
        look();
    }
    for (std::thread& thread : threads_)
        if (thread.joinable())
            thread.join();
}

/// Leaves out the members that have told nothing for too long. So many seconds have passed since the last
/// time.
void Crew::find_hung(double seconds) {
    for (size_t member = 0; member < benches_.size(); ++member) {
        Bench& bench = benches_[member];
        bench.silence += seconds;
        if (!bench.is_waiting || bench.silence <= longest_silence(bench))
            continue;
        leave(member, fmt::format("it has told nothing for {:.0f} seconds", bench.silence));
        threads_[member].detach();
        exit_without_drivers();
    }
}

/// Seconds for which a member may tell nothing: what its samples take by the slowest pace that is known, its
/// own included, and much more.
double Crew::longest_silence(const Bench& bench) const {
    double slowest = 0;
    for (size_t member = 0; member < benches_.size(); ++member)
        if (is_left(member))
            slowest = std::max(slowest, benches_[member].pass_seconds);
    if (slowest == 0)
        return HUGE_VAL;
    const double samples = std::max(double(bench.range.end - bench.range.first), 1.0);
    return std::max(hooks_.shortest_hang, LARGEST_LATENESS * slowest * samples);
}

/// The member's thread begins or ends to wait for its device; false: the member was left out.
bool Crew::set_waiting(size_t member, bool is_waiting) {
    const std::lock_guard lock(mutex_);
    benches_[member].is_waiting = is_waiting;
    benches_[member].silence = 0;
    return is_left(member);
}

/// Tells the hooks how far the work is and who has failed.
void Crew::look() {
    std::vector<std::pair<size_t, std::vector<SampleRange>>> lost;
    double samples = 0;
    {
        const std::lock_guard lock(mutex_);
        lost.swap(lost_);
        samples = finished_;
        for (const Bench& bench : benches_)
            samples += bench.done * double(bench.range.end - bench.range.first);
    }
    for (const auto& [member, ranges] : lost)
        hooks_.failed(member, ranges);
    if (hooks_.watch(samples)) {
        const std::lock_guard lock(mutex_);
        is_stopped_ = true;
    }
}

/// A member's thread.
void Crew::work(size_t member) {
    std::string failure;
    try {
        bool goes_on = true;
        while (goes_on && take(member))
            goes_on = render(member);
        if (goes_on)
            deliver(member);
    } catch (const DeviceError& error) {
        failure = error.what();
    } catch (...) {
        const std::lock_guard lock(mutex_);
        if (is_left(member)) {
            error_ = std::current_exception();
            is_stopped_ = true;
        }
    }
    const std::lock_guard lock(mutex_);
    if (is_left(member))
        leave(member, failure);
}

/// Takes the member's next range out of the work; false: there is none for it.
bool Crew::take(size_t member) {
    const std::lock_guard lock(mutex_);
    if (work_.empty() || is_stopped_)
        return false;
    const double fitting = fitting_samples(member);
    if (fitting < 1)
        return false;
    SampleRange& first = work_.front();
    Bench& bench = benches_[member];
    bench.range = {first.first, first.first + std::min(first.end - first.first, std::uint64_t(fitting))};
    bench.done = 0;
    bench.dealt += bench.range.end - bench.range.first;
    first.first = bench.range.end;
    if (first.first == first.end)
        work_.erase(work_.begin());
    return true;
}

/// Samples of the member's next range; less than one: the time that is left is too short.
double Crew::fitting_samples(size_t member) const {
    const Bench& bench = benches_[member];
    const double left = has_picture_ ? hooks_.seconds_left() : HUGE_VAL;
    if (bench.pass_seconds == 0)
        return left > 0 ? 1 : 0;
    if (left < WORTH_BEGINNING * bench.pass_seconds)
        return 0;
    // Aim at the time of a launch; grow slowly, for the first passes may be unlike the later ones.
    double samples = std::ceil(LAUNCH_SECONDS / bench.pass_seconds);
    if (samples > 1)
        samples = std::ceil(samples / SAMPLE_GROUP) * SAMPLE_GROUP;
    samples = std::min({samples, 2.0 * double(bench.dealt), std::max(left / bench.pass_seconds, 1.0)});
    // Leave the others their part.
    double speeds = 0;
    for (size_t other = 0; other < benches_.size(); ++other)
        if (const double pass = benches_[other].pass_seconds; is_left(other))
            speeds += 1 / (pass > 0 ? pass : bench.pass_seconds);
    const double part = LARGEST_PART / (bench.pass_seconds * speeds);
    return std::max(std::floor(std::min(samples, double(count_samples(work_)) * part)), 1.0);
}

/// Whether the range may have to be dropped before it is done.
bool Crew::may_be_dropped(const Bench& bench) const {
    const double seconds = bench.pass_seconds * double(bench.range.end - bench.range.first);
    return has_picture_ && (seconds > LONGEST_WAIT || LARGEST_SLOWDOWN * seconds > hooks_.seconds_left());
}

/// Renders the range that the member has taken; false: it was dropped, or the member left out.
bool Crew::render(size_t member) {
    Bench& bench = benches_[member];
    // Nothing but this range is lost where it may have to be dropped.
    if (!bench.held.empty() && may_be_dropped(bench) && !deliver(member))
        return false;
    set_waiting(member, true);
    const auto start = Clock::now();
    const bool is_done = members_[member]->render(bench.range, [&](double done) {
        const std::lock_guard lock(mutex_);
        if (!is_left(member))
            return false;
        bench.silence = 0;
        bench.done = done;
        return !(bench.held.empty() && has_picture_ && done < 1 &&
                 hooks_.is_too_long(seconds_since(start) * (1 - done) / done));
    });
    if (!set_waiting(member, false))
        return false;
    const std::lock_guard lock(mutex_);
    const double seconds = seconds_since(start);
    shares_[member].seconds += seconds;
    if (!is_done) {
        has_dropped_ = is_stopped_ = true;
        return false;
    }
    const double samples = double(bench.range.end - bench.range.first);
    bench.pass_seconds = seconds / samples;
    finished_ += samples;
    if (bench.range.first == first_sample_)
        has_picture_ = true;
    add_range(bench.held, bench.range);
    bench.range = {};
    return true;
}

/// Has the member add to the film what it holds; false: it was left out.
bool Crew::deliver(size_t member) {
    Bench& bench = benches_[member];
    if (bench.held.empty())
        return true;
    set_waiting(member, true);
    members_[member]->fetch();
    if (!set_waiting(member, false))
        return false;
    const std::lock_guard film_lock(film_mutex_);
    members_[member]->add();
    const std::lock_guard lock(mutex_);
    for (const SampleRange& range : std::exchange(bench.held, {})) {
        shares_[member].samples += range.end - range.first;
        add_range(delivered_, range);
    }
    return true;
}

/// Ends the member's work of this round. What it holds or works on is given back to the others.
void Crew::leave(size_t member, const std::string& failure) {
    Bench& bench = benches_[member];
    bench.is_waiting = false;
    std::vector<SampleRange> lost = std::exchange(bench.held, {});
    for (const SampleRange& range : lost)
        finished_ -= double(range.end - range.first);
    if (bench.range.first < bench.range.end)
        add_range(lost, std::exchange(bench.range, {}));
    for (const SampleRange& range : lost)
        add_range(work_, range);
    shares_[member].failure = failure;
    if (!failure.empty())
        lost_.emplace_back(member, lost);
    --busy_;
    changed_.notify_all();
}

} // namespace clrt
