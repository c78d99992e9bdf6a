// SPDX-License-Identifier: Apache-2.0
// What ends a render, and that ending it by its error does not make the error look smaller than it is.
#include "render/stop_rules.h"

#include "render/good_counts.h"
#include "support/noise_film.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr std::uint64_t FILM_LIMIT = 1 << 22;

RenderState state(std::uint64_t samples, double seconds = 0, double pass_seconds = 0.1, double error = -1) {
    RenderState made;
    made.samples = samples;
    made.seconds = seconds;
    made.pass_seconds = pass_seconds;
    if (error >= 0)
        made.error = FilmError{error, {}, {}};
    return made;
}

} // namespace

TEST(StopRules, SamplesEndTheRender) {
    SamplingOptions options;
    EXPECT_EQ(StopRules(options, FILM_LIMIT).last_samples(), 64u) << "without any rule";
    options.spp = 100;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_FALSE(rules.ended(state(99)));
    EXPECT_EQ(rules.ended(state(100)), StopRule::SPP);
    EXPECT_EQ(rules.ended(state(164)), StopRule::SPP) << "a resumed film may have more";
}

TEST(StopRules, EveryRuleAloneHasAFiniteEnd) {
    SamplingOptions options;
    options.error = 0.01;
    EXPECT_EQ(StopRules(options, FILM_LIMIT).last_samples(), 65536u);
    options = SamplingOptions();
    options.time_seconds = 1e9;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_EQ(rules.last_samples(), FILM_LIMIT);
    EXPECT_EQ(rules.ended(state(FILM_LIMIT)), StopRule::FILM_FULL);
}

TEST(StopRules, TimeEndsTheRenderBeforeAPassThatItLeavesNoRoomFor) {
    SamplingOptions options;
    options.time_seconds = 2;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_FALSE(rules.ended(state(10, 1.7, 0.3)));
    EXPECT_FALSE(rules.ended(state(10, 1.75, 0.3))) << "passes differ";
    EXPECT_EQ(rules.ended(state(10, 1.8, 0.3)), StopRule::TIME);
    EXPECT_EQ(rules.ended(state(10, 2.1, 0.3)), StopRule::TIME);
    EXPECT_FALSE(rules.ended(state(0, 5, 0))) << "one pass is always completed";
}

TEST(StopRules, HowTimeEndedTheRenderIsSaid) {
    SamplingOptions options;
    options.time_seconds = 10;
    const StopRules rules(options, FILM_LIMIT);
    const auto said = [&](const StopMoment& moment) { return rules.describe(StopRule::TIME, moment); };
    EXPECT_EQ(said({1, 10.1, 0.2, false, 0}), "--time 10 s is over");
    EXPECT_EQ(said({1, 9.9, 0.2, false, 0}), "--time 10 s is over");
    EXPECT_EQ(said({1, 7.5, 3.2, false, 0}), "another pass takes 3.2 s, more than --time 10 s leaves");
    EXPECT_EQ(said({1, 30, 30, true, 0}), "--time 10 s is over by 20.0 s: the first pass is always finished");
    EXPECT_EQ(said({1, 11, 0.2, false, 0}), "--time 10 s is over by 1.0 s: a launch is never cut short");
    EXPECT_EQ(said({1, 10.1, 4, false, 2.5}), "--time 10 s is over; an unfinished pass was dropped (2.5 s)");
}

TEST(StopRules, TheErrorEndsTheRenderWhereItIsMeasured) {
    SamplingOptions options;
    options.error = 0.02;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_FALSE(rules.ended(state(64))) << "not measured";
    EXPECT_FALSE(rules.ended(state(64, 0, 0.1, 0.021)));
    EXPECT_EQ(rules.ended(state(64, 0, 0.1, 0.02)), StopRule::ERROR);
    EXPECT_FALSE(rules.ended(state(4, 0, 0.1, 0.001))) << "one sample in every replicate";
    options.error.reset();
    EXPECT_FALSE(StopRules(options, FILM_LIMIT).ended(state(32, 0, 0.1, 0))) << "no target";
}

TEST(StopRules, ADenoisedPictureThatIsGoodEnoughEndsTheRender) {
    SamplingOptions options;
    options.denoised_error = 0.05;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_EQ(rules.last_samples(), 65536u);
    EXPECT_EQ(rules.next_check(64), 96u) << "any good count";
    EXPECT_TRUE(rules.is_check(96, std::nullopt)) << "whatever the clock says";
    EXPECT_FALSE(rules.is_check(80, std::nullopt));
    RenderState looked = state(64, 0, 0.1, 0.001);
    EXPECT_FALSE(rules.ended(looked)) << "the raw picture's error is not what is asked for";
    looked.is_denoised_enough = true;
    EXPECT_EQ(rules.ended(looked), StopRule::DENOISED_ERROR);
    EXPECT_EQ(rules.describe(StopRule::DENOISED_ERROR), "--denoised-error 5 % is reached");
    looked.samples = 4;
    EXPECT_FALSE(rules.ended(looked)) << "one sample in every replicate";
}

TEST(StopRules, TheFirstRuleThatHoldsIsNamed) {
    SamplingOptions options;
    options.spp = 64;
    options.time_seconds = 2;
    options.error = 0.02;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_EQ(rules.ended(state(64, 3, 0.1, 0.01)), StopRule::ERROR);
    EXPECT_EQ(rules.ended(state(64, 3, 0.1, 0.03)), StopRule::SPP);
    EXPECT_EQ(rules.ended(state(63, 3)), StopRule::TIME);
    RenderState interrupted = state(63, 1);
    interrupted.signal = 2;
    EXPECT_EQ(rules.ended(interrupted), StopRule::SIGNAL);
    interrupted.samples = 0;
    EXPECT_FALSE(rules.ended(interrupted)) << "no picture yet";
    EXPECT_EQ(rules.describe(StopRule::SPP, {64}), "--spp 64 is complete");
    EXPECT_EQ(rules.describe(StopRule::SPP, {100}),
              "the film has 100 spp already, more than --spp 64: nothing was left to render");
    EXPECT_EQ(rules.describe(StopRule::TIME, {3, 2}), "--time 2 s is over");
    EXPECT_EQ(rules.describe(StopRule::ERROR, {32}), "--error 2 % is reached");
}

TEST(StopRules, TheErrorIsMeasuredWhereSamplesAreEven) {
    SamplingOptions options;
    options.replicates = 8;
    const auto checks = [&] {
        const StopRules rules(options, FILM_LIMIT);
        std::vector<std::uint64_t> list;
        for (std::uint64_t check = rules.next_check(0); check < 200; check = rules.next_check(check)) {
            EXPECT_TRUE(rules.is_check(check, std::nullopt)) << check;
            EXPECT_FALSE(rules.is_check(check + 1, std::nullopt)) << check;
            list.push_back(check);
        }
        return list;
    };
    EXPECT_EQ(checks(), (std::vector<std::uint64_t>{8, 16, 32, 64, 128})) << "for the slope";
    options.error = 0.02;
    EXPECT_EQ(checks(), (std::vector<std::uint64_t>{8, 16, 24, 32, 48, 64, 96, 128, 192}));
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_EQ(rules.next_check(17), 24u);
    const auto after = [](double error) { return SquaredError{32, error * error, 1, {}}; };
    EXPECT_FALSE(rules.is_check(48, after(0.031))) << "it cannot have come down to the target since";
    EXPECT_TRUE(rules.is_check(48, after(0.029)));
    EXPECT_TRUE(rules.is_check(64, after(0.5))) << "for the slope";
}

TEST(StopRules, ProgressFollowsTheNearestLimit) {
    SamplingOptions options;
    options.spp = 100;
    options.time_seconds = 10;
    EXPECT_DOUBLE_EQ(StopRules(options, FILM_LIMIT).fraction(50, 2, std::nullopt), 0.5);
    EXPECT_DOUBLE_EQ(StopRules(options, FILM_LIMIT).fraction(50, 8, std::nullopt), 0.8);
    options = SamplingOptions();
    options.error = 0.01;
    EXPECT_DOUBLE_EQ(StopRules(options, FILM_LIMIT).fraction(48, 8, 192), 0.25) << "of what is expected";
    options.spp = 96;
    EXPECT_DOUBLE_EQ(StopRules(options, FILM_LIMIT).fraction(48, 8, 192), 0.5) << "which does not come";
}

TEST(GoodCounts, AreTheReplicatesTimesPowersOfTwoAndThreeHalvesOfThem) {
    EXPECT_EQ(next_good_count(0, 5), 5u);
    EXPECT_EQ(next_good_count(5, 5), 10u) << "one sample and a half are none";
    EXPECT_EQ(next_good_count(10, 5), 15u);
    EXPECT_EQ(next_good_count(15, 5), 20u);
    EXPECT_EQ(next_good_count(1000, 8), 1024u);
    EXPECT_EQ(next_good_count(1024, 8), 1536u);
    EXPECT_TRUE(is_good_count(1536, 8));
    EXPECT_FALSE(is_good_count(0, 8));
    EXPECT_FALSE(is_good_count(589, 8));
    EXPECT_FALSE(is_good_count(12, 8));
    EXPECT_TRUE(is_doubling(1024, 8));
    EXPECT_FALSE(is_doubling(1536, 8));
}

// Ends many renders by their error. Looking repeatedly favours estimates that happen to be low; at doublings
// of an error that is the mean over a picture the effect must stay below the statistical error of one render.
TEST(StopRules, EndingByTheErrorDoesNotMakeItLookSmaller) {
    std::mt19937 random(1);
    const int trials = 300;
    for (const double target : {0.0125, 0.0115, 0.0105}) { // the true error is 0.0125 at 64 samples
        SamplingOptions options;
        options.error = target;
        const StopRules rules(options, FILM_LIMIT);
        double ratio = 0;
        for (int trial = 0; trial < trials; ++trial) {
            Film film = empty_film(10, 10, 8, 0, 0);
            RenderState now;
            while (!rules.ended(now)) {
                now.samples = rules.next_check(now.samples);
                add_noise(film, now.samples, 10, 1, random);
                now.error = film_error(film);
            }
            EXPECT_EQ(rules.ended(now), StopRule::ERROR);
            const double truth = 1 / std::sqrt(double(now.samples)) / 10;
            ratio += now.error->relative_rmse / truth / trials;
        }
        EXPECT_NEAR(ratio, 1, 0.01) << target;
    }
}

} // namespace clrt
