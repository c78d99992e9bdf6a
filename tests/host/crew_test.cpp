// SPDX-License-Identifier: Apache-2.0
// Several devices at one picture, with devices that are made up: every sample is rendered once, whoever is
// fast, slow, fails, hangs or is told to stop.
#include "render/crew.h"

#include "error.h"
#include "film/sample_ranges.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

namespace clrt {

namespace {

/// How often each sample was added to the film.
using Film = std::map<std::uint64_t, int>;

/// Hangs until it is let go.
class Hanging {
public:
    void wait() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return is_over_; });
    }
    void end() {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
        changed_.notify_all();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_over_ = false;
};

/// A device whose passes take so long, and that fails or hangs where it is told to.
class FakeMember : public CrewMember {
public:
    FakeMember(Film& film, double pass_seconds) : film_(film), pass_seconds_(pass_seconds) {}
    ~FakeMember() override { *is_gone = true; }

    bool render(const SampleRange& range, const std::function<bool(double)>& goes_on) override {
        if (++renders == fails_at_render)
            throw DeviceError("out of resources");
        if (renders == hangs_at_render)
            hang();
        const auto seconds = std::chrono::duration<double>(pass_seconds_ * double(range.end - range.first));
        for (int launch = 1; launch <= 4; ++launch) {
            std::this_thread::sleep_for(seconds / 4);
            if (!goes_on(launch / 4.0)) {
                *is_told_to_end = true;
                return false;
            }
        }
        for (std::uint64_t sample = range.first; sample < range.end; ++sample)
            held_.push_back(sample);
        return true;
    }
    void fetch() override {
        if (++fetches == fails_at_fetch)
            throw DeviceError("device lost");
        if (fetches == hangs_at_fetch)
            hang();
    }
    void add() override {
        for (const std::uint64_t sample : held_)
            ++film_[sample];
        held_.clear();
    }

    int fails_at_render = 0, fails_at_fetch = 0; ///< counted from 1
    int hangs_at_render = 0, hangs_at_fetch = 0;
    std::string fails_after_hanging; ///< with this message; empty: it does not
    int renders = 0, fetches = 0;
    const std::shared_ptr<Hanging> hanging = std::make_shared<Hanging>();
    const std::shared_ptr<std::atomic<bool>> is_told_to_end = std::make_shared<std::atomic<bool>>(false),
                                             is_gone = std::make_shared<std::atomic<bool>>(false);

private:
    void hang() {
        hanging->wait();
        if (!fails_after_hanging.empty())
            throw DeviceError(fails_after_hanging);
    }

    Film& film_;
    double pass_seconds_;
    std::vector<std::uint64_t> held_;
};

/// Two devices and what they tell.
struct TwoDevices {
    explicit TwoDevices(double first = 0.0005, double second = 0.0005)
        : one_(std::make_shared<FakeMember>(film, first)), two_(std::make_shared<FakeMember>(film, second)) {}

    std::shared_ptr<Crew> crew() {
        return std::make_shared<Crew>(std::vector<std::shared_ptr<CrewMember>>{one_, two_},
                                      CrewHooks{[this] { return seconds_left.load(); },
                                                [this](double) { return drops.load(); },
                                                [this](double samples) {
                                                    most = std::max(most, samples);
                                                    if (samples >= ends_at) {
                                                        seconds_left = 0.06;
                                                        drops = true;
                                                    }
                                                    return stops;
                                                },
                                                [this](size_t member, const std::vector<SampleRange>& lost) {
                                                    failed.push_back(member);
                                                    lost_samples += count_samples(lost);
                                                },
                                                shortest_hang},
                                      false);
    }
    /// Ends what hangs, and waits until its threads have gone and taken the members with them.
    void wake() {
        const auto is_one_gone = one.is_gone, is_two_gone = two.is_gone;
        one.hanging->end();
        two.hanging->end();
        one_.reset();
        two_.reset();
        for (int i = 0; i < 1000 && !(*is_one_gone && *is_two_gone); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        EXPECT_TRUE(*is_one_gone && *is_two_gone);
    }
    /// Whether the film has exactly these samples, each once.
    bool has(std::uint64_t first, std::uint64_t end) const {
        Film expected;
        for (std::uint64_t sample = first; sample < end; ++sample)
            expected[sample] = 1;
        return film == expected;
    }

    Film film;
    std::shared_ptr<FakeMember> one_, two_;
    FakeMember &one = *one_, &two = *two_;
    double shortest_hang = 0.5;
    std::atomic<double> seconds_left{1e9};
    std::atomic<bool> drops{false};
    double most = 0;
    double ends_at = 1e9; ///< samples from which time is nearly over
    bool stops = false;
    std::vector<size_t> failed;
    std::uint64_t lost_samples = 0;
};

using Ranges = std::vector<SampleRange>;

} // namespace

TEST(SampleRanges, NeighboursAreJoinedInAnyOrder) {
    Ranges ranges;
    for (const SampleRange& range : Ranges{{8, 12}, {0, 4}, {16, 20}, {4, 8}, {12, 16}})
        add_range(ranges, range);
    EXPECT_EQ(ranges, (Ranges{{0, 20}}));
    add_range(ranges, {24, 25});
    EXPECT_EQ(ranges, (Ranges{{0, 20}, {24, 25}}));
    EXPECT_EQ(count_samples(ranges), 21u);
}

TEST(SampleRanges, GapsComeBeforeWhatIsBehind) {
    EXPECT_EQ(next_ranges({}, 5, 3), (Ranges{{5, 8}}));
    EXPECT_EQ(next_ranges({{0, 4}}, 0, 3), (Ranges{{4, 7}}));
    EXPECT_EQ(next_ranges({{2, 4}, {6, 7}}, 0, 4), (Ranges{{4, 6}, {7, 9}})) << "not those in front";
    EXPECT_EQ(next_ranges({{2, 4}, {6, 7}}, 0, 1), (Ranges{{4, 5}}));
    EXPECT_EQ(next_ranges({{2, 4}}, 0, 0), Ranges{});
}

TEST(Crew, EverySampleIsRenderedOnceAndTheFasterDeviceTakesMore) {
    TwoDevices devices(0.0005, 0.004);
    const auto crew = devices.crew();
    EXPECT_EQ(crew->run({{3, 200}}), (Ranges{{3, 200}}));
    EXPECT_TRUE(devices.has(3, 200));
    EXPECT_GT(crew->shares()[0].samples, crew->shares()[1].samples);
    EXPECT_GT(crew->shares()[1].samples, 0u);
    EXPECT_EQ(crew->shares()[0].samples + crew->shares()[1].samples, 197u);
    EXPECT_EQ(devices.most, 197);
    EXPECT_TRUE(devices.failed.empty());
}

TEST(Crew, WhatAFailedDeviceHeldIsRenderedAgainByTheOthers) {
    for (const int at : {1, 2, 4}) {
        SCOPED_TRACE(at);
        TwoDevices devices;
        devices.two.fails_at_render = at;
        const auto crew = devices.crew();
        EXPECT_EQ(crew->run({{0, 100}}), (Ranges{{0, 100}}));
        EXPECT_TRUE(devices.has(0, 100));
        EXPECT_EQ(crew->shares()[1].failure, "out of resources");
        EXPECT_EQ(crew->shares()[1].samples, 0u);
        EXPECT_EQ(devices.failed, std::vector<size_t>{1});
        EXPECT_GT(devices.lost_samples, 0u);
        // It is asked for nothing more.
        EXPECT_EQ(crew->run({{100, 120}}), (Ranges{{100, 120}}));
        EXPECT_EQ(devices.two.renders, at);
    }
}

TEST(Crew, ADeviceThatFailsWhenItDeliversHasAddedNothing) {
    TwoDevices devices;
    devices.one.fails_at_fetch = 2;
    const auto crew = devices.crew();
    EXPECT_EQ(crew->run({{0, 40}}), (Ranges{{0, 40}}));
    EXPECT_EQ(crew->run({{40, 90}}), (Ranges{{40, 90}})) << "also after the other had left";
    EXPECT_TRUE(devices.has(0, 90));
    EXPECT_GT(crew->shares()[0].samples, 0u) << "of the first run";
    EXPECT_EQ(crew->shares()[0].samples + crew->shares()[1].samples, 90u);
}

TEST(Crew, WithoutADeviceThereIsAnError) {
    TwoDevices devices;
    devices.one.fails_at_render = devices.two.fails_at_render = 2;
    const auto crew = devices.crew();
    EXPECT_THROW(crew->run({{0, 100}}), DeviceError);
}

TEST(Crew, ADeviceThatHangsIsLeftOutAndItsSamplesAreRenderedByTheOther) {
    for (const bool fails : {false, true}) {
        SCOPED_TRACE(fails);
        TwoDevices devices;
        devices.two.hangs_at_render = 3;
        devices.two.fails_after_hanging = fails ? "a driver's end" : "";
        const auto is_told_to_end = devices.two.is_told_to_end;
        auto crew = devices.crew();
        EXPECT_EQ(crew->run({{0, 100}}), (Ranges{{0, 100}}));
        EXPECT_TRUE(devices.has(0, 100));
        EXPECT_EQ(devices.failed, std::vector<size_t>{1});
        EXPECT_GT(devices.lost_samples, 0u) << "what it held is lost as well";
        EXPECT_EQ(crew->shares()[1].samples, 0u);
        EXPECT_NE(crew->shares()[1].failure.find("told nothing for"), std::string::npos);
        EXPECT_EQ(crew->run({{100, 120}}), (Ranges{{100, 120}})) << "without it";
        // When it wakes up, nobody needs it, and nothing is there that it could harm.
        crew.reset();
        devices.wake();
        EXPECT_NE(*is_told_to_end, fails);
        EXPECT_TRUE(devices.has(0, 120));
        EXPECT_EQ(devices.failed.size(), 1u);
    }
}

TEST(Crew, ADeviceThatWakesUpWhileTheOthersWorkAddsNothing) {
    for (const bool at_fetch : {false, true}) {
        SCOPED_TRACE(at_fetch);
        TwoDevices devices;
        (at_fetch ? devices.two.hangs_at_fetch : devices.two.hangs_at_render) = 1;
        const auto crew = devices.crew();
        EXPECT_EQ(crew->run({{0, 40}}), (Ranges{{0, 40}}));
        devices.two.hanging->end();
        EXPECT_EQ(crew->run({{40, 400}}), (Ranges{{40, 400}}));
        EXPECT_TRUE(devices.has(0, 400));
        EXPECT_EQ(devices.two.renders, at_fetch ? devices.two.renders : 1);
        EXPECT_EQ(crew->shares()[1].samples, 0u);
        EXPECT_FALSE(crew->has_dropped());
        EXPECT_EQ(devices.failed, std::vector<size_t>{1});
    }
}

TEST(Crew, ASlowDeviceThatTellsOfItsLaunchesDoesNotHang) {
    // Its pass takes longer than any silence is borne, and it is 200 times as slow as the other.
    TwoDevices devices(0.005, 1.6);
    devices.shortest_hang = 1.2;
    const auto crew = devices.crew();
    EXPECT_EQ(crew->run({{0, 100}}), (Ranges{{0, 100}}));
    EXPECT_TRUE(devices.failed.empty());
    EXPECT_GE(crew->shares()[1].samples, 1u);
}

TEST(Crew, ALongLaunchIsBorneWhereAllAreSlow) {
    // A launch of 0.1 seconds is longer than the shortest hang, but not longer than a pass should take.
    TwoDevices devices(0.4, 0.4);
    devices.shortest_hang = 0.02;
    const auto crew = devices.crew();
    EXPECT_EQ(crew->run({{0, 4}}), (Ranges{{0, 4}}));
    EXPECT_TRUE(devices.failed.empty());
}

TEST(Crew, WhereAllHangThereIsAnErrorOnceAPaceIsKnown) {
    TwoDevices devices;
    devices.one.hangs_at_render = devices.two.hangs_at_render = 2;
    auto crew = devices.crew();
    EXPECT_THROW(crew->run({{0, 100}}), DeviceError);
    EXPECT_EQ(devices.failed.size(), 2u);
    crew.reset();
    devices.wake();
}

TEST(Crew, NothingIsDealtOutAfterItIsStopped) {
    TwoDevices devices(0.01, 0.01);
    devices.stops = true; // seen at the first look
    const auto crew = devices.crew();
    const Ranges done = crew->run({{0, 100000}});
    ASSERT_EQ(done.size(), 1u) << "what was dealt out is finished";
    EXPECT_EQ(done[0].first, 0u);
    EXPECT_LT(done[0].end, 1000u);
    EXPECT_TRUE(devices.has(0, done[0].end));
}

TEST(Crew, TheFirstPassIsFinishedWhateverTheTime) {
    TwoDevices devices(0.02, 0.2);
    devices.seconds_left = -1;
    devices.drops = true;
    const auto crew = devices.crew();
    const Ranges done = crew->run({{0, 6400}});
    ASSERT_EQ(done.size(), 1u);
    EXPECT_EQ(done[0].first, 0u);
    EXPECT_LT(done[0].end, 640u) << "what the faster device did while the slower had the first";
    EXPECT_TRUE(devices.has(0, done[0].end));
}

TEST(Crew, WhatWasRenderedBeforeIsDeliveredBeforeARangeThatMayBeDropped) {
    TwoDevices devices(0.03, 0.03);
    devices.ends_at = 6;
    const auto crew = devices.crew();
    const Ranges done = crew->run({{0, 600}});
    EXPECT_TRUE(crew->has_dropped());
    EXPECT_GE(count_samples(done), 6u);
    EXPECT_LT(count_samples(done), 600u);
    EXPECT_EQ(devices.film.size(), count_samples(done));
}

TEST(Crew, ARangeThatIsDroppedLosesNothingElse) {
    TwoDevices devices(0.02, 0.02);
    const auto crew = devices.crew();
    EXPECT_EQ(crew->run({{0, 8}}), (Ranges{{0, 8}}));
    devices.seconds_left = 0.03; // for a pass each, which may be late
    devices.drops = true;
    const Ranges done = crew->run({{8, 64}});
    EXPECT_TRUE(done.empty());
    EXPECT_TRUE(devices.has(0, 8));
}

} // namespace clrt
