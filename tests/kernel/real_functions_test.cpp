// SPDX-License-Identifier: Apache-2.0
// numerics/real_functions.h: errors over the whole range, special values, and the same bits on every device.
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <gtest/gtest.h>
#include <limits>
#include <xxhash.h>

using namespace clrt;

namespace {

constexpr float INF = std::numeric_limits<float>::infinity();
constexpr float NAN_VALUE = std::numeric_limits<float>::quiet_NaN();

/// The header's claims, in units in the last place.
constexpr double EXP_ULP = 0.8, LOG_ULP = 0.8, POW_ULP = 1.0, ATAN2_ULP = 1.5, ACOS_ULP = 1.9;

template <class T>
void add_functions(KernelProbe& probe) {
    probe.add<T(T)>("exp", "real_exp(a)");
    probe.add<T(T)>("log", "real_log(a)");
    probe.add<T(T)>("acos", "real_acos(a)");
    probe.add<T(T, T)>("pow", "real_pow(a, b)");
    probe.add<T(T, T)>("atan2", "real_atan2(a, b)");
}

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/real_functions.h"});
        add_functions<float>(made);
        return made;
    }();
    return instance;
}

KernelProbe& double_probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/real_functions.h"}, {Precision::DOUBLE, {}});
        add_functions<double>(made);
        return made;
    }();
    return instance;
}

/// What a correctly rounded function gives beyond the largest number: infinity.
template <class T, class Wide>
Wide with_overflow(Wide reference) {
    const Wide limit = std::scalbn(Wide(2) - std::numeric_limits<T>::epsilon() / 2,
                                   std::numeric_limits<T>::max_exponent - 1);
    return !(std::abs(reference) >= limit) ? reference : std::copysign(Wide(INFINITY), reference);
}

template <class Wide, class T, class Function>
double worst_ulp(const std::vector<T>& a, const std::vector<T>& got, Function reference) {
    double worst = 0;
    for (size_t i = 0; i < a.size(); ++i)
        worst = std::max(worst, ulp_distance(got[i], with_overflow<T>(Wide(reference(Wide(a[i]))))));
    return worst;
}

template <class Wide, class T, class Function>
double worst_ulp(const std::vector<T>& a, const std::vector<T>& b, const std::vector<T>& got,
                 Function reference) {
    double worst = 0;
    for (size_t i = 0; i < a.size(); ++i)
        worst =
            std::max(worst, ulp_distance(got[i], with_overflow<T>(Wide(reference(Wide(a[i]), Wide(b[i]))))));
    return worst;
}

/// Floats of all exponents and both signs, subnormal, infinite and NaN among them.
std::vector<float> all_kinds_of_floats(u32 step) {
    std::vector<float> values;
    for (std::uint64_t bits = 0; bits < 1ull << 32; bits += step)
        values.push_back(bits_to_float(u32(bits)));
    return values;
}

/// Numbers of a function's interesting range, evenly spread.
template <class T>
std::vector<T> between(double low, double high, int count) {
    std::vector<T> values;
    for (int i = 0; i <= count; ++i)
        values.push_back(T(low + (high - low) * i / count));
    return values;
}

template <class Wide, class T>
void check_pow(KernelProbe& probe, int count, double limit) {
    // The exponent follows from the logarithm of the result, so that all results occur, subnormal ones too.
    Random random(3);
    std::vector<T> x, y;
    const double lowest = std::log(double(std::numeric_limits<T>::min())) - 16, highest = -lowest + 17;
    for (int i = 0; i < count; ++i) {
        double base = i % 3 ? std::exp(random.between(-80, 80)) : 1 + random.signed_log(1e-7, 0.5);
        if (T(base) == 1)
            base = 0.5;
        x.push_back(T(base));
        y.push_back(T(random.between(lowest, highest) / std::log(double(x.back()))));
    }
    const auto power = [](Wide a, Wide b) { return std::pow(a, b); };
    EXPECT_LT((worst_ulp<Wide>(x, y, probe.run<T>("pow", x, y), power)), limit);
}

template <class Wide, class T>
void check_atan2(KernelProbe& probe, int count) {
    Random random(4);
    std::vector<T> y, x;
    for (int i = 0; i < count; ++i) {
        const bool is_near = i % 2 != 0;
        y.push_back(T(is_near ? random.between(-1, 1) : random.signed_log(1e-30, 1e30)));
        x.push_back(T(is_near ? random.between(-1, 1) : random.signed_log(1e-30, 1e30)));
    }
    const auto angle = [](Wide a, Wide b) { return std::atan2(a, b); };
    EXPECT_LT((worst_ulp<Wide>(y, x, probe.run<T>("atan2", y, x), angle)), ATAN2_ULP);
}

} // namespace

TEST(RealFunctions, ExpAndLogAreWithinAnUlpForAllFloats) {
    const std::vector<float> all = all_kinds_of_floats(1021);
    const auto exponential = [](double x) { return std::exp(x); };
    const auto logarithm = [](double x) { return std::log(x); };
    EXPECT_LT(worst_ulp<double>(all, probe().run<float>("exp", all), exponential), EXP_ULP);
    EXPECT_LT(worst_ulp<double>(all, probe().run<float>("log", all), logarithm), LOG_ULP);
    const std::vector<float> range = between<float>(-104, 89, 1 << 20);
    EXPECT_LT(worst_ulp<double>(range, probe().run<float>("exp", range), exponential), EXP_ULP);
    const std::vector<float> near_one = between<float>(0.5, 2, 1 << 20);
    EXPECT_LT(worst_ulp<double>(near_one, probe().run<float>("log", near_one), logarithm), LOG_ULP);
}

TEST(RealFunctions, PowIsWithinAnUlpForAllResults) {
    check_pow<double, float>(probe(), 1 << 20, POW_ULP);
}

TEST(RealFunctions, AnglesAreWithinTwoUlp) {
    check_atan2<double, float>(probe(), 1 << 20);
    const std::vector<float> cosines = between<float>(-1, 1, 1 << 20);
    EXPECT_LT(worst_ulp<double>(cosines, probe().run<float>("acos", cosines),
                                [](double x) { return std::acos(x); }),
              ACOS_ULP);
}

TEST(RealFunctions, InDoubleTheyAreAsExact) {
    if (!test_device().info.fp64) {
        EXPECT_THROW(double_probe().program(), DeviceError);
        return;
    }
    const std::vector<double> range = between<double>(-746, 710, 1 << 17),
                              ratio = between<double>(0.4, 2.1, 1 << 17);
    std::vector<double> sizes, cosines = between<double>(-1, 1, 1 << 17);
    Random random(5);
    for (int i = 0; i < 1 << 17; ++i)
        sizes.push_back(std::exp(random.between(-744, 709)));
    const auto logarithm = [](long double x) { return std::log(x); };
    EXPECT_LT(worst_ulp<long double>(range, double_probe().run<double>("exp", range),
                                     [](long double x) { return std::exp(x); }),
              EXP_ULP);
    EXPECT_LT(worst_ulp<long double>(ratio, double_probe().run<double>("log", ratio), logarithm), LOG_ULP);
    EXPECT_LT(worst_ulp<long double>(sizes, double_probe().run<double>("log", sizes), logarithm), LOG_ULP);
    EXPECT_LT(worst_ulp<long double>(cosines, double_probe().run<double>("acos", cosines),
                                     [](long double x) { return std::acos(x); }),
              ACOS_ULP);
    check_pow<long double, double>(double_probe(), 1 << 17, POW_ULP);
    check_atan2<long double, double>(double_probe(), 1 << 17);
}

TEST(RealFunctions, SpecialValuesAreThoseOfTheCStandard) {
    const std::vector<float> special = {0.0f, -0.0f, 1.0f,      -1.0f,   0.5f,   2.0f,
                                        3.0f, -3.0f, 1e-45f,    -1e-45f, 3e38f,  -3e38f,
                                        INF,  -INF,  NAN_VALUE, 1e-38f,  100.0f, -100.0f};
    std::vector<float> a, b, powers_a, powers_b;
    for (const float x : special)
        for (const float y : special) {
            a.push_back(x);
            b.push_back(y);
            // Powers of negative numbers are left out.
            if (!std::signbit(x)) {
                powers_a.push_back(x);
                powers_b.push_back(y);
            }
        }
    const auto same = [](float got, double expected) {
        return std::isnan(expected)
                   ? std::isnan(got)
                   : got == float(expected) || std::abs(got - expected) < 3e-7 * std::abs(expected);
    };
    const std::vector<float> angles = probe().run<float>("atan2", a, b);
    for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_TRUE(same(angles[i], std::atan2(double(a[i]), double(b[i]))))
            << a[i] << " " << b[i] << " " << angles[i];
        if (!std::isnan(angles[i])) {
            EXPECT_EQ(std::signbit(angles[i]), std::signbit(a[i])) << a[i] << " " << b[i];
        }
    }
    const std::vector<float> powers = probe().run<float>("pow", powers_a, powers_b);
    for (size_t i = 0; i < powers.size(); ++i)
        EXPECT_TRUE(same(powers[i], float(std::pow(double(powers_a[i]), double(powers_b[i])))))
            << powers_a[i] << " " << powers_b[i] << " " << powers[i];
    const std::vector<float> below =
        probe().run<float>("pow", std::vector<float>{-1, -0.5f, -INF}, std::vector<float>{2, 0.5f, 3});
    for (const float value : below)
        EXPECT_TRUE(std::isnan(value));
    for (const float value :
         probe().run<float>("acos", std::vector<float>{-1.0001f, 1.0001f, INF, NAN_VALUE}))
        EXPECT_TRUE(std::isnan(value));
}

TEST(RealFunctions, GiveTheSameBitsOnEveryDevice) {
    const std::vector<float> all = all_kinds_of_floats(65537), shifted = [&] {
        std::vector<float> values = all;
        std::rotate(values.begin(), values.begin() + 12345, values.end());
        return values;
    }();
    const std::vector<float> bases = between<float>(0, 1.5, 65535),
                             exponents = between<float>(1000, 0, 65535);
    const auto digest = [](std::vector<float> values) {
        for (float& value : values)
            value = std::isnan(value) ? NAN_VALUE : value; // which NaN is up to the device
        return XXH3_64bits(values.data(), values.size() * sizeof(float));
    };
    // The bits are fixed by the text of the functions: they change with it, and with nothing else.
    EXPECT_EQ(digest(probe().run<float>("exp", all)), 11435483747849204478u);
    EXPECT_EQ(digest(probe().run<float>("log", all)), 11528613773795742759u);
    EXPECT_EQ(digest(probe().run<float>("acos", all)), 835832449354686685u);
    EXPECT_EQ(digest(probe().run<float>("pow", bases, exponents)), 17201335946604580406u);
    EXPECT_EQ(digest(probe().run<float>("atan2", all, shifted)), 2355092239593444429u);
}
