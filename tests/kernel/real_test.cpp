// SPDX-License-Identifier: Apache-2.0
// numerics/real.h: sine and cosine, differences of products, NaN and infinity by their bits; software_fma.h.
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <gtest/gtest.h>
#include <limits>

using namespace clrt;

namespace {

/// The polynomials' claim, in units in the last place.
constexpr double QUARTER_ULP = 1;
/// One for the polynomial, a half each for pi / 4 as a float and for the product with it.
constexpr double TURN_ULP = 2;
/// Kahan's difference of products (Jeannerod, Louvet and Muller 2013).
constexpr double DIFFERENCE_ULP = 1.5;

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/real.h"});
        made.add<float(float)>("sin_quarter", "real_sin_cos_quarter(a).x");
        made.add<float(float)>("cos_quarter", "real_sin_cos_quarter(a).y");
        made.add<float(float)>("sin_turn", "real_sin_cos_turn(a).x");
        made.add<float(float)>("cos_turn", "real_sin_cos_turn(a).y");
        made.add<float(float, float, float, float)>("difference", "real_difference_of_products(a, b, c, d)");
        made.add<u32(u32)>("class",
                           "(real_is_nan(as_float(a)) ? 1u : 0u) | (real_is_finite(as_float(a)) ? 2u : 0u)");
        made.add<float(float)>("root", "real_root(a)");
        return made;
    }();
    return instance;
}

KernelProbe& fma_probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/software_fma.h"});
        made.add<float(float, float, float)>("one", "software_fma(a, b, c)");
        made.add<float(float, float, float)>("last",
                                             "software_fma((float8)(1, 2, 3, 4, 5, 6, 7, a), (float8)(b), "
                                             "(float8)(c)).s7");
        return made;
    }();
    return instance;
}

KernelProbe& double_probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/real.h"}, {Precision::DOUBLE, {}});
        made.add<double(double)>("sin_quarter", "real_sin_cos_quarter(a).x");
        made.add<double(double)>("cos_quarter", "real_sin_cos_quarter(a).y");
        made.add<u32(u32, u32)>("class", "const real x = as_double(((ulong)a << 32) | b);"
                                         "out = (real_is_nan(x) ? 1u : 0u) | (real_is_finite(x) ? 2u : 0u);");
        return made;
    }();
    return instance;
}

/// Largest distance of device values from a function of the inputs, in ulp.
template <class T, class Function>
double worst_ulp(const std::vector<T>& inputs, const std::vector<T>& got, Function reference) {
    double worst = 0;
    for (size_t i = 0; i < inputs.size(); ++i)
        worst = std::max(worst, ulp_distance(got[i], reference(inputs[i])));
    return worst;
}

} // namespace

TEST(Real, SineAndCosineOfAQuarterAreWithinOneUlp) {
    std::vector<float> angles = {0.0f, -0.0f, 1e-30f, -1e-10f, 1e-4f};
    const int steps = 1 << 20;
    for (int i = -steps; i <= steps; ++i)
        angles.push_back(float(PI / 4 * i / steps));
    const auto sine = [](double x) { return std::sin(x); };
    const auto cosine = [](double x) { return std::cos(x); };
    EXPECT_LT(worst_ulp(angles, probe().run<float>("sin_quarter", angles), sine), QUARTER_ULP);
    EXPECT_LT(worst_ulp(angles, probe().run<float>("cos_quarter", angles), cosine), QUARTER_ULP);
}

TEST(Real, SineAndCosineInDoubleAreWithinOneUlp) {
    if (!test_device().info.fp64) {
        EXPECT_THROW(double_probe().program(), DeviceError);
        return;
    }
    std::vector<double> angles;
    const int steps = 1 << 16;
    for (int i = -steps; i <= steps; ++i)
        angles.push_back(PI / 4 * i / steps);
    const auto sine = [](long double x) { return std::sin(x); };
    const auto cosine = [](long double x) { return std::cos(x); };
    EXPECT_LT(worst_ulp(angles, double_probe().run<double>("sin_quarter", angles), sine), QUARTER_ULP);
    EXPECT_LT(worst_ulp(angles, double_probe().run<double>("cos_quarter", angles), cosine), QUARTER_ULP);
}

TEST(Real, SineAndCosineOfATurnKeepTheirDigitsNearEveryZero) {
    std::vector<float> turns;
    for (u32 k = 1; k < 1u << 24; k += 30)
        turns.push_back(float(k * FLOAT_U));
    // Both sides of each eighth, where the octant changes.
    for (int eighth = 0; eighth <= 8; ++eighth)
        for (int k = -8; k <= 8; ++k)
            if (const double u = eighth / 8.0 + k * FLOAT_U; u >= 0 && u <= 1)
                turns.push_back(float(u));
    // Reduced like the kernel, but exactly: the distance to the nearest quarter is exact in double.
    const auto sine = [](double u) {
        const double quarter = std::nearbyint(4 * u), rest = 2 * PI * (u - quarter / 4);
        const int q = int(quarter) & 3;
        return q == 0 ? std::sin(rest) : q == 1 ? std::cos(rest) : q == 2 ? -std::sin(rest) : -std::cos(rest);
    };
    const auto cosine = [&](double u) { return u < 0.75 ? sine(u + 0.25) : sine(u - 0.75); };
    EXPECT_LT(worst_ulp(turns, probe().run<float>("sin_turn", turns), sine), TURN_ULP);
    EXPECT_LT(worst_ulp(turns, probe().run<float>("cos_turn", turns), cosine), TURN_ULP);

    const std::vector<float> quarters = {0, 0.25f, 0.5f, 0.75f, 1};
    EXPECT_EQ(probe().run<float>("sin_turn", quarters), (std::vector<float>{0, 1, 0, -1, 0}));
    EXPECT_EQ(probe().run<float>("cos_turn", quarters), (std::vector<float>{1, 0, -1, 0, 1}));
}

TEST(SoftwareFma, IsRoundedOnceLikeThatOfTheProcessor) {
    Random random(2);
    std::vector<float> a, b, c;
    const auto add = [&](double x, double y, double z) {
        a.push_back(float(x)), b.push_back(float(y)), c.push_back(float(z));
    };
    for (int i = 0; i < 400000; ++i) {
        // Few digits make ties; summands near the product cancel; far ones decide ties.
        const double size = i % 3 == 0 ? 1e3 : i % 3 == 1 ? 1e15 : 1e-20;
        const double x = std::ldexp(random.word() >> (random.word() % 32), -12) * size,
                     y = random.signed_log(1e-3, 1e3);
        const double far = std::ldexp(1, int(random.word() % 80) - 40);
        add(x, y, i % 2 ? random.signed_log(1e-3, 1e3) * x * y * far : -x * y * (1 + (i % 17 - 8) * FLOAT_U));
    }
    // Just beside a tie, by less than any sum of two floats holds.
    for (int n = 1; n < 4000; ++n) {
        const double part = n * 2 * FLOAT_U, odd = 1 + (random.word() >> 9 | 1u) * 2 * FLOAT_U;
        add(FLOAT_U * (1 - part), n % 2 ? 1 + part : -1 - part, odd);
    }
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double x : {0.0, -0.0, 1.0, -3e38, 1e-38, 2e-45, infinity})
        for (const double y : {0.0, -0.0, -1.0, 2e38, 1e-38, -infinity})
            for (const double z : {0.0, -0.0, 1.0, 3e38, -1e-30})
                add(x, y, z);
    for (const char* name : {"one", "last"}) {
        const std::vector<float> results = fma_probe().run<float>(name, a, b, c);
        int bad = 0;
        for (size_t i = 0; i < a.size(); ++i) {
            const float expected = std::fma(a[i], b[i], c[i]);
            // The last bit of what is smaller than normal numbers is free.
            const bool is_same = std::fabs(expected) < std::numeric_limits<float>::min()
                                     ? std::fabs(expected - results[i]) <= 1.5e-45f
                                     : float_to_bits(expected) == float_to_bits(results[i]) ||
                                           (std::isnan(expected) && std::isnan(results[i]));
            if (!is_same && ++bad < 5)
                ADD_FAILURE() << a[i] << " * " << b[i] << " + " << c[i] << ": " << expected << ", "
                              << results[i];
        }
        EXPECT_EQ(bad, 0) << name;
    }
}

TEST(Real, DifferencesOfNearlyEqualProductsKeepDigitsAndSign) {
    Random random(1);
    std::vector<float> a, b, c, d;
    for (int i = 0; i < 400000; ++i) {
        a.push_back(float(random.signed_log(1e-3, 1e3)));
        b.push_back(float(random.signed_log(1e-3, 1e3)));
        c.push_back(float(random.signed_log(1e-3, 1e3)));
        // Products that agree up to k ulp, every other time.
        const double equal = double(a[i]) * b[i] / c[i];
        d.push_back(float(i % 2 ? equal * (1 + (i % 17 - 8) * 2 * FLOAT_U) : random.signed_log(1e-3, 1e3)));
    }
    const std::vector<float> got = probe().run<float>("difference", a, b, c, d);
    double worst = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        // 48-bit products are exact here, and so is the difference where it cancels.
        const long double exact = (long double)a[i] * b[i] - (long double)c[i] * d[i];
        worst = std::max(worst, ulp_distance(got[i], double(exact)));
        ASSERT_EQ(got[i] > 0, exact > 0) << i;
        ASSERT_EQ(got[i] < 0, exact < 0) << i;
    }
    EXPECT_LE(worst, DIFFERENCE_ULP);
}

TEST(Real, NanAndInfinityAreFoundByTheirBits) {
    Random random(2);
    std::vector<u32> words = {0,          0x80000000u, 1,           0x007fffffu, 0x7f7fffffu, 0xff7fffffu,
                              0x7f800000, 0xff800000u, 0x7f800001u, 0xff800001u, 0x7fc00000u, 0xffffffffu};
    for (int i = 0; i < 100000; ++i)
        words.push_back(i % 2 ? random.word() : random.word() | 0x7f800000u);
    const std::vector<u32> got = probe().run<u32>("class", words);
    for (size_t i = 0; i < words.size(); ++i) {
        const float value = bits_to_float(words[i]);
        ASSERT_EQ(got[i], (std::isnan(value) ? 1u : 0u) | (std::isfinite(value) ? 2u : 0u)) << words[i];
    }
}

TEST(Real, NanAndInfinityOfDoublesAreFoundByTheirBits) {
    if (!test_device().info.fp64) {
        EXPECT_THROW(double_probe().program(), DeviceError);
        return;
    }
    const std::vector<u32> high = {0,           0x7fefffffu, 0x7ff00000u, 0xfff00000u,
                                   0x7ff00000u, 0xfff80000u, 0xffffffffu};
    const std::vector<u32> low = {1, 0xffffffffu, 0, 0, 1, 0, 0xffffffffu};
    EXPECT_EQ(double_probe().run<u32>("class", high, low), (std::vector<u32>{2, 2, 0, 0, 1, 1, 1}));
}

TEST(Real, RootTreatsRoundingBelowZeroAsZero) {
    EXPECT_EQ(probe().run<float>("root", std::vector<float>{4, 0, -1e-8f, -0.0f}),
              (std::vector<float>{2, 0, 0, 0}));
}
