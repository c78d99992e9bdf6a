// SPDX-License-Identifier: Apache-2.0
// What ends a render, and that ending it by its error does not make the error look smaller than it is.
#include "render/stop_rules.h"

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
    Options options;
    EXPECT_EQ(StopRules(options, FILM_LIMIT).last_samples(), 64u) << "without any rule";
    options.spp = 100;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_FALSE(rules.ended(state(99)));
    EXPECT_EQ(rules.ended(state(100)), StopRule::SPP);
    EXPECT_EQ(rules.ended(state(164)), StopRule::SPP) << "a resumed film may have more";
}

TEST(StopRules, EveryRuleAloneHasAFiniteEnd) {
    Options options;
    options.error = 0.01;
    EXPECT_EQ(StopRules(options, FILM_LIMIT).last_samples(), 65536u);
    options = Options();
    options.time_seconds = 1e9;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_EQ(rules.last_samples(), FILM_LIMIT);
    EXPECT_EQ(rules.ended(state(FILM_LIMIT)), StopRule::FILM_FULL);
}

TEST(StopRules, TimeEndsTheRenderAtTheNearestPass) {
    Options options;
    options.time_seconds = 2;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_FALSE(rules.ended(state(10, 1.8, 0.3)));
    EXPECT_EQ(rules.ended(state(10, 1.9, 0.3)), StopRule::TIME);
    EXPECT_FALSE(rules.ended(state(0, 5, 0))) << "one pass is always completed";
}

TEST(StopRules, TheErrorEndsTheRenderWhereItIsMeasured) {
    Options options;
    options.error = 0.02;
    const StopRules rules(options, FILM_LIMIT);
    EXPECT_FALSE(rules.ended(state(64))) << "not measured";
    EXPECT_FALSE(rules.ended(state(64, 0, 0.1, 0.021)));
    EXPECT_EQ(rules.ended(state(64, 0, 0.1, 0.02)), StopRule::ERROR);
    EXPECT_FALSE(rules.ended(state(8, 0, 0.1, 0.001))) << "one sample in every replicate";
    options.error.reset();
    EXPECT_FALSE(StopRules(options, FILM_LIMIT).ended(state(32, 0, 0.1, 0))) << "no target";
}

TEST(StopRules, TheFirstRuleThatHoldsIsNamed) {
    Options options;
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
    EXPECT_EQ(rules.describe(StopRule::SPP, 64), "--spp 64 is complete");
    EXPECT_EQ(rules.describe(StopRule::SPP, 100),
              "the film has 100 spp already, more than --spp 64: nothing was left to render");
    EXPECT_EQ(rules.describe(StopRule::TIME, 3), "--time 2 s is over");
    EXPECT_EQ(rules.describe(StopRule::ERROR, 32), "--error 2 % is reached");
}

TEST(StopRules, TheErrorIsMeasuredAtDoublings) {
    Options options;
    options.replicates = 8;
    const StopRules rules(options, FILM_LIMIT);
    std::vector<std::uint64_t> checks;
    for (std::uint64_t samples = 0; samples < 100; ++samples)
        if (rules.is_check(samples))
            checks.push_back(samples);
    EXPECT_EQ(checks, (std::vector<std::uint64_t>{8, 16, 32, 64}));
    EXPECT_EQ(rules.next_check(0), 8u);
    EXPECT_EQ(rules.next_check(8), 16u);
    EXPECT_EQ(rules.next_check(9), 16u);
}

TEST(StopRules, ProgressFollowsTheNearestLimit) {
    Options options;
    options.spp = 100;
    options.time_seconds = 10;
    EXPECT_DOUBLE_EQ(StopRules(options, FILM_LIMIT).fraction(50, 2, std::nullopt), 0.5);
    EXPECT_DOUBLE_EQ(StopRules(options, FILM_LIMIT).fraction(50, 8, std::nullopt), 0.8);
    options = Options();
    options.error = 0.01;
    const SquaredError check{
        16, 0.0009, 1, {}}; // three times the target: nine times the samples, 256 is next
    EXPECT_DOUBLE_EQ(StopRules(options, FILM_LIMIT).fraction(64, 8, check), 0.25);
}

// Ends many renders by their error. Looking repeatedly favours estimates that happen to be low; at doublings
// of an error that is the mean over a picture the effect must stay below the statistical error of one render.
TEST(StopRules, EndingByTheErrorDoesNotMakeItLookSmaller) {
    std::mt19937 random(1);
    const int trials = 300;
    for (const double target : {0.0125, 0.0115, 0.0105}) { // the true error is 0.0125 at 64 samples
        Options options;
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
