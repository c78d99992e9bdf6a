// SPDX-License-Identifier: Apache-2.0
// What is promised for half the error. tests/cli/price_test.cpp holds renders to it.
#include "render/error_price.h"

#include "render/good_counts.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr int REPLICATES = 8;

/// The squared error of a picture of mean 1; leaving out a replicate changes nothing.
SquaredError squared(std::uint64_t samples, double error) {
    return {samples, error * error, 1, std::vector<double>(REPLICATES, error * error)};
}

/// Errors at 8, 16, ... samples that fall exactly with this slope from 0.5.
std::vector<SquaredError> falling(double slope, int doublings) {
    std::vector<SquaredError> errors;
    for (int k = 0; k <= doublings; ++k)
        errors.push_back(squared(std::uint64_t(8) << k, 0.5 * std::exp2(slope * k)));
    return errors;
}

} // namespace

TEST(ErrorPrice, WithoutAHistoryTheUsualSlopeIsTaken) {
    const auto price = price_of_half({}, squared(4, 0.4), REPLICATES, 10);
    ASSERT_TRUE(price);
    EXPECT_FALSE(price->measured);
    EXPECT_EQ(price->samples, 16u) << "4 * 2^(1/0.55) are 14; 16 is the good count above";
    EXPECT_NEAR(price->relative_rmse, 0.4 * std::pow(4, -0.55), 1e-12) << "what is reached there, not half";
    EXPECT_DOUBLE_EQ(price->factor, 4);
    EXPECT_DOUBLE_EQ(price->seconds, 30);
}

TEST(ErrorPrice, AMeasuredSlopeIsDrawnTowardsTheUsualOne) {
    for (const double slope : {-0.5, -0.7, -0.9}) {
        const auto forecast = forecast_error(falling(slope, 4), squared(128, 0.1));
        ASSERT_TRUE(forecast);
        EXPECT_TRUE(forecast->measured);
        EXPECT_NEAR(forecast->slope, slope + 0.27 * (-0.55 - slope), 0.005) << "a quarter of the way";
    }
    std::vector<SquaredError> vague = falling(-0.9, 4);
    vague.back().without = {1e-3, 5e-3, 1e-3, 5e-3, 1e-3, 5e-3, 1e-3, 5e-3};
    EXPECT_GT(forecast_error(vague, vague.back())->slope, -0.75) << "further where replicates disagree";
}

TEST(ErrorPrice, TheLastOctavesCount) {
    std::vector<SquaredError> errors = falling(-1, 4); // 8 to 128
    for (int k = 1; k <= 4; ++k)
        errors.push_back(squared(std::uint64_t(128) << k, 0.5 / 16 * std::exp2(-0.6 * k)));
    EXPECT_NEAR(forecast_error(errors, errors.back())->slope, -0.587, 1e-3);
}

TEST(ErrorPrice, APromiseIsMadeAtAGoodCount) {
    for (const double slope : {-0.5, -0.6, -0.75, -0.9})
        for (const std::uint64_t samples : {64, 96, 100, 128, 589}) {
            const SquaredError present = squared(samples, 0.03);
            const auto price = price_of_half(falling(slope, 3), present, REPLICATES, 1);
            ASSERT_TRUE(price);
            EXPECT_TRUE(is_good_count(price->samples, REPLICATES)) << price->samples;
            EXPECT_GT(price->samples, samples);
        }
}

// What lies between two doublings is not even: its error is no matter for the forecast.
TEST(ErrorPrice, TheForecastStartsFromTheLastDoubling) {
    const std::vector<SquaredError> errors = falling(-0.6, 4);
    const double last = std::sqrt(errors.back().mean_squared);
    const auto price = price_of_half(errors, squared(150, 1.02 * last), REPLICATES, 1);
    ASSERT_TRUE(price);
    EXPECT_NEAR(price->relative_rmse, last * std::pow(double(price->samples) / 128, -0.6), 0.03 * last);
}

TEST(ErrorPrice, ThreeHalvesOfADoublingAreWorseThanTheLaw) {
    const ErrorForecast forecast{128, 0.1, -0.8, true};
    EXPECT_DOUBLE_EQ(error_at(forecast, 256, REPLICATES), 0.1 * std::exp2(-0.8));
    const double between = error_at(forecast, 192, REPLICATES), law = 0.1 * std::pow(1.5, -0.8);
    EXPECT_GT(between, 1.05 * law);
    EXPECT_LT(between, 1.15 * law);
    const ErrorForecast independent{128, 0.1, -0.5, true};
    EXPECT_DOUBLE_EQ(error_at(independent, 192, REPLICATES), 0.1 / std::sqrt(1.5));
}

TEST(ErrorPrice, OfAnyErrorIsTheGoodCountThatReachesIt) {
    const std::vector<SquaredError> errors = falling(-0.6, 4); // 9.5 % at 128
    const auto price = price_of_error(0.03, errors, errors.back(), REPLICATES, 10);
    ASSERT_TRUE(price);
    const ErrorForecast forecast = *forecast_error(errors, errors.back());
    EXPECT_LE(error_at(forecast, price->samples, REPLICATES), 0.03);
    EXPECT_GT(error_at(forecast, price->samples * 2 / 3, REPLICATES), 0.03) << "two thirds do not";
    EXPECT_DOUBLE_EQ(price->seconds, 10 * (double(price->samples) / 128 - 1));
}

TEST(ErrorPrice, TheIntervalOfSamplesIsThatOfTheSlope) {
    const std::vector<SquaredError> errors = falling(-0.6, 4);
    const auto far = price_of_error(0.01, errors, errors.back(), REPLICATES, 10);
    ASSERT_TRUE(far && far->high_samples && far->high_seconds);
    EXPECT_LT(far->low_samples, far->samples);
    EXPECT_GT(*far->high_samples, far->samples);
    EXPECT_LT(far->low_seconds, far->seconds);
    EXPECT_GT(*far->high_seconds, far->seconds);
    // By the slope's 10 % and 90 % quantiles.
    const ErrorForecast forecast = *forecast_error(errors, errors.back());
    const double decades = std::log(errors.back().mean_squared / 1e-4) / 2;
    for (const auto& [samples, side] : {std::pair{far->low_samples, -1.0}, {*far->high_samples, 1.0}}) {
        const double slope = forecast.slope + side * 1.2816 * forecast.slope_deviation;
        const double law = 128 * std::exp(decades / -slope);
        EXPECT_GE(double(samples), law * 0.99) << side;
        EXPECT_LE(double(samples), law * 1.6) << "the good count above";
    }
    // Without a history it is wider, and errors on which few pixels decide are uncertain themselves.
    const auto alone = price_of_error(0.01, {errors.back()}, errors.back(), REPLICATES, 10);
    EXPECT_LE(alone->low_samples, far->low_samples);
    EXPECT_TRUE(!alone->high_samples || *alone->high_samples > *far->high_samples);
    std::vector<SquaredError> tails = errors;
    tails.back().degrees = 2;
    EXPECT_LT(price_of_error(0.09, tails, tails.back(), REPLICATES, 10)->low_samples,
              *price_of_error(0.09, tails, tails.back(), REPLICATES, 10)->high_samples);
}

TEST(ErrorPrice, WhatCannotBeNamedIsNone) {
    EXPECT_FALSE(price_of_half({}, squared(64, 0), REPLICATES, 1)) << "no error";
    SquaredError black = squared(64, 0.1);
    black.mean_radiance = 0;
    EXPECT_FALSE(price_of_half({}, black, REPLICATES, 1));
    EXPECT_FALSE(price_of_half(falling(0.1, 4), squared(128, 0.5), REPLICATES, 1)) << "it does not fall";
}

} // namespace clrt
