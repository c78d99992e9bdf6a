// SPDX-License-Identifier: Apache-2.0
// Several devices at one picture: each takes a range of samples when it has finished the one before. Sums of
// films are integers, so that neither the order nor who did what can change a bit. A device that fails or no
// longer answers is left out, and what only it held is rendered again by the others. No OpenCL here.
#pragma once

#include "film/film.h"
#include "render/pace.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace clrt {

/// A device at work. Its calls come from one thread at a time, which owns it for as long as it waits for the
/// device: longer than whoever made it, where that no longer answers.
class CrewMember {
public:
    virtual ~CrewMember() = default;
    /// Renders these samples of all pixels and holds them. Tells `goes_on` after each launch which part is
    /// done, in (0, 1]; where that says no, it returns false, and what it holds is worth nothing. Throws
    /// DeviceError.
    virtual bool render(const SampleRange& range, const std::function<bool(double)>& goes_on) = 0;
    /// Reads what it holds from the device, which then holds nothing. Throws DeviceError.
    virtual void fetch() = 0;
    /// Adds what was fetched to the film. No two members are called at once, none that was left out.
    virtual void add() = 0;
};

/// What a member has done.
struct CrewShare {
    std::uint64_t samples = 0; ///< a pixel, of those that are in the film
    double seconds = 0;        ///< of rendering, dropped samples included
    std::string failure;       ///< why it was left out; empty: it was not
};

/// What a crew asks and tells while it works.
struct CrewHooks {
    /// Seconds until no new sample is wanted. Called from all threads.
    std::function<double()> seconds_left;
    /// Whether samples that take so many seconds more are to be dropped now. Called from all threads.
    std::function<bool(double)> is_too_long;
    /// Called now and then with the samples a pixel that are rendered; true: no more is dealt out.
    std::function<bool(double)> watch;
    /// A member, by its place, has failed and lost these samples.
    std::function<void(size_t, const std::vector<SampleRange>&)> failed;
    /// A member that tells nothing for so many seconds may hang (Crew::longest_silence).
    double shortest_hang = SHORTEST_HANG;
};

/// Deals out samples. Its hooks are called only while run() is at work. Threads share it and its members: one
/// that hangs in a driver cannot be ended, and finds what it needs when it wakes up later.
class Crew : public std::enable_shared_from_this<Crew> {
public:
    /// `has_picture`: the film has samples already. Without, nothing is dropped before the range with the
    /// first sample is finished.
    Crew(std::vector<std::shared_ptr<CrewMember>> members, CrewHooks hooks, bool has_picture);

    /// Renders these samples, or as many of them as hooks allow; returns the ranges that were added to the
    /// film, which have gaps only where samples were dropped or a member failed last. Throws DeviceError when
    /// no member is left.
    ///
    /// A member that hangs is left out like one that fails. Its thread goes on waiting when this is done, and
    /// the process is to be ended by exit() or by returning from main: no driver is asked then to wait for
    /// it.
    std::vector<SampleRange> run(const std::vector<SampleRange>& work);

    /// Of each member.
    const std::vector<CrewShare>& shares() const { return shares_; }
    /// Seconds of a sample a pixel by the fastest member; 0: not known yet.
    double fastest_pass() const;
    /// Whether samples were dropped because hooks said so.
    bool has_dropped() const { return has_dropped_; }

private:
    /// One member's work.
    struct Bench {
        double pass_seconds = 0;       ///< a sample a pixel, as last measured; 0: not known
        std::vector<SampleRange> held; ///< rendered, not in the film
        std::uint64_t dealt = 0;       ///< samples so far
        SampleRange range;             ///< at work on it; empty: on none
        double done = 0;               ///< part of it
        bool is_waiting = false;       ///< for its device,
        double silence = 0;            ///< so many seconds since that has told something
    };

    void round();
    void look();
    void find_hung(double seconds);
    double longest_silence(const Bench& bench) const;
    bool set_waiting(size_t member, bool is_waiting);
    void work(size_t member);
    bool take(size_t member);
    double fitting_samples(size_t member) const;
    bool render(size_t member);
    bool may_be_dropped(const Bench& bench) const;
    bool deliver(size_t member);
    void leave(size_t member, const std::string& failure);
    bool is_left(size_t member) const { return shares_[member].failure.empty(); }
    size_t count_left() const;

    const std::vector<std::shared_ptr<CrewMember>> members_;
    CrewHooks hooks_;
    std::vector<CrewShare> shares_;
    std::vector<Bench> benches_;
    std::vector<SampleRange> work_, delivered_;                     ///< to be dealt out; in the film
    std::vector<std::pair<size_t, std::vector<SampleRange>>> lost_; ///< by members that failed, not told yet
    std::uint64_t first_sample_ = 0;                                ///< of the work
    double finished_ = 0;                                           ///< samples a pixel of this run
    size_t busy_ = 0;                                               ///< members at work
    std::atomic<bool> has_picture_;
    bool is_stopped_ = false, has_dropped_ = false;
    std::vector<std::thread> threads_; ///< of this round, by member; that of one that hangs is let go
    std::exception_ptr error_;
    std::mutex mutex_, film_mutex_; ///< of all of this; of the film
    std::condition_variable changed_;
};

} // namespace clrt
