// SPDX-License-Identifier: Apache-2.0
// The statistics that other tests rely on, against published values.
#include "probes/statistics.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <stdexcept>

using namespace clrt;

TEST(Statistics, MomentsOfKnownValues) {
    const Moments moments = moments_of({2, 4, 4, 4, 5, 5, 7, 9});
    EXPECT_DOUBLE_EQ(moments.mean, 5);
    EXPECT_DOUBLE_EQ(moments.variance, 32.0 / 7);
    EXPECT_DOUBLE_EQ(moments.variance_of_mean(), 4.0 / 7);
    EXPECT_EQ(moments_of({3}).variance, 0);
}

TEST(Statistics, NormalPValuesAreThoseOfTables) {
    EXPECT_DOUBLE_EQ(normal_p_value(0), 1);
    EXPECT_NEAR(normal_p_value(1.959963984540054), 0.05, 1e-12);
    EXPECT_NEAR(normal_p_value(-2.5758293035489004), 0.01, 1e-12);
}

TEST(Statistics, ZOfAMeanCountsStandardErrors) {
    EXPECT_DOUBLE_EQ(z_of_mean({100, 5.5, 25}, 5), 1);
    EXPECT_EQ(z_of_mean({100, 5, 0}, 5), 0);
    EXPECT_EQ(z_of_mean({100, 4, 0}, 5), -std::numeric_limits<double>::infinity());
}

TEST(Statistics, ChiSquaredPValuesAreThoseOfTables) {
    EXPECT_NEAR(chi_squared_p_value(3.841458820694124, 1), 0.05, 1e-12);
    EXPECT_NEAR(chi_squared_p_value(18.307038053275146, 10), 0.05, 1e-12);
    EXPECT_NEAR(chi_squared_p_value(3.9402991361190605, 10), 0.95, 1e-12);
    EXPECT_NEAR(chi_squared_p_value(124.34211340400408, 100), 0.05, 1e-12);
    for (const double x : {0.5, 2.0, 30.0}) // two degrees: exp(-x/2)
        EXPECT_NEAR(chi_squared_p_value(x, 2) / std::exp(-x / 2), 1, 1e-12);
    EXPECT_NEAR(chi_squared_p_value(1e6, 1e6), 0.5, 1e-3);
}

TEST(Statistics, ChiSquaredTestAcceptsFairAndRefusesLoadedDice) {
    const std::vector<double> fair(6, 10);
    const ChiSquared loaded = chi_squared_test({5, 8, 9, 8, 10, 20}, fair);
    EXPECT_DOUBLE_EQ(loaded.statistic, 13.4);
    EXPECT_EQ(loaded.degrees, 5);
    EXPECT_NEAR(loaded.p_value, 0.019905220334784368, 1e-12);
    EXPECT_GT(chi_squared_test({9, 11, 10, 8, 12, 10}, fair).p_value, 0.9);
}

TEST(Statistics, ChiSquaredTestPoolsSmallCells) {
    const ChiSquared pooled = chi_squared_test({1, 3, 2, 100, 94}, {2, 2, 2, 97, 97});
    EXPECT_EQ(pooled.degrees, 2); // the three small cells are one
    EXPECT_DOUBLE_EQ(pooled.statistic, 18.0 / 97);
    EXPECT_EQ(chi_squared_test({1, 50, 50}, {0, 50, 51}).p_value, 0);
    EXPECT_GT(chi_squared_test({0, 50, 50}, {0, 50, 50}).p_value, 0.99);
}

TEST(Statistics, PValuesOfTrueHypothesesAreUniform) {
    std::mt19937 random(1);
    std::vector<double> below_tenth(10);
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<double> counts(20);
        for (int i = 0; i < 1000; ++i)
            counts[random() % 20] += 1;
        const double p = chi_squared_test(counts, std::vector<double>(20, 50)).p_value;
        below_tenth[std::min<size_t>(9, static_cast<size_t>(p * 10))] += 1;
    }
    EXPECT_GT(chi_squared_test(below_tenth, std::vector<double>(10, 200)).p_value, 1e-3);
}

TEST(Statistics, WelchTestAgreesWithIntegratedDensity) {
    // Two samples of 15; p by numerical integration of Student's density.
    const Moments a = moments_of(
        {27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1, 21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4});
    const Moments b = moments_of(
        {27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0, 24.8, 20.2, 21.9, 22.1, 22.9, 30.5, 24.4});
    const Welch welch = welch_test(a, b);
    EXPECT_NEAR(welch.t, -2.852954870171521, 1e-12);
    EXPECT_NEAR(welch.degrees, 27.88730398842012, 1e-10);
    EXPECT_NEAR(welch.p_value, 0.00807193817224705, 1e-10);
    EXPECT_EQ(welch_test({10, 1, 0}, {10, 1, 0}).p_value, 1);
    EXPECT_EQ(welch_test({10, 1, 0}, {10, 2, 0}).p_value, 0);
}

TEST(Statistics, WrongUseIsRefused) {
    EXPECT_THROW(chi_squared_test({1, 2}, {1}), std::invalid_argument);
    EXPECT_THROW(chi_squared_p_value(1, 0), std::invalid_argument);
    EXPECT_THROW(welch_test({1, 1, 0}, {2, 1, 0}), std::invalid_argument);
}

TEST(Statistics, UlpDistancesAreMeasuredAtTheReference) {
    EXPECT_EQ(ulp_distance(1.0f, 1.0), 0);
    EXPECT_EQ(ulp_distance(std::nextafter(1.0f, 2.0f), 1.0), 1);
    EXPECT_EQ(ulp_distance(std::nextafter(1.0f, 0.0f), 1.0), 0.5);
    EXPECT_EQ(ulp_distance(std::nextafter(-1000.0f, 0.0f), -1000.0), 1);
    EXPECT_NEAR(ulp_distance(0.1f, 0.1), 0.2, 1e-7);
    EXPECT_EQ(ulp_distance(std::numeric_limits<float>::denorm_min(), 0.0), 1);
    EXPECT_EQ(ulp_distance(std::nextafter(1.0, 2.0), 1.0L), 1);
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(ulp_distance(std::nanf(""), 1.0), infinity);
    EXPECT_EQ(ulp_distance(std::nanf(""), std::nan("")), 0);
    EXPECT_EQ(ulp_distance(std::numeric_limits<float>::infinity(), infinity), 0);
    EXPECT_EQ(ulp_distance(std::numeric_limits<float>::max(), infinity), infinity);
}
