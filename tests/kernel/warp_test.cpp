// SPDX-License-Identifier: Apache-2.0
// numerics/warp.h: each map against a double-precision formula or its range, and its points against its
// density.
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

constexpr size_t SAMPLES = 400000;

const char* const TEXT = R"(
vec4 probe_vec4(real3 v, real w) { return (vec4)(convert_float3(v), (float)w); }
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/warp.h"});
        made.add_text(TEXT);
        made.add<vec4(float, float)>("disc", "(vec4)(warp_disc((real2)(a, b)), 0, 0)");
        made.add<vec4(float, float)>("hemisphere", "const real3 w = warp_cosine_hemisphere((real2)(a, b)); "
                                                   "out = probe_vec4(w, warp_cosine_hemisphere_pdf_w(w.z));");
        made.add<float(float)>("hemisphere_pdf", "warp_cosine_hemisphere_pdf_w(a)");
        made.add<vec4(float, float, float)>("cone",
                                            "probe_vec4(warp_cone((real2)(a, b), c), warp_cone_pdf_w(c))");
        made.add<vec4(float, float)>("triangle", "(vec4)(warp_triangle((real2)(a, b)), 0, 0)");
        made.add<u32(u32, u32)>("index", "warp_index(a, b)");
        made.add<float(u32, u32, u32)>("rest", "warp_rest(a, b, c)");
        return made;
    }();
    return instance;
}

struct Units {
    std::vector<float> x, y;
};

Units random_units(size_t count, u32 seed) {
    Random random(seed);
    Units units;
    for (size_t i = 0; i < count; ++i) {
        units.x.push_back(float(random.unit()));
        units.y.push_back(float(random.unit()));
    }
    return units;
}

/// All pairs of the numbers at the ends, in the middle and at the quarters of the lattice.
Units corner_units() {
    const float numbers[] = {float(FLOAT_U),       0.25f, float(0.5 - FLOAT_U), 0.5f,
                             float(0.5 + FLOAT_U), 0.75f, float(1 - FLOAT_U)};
    Units units;
    for (const float x : numbers)
        for (const float y : numbers) {
            units.x.push_back(x);
            units.y.push_back(y);
        }
    return units;
}

double uniform_p_value(const std::vector<double>& counts) {
    return chi_squared_test(counts, std::vector<double>(counts.size(), total(counts) / double(counts.size())))
        .p_value;
}

size_t bin(double value, size_t bins) {
    return std::min(size_t(std::max(0.0, value) * double(bins)), bins - 1);
}

} // namespace

TEST(Warp, DiscPointsAreShirleyAndChius) {
    Units units = random_units(SAMPLES, 1);
    const Units corners = corner_units();
    units.x.insert(units.x.end(), corners.x.begin(), corners.x.end());
    units.y.insert(units.y.end(), corners.y.begin(), corners.y.end());
    const std::vector<vec4> got = probe().run<vec4>("disc", units.x, units.y);
    for (size_t i = 0; i < got.size(); ++i) {
        const double a = 2.0 * units.x[i] - 1, b = 2.0 * units.y[i] - 1;
        const bool wide = std::abs(a) > std::abs(b);
        const double radius = wide ? a : b;
        const double angle = a == 0 && b == 0 ? 0 : wide ? PI / 4 * b / a : PI / 2 - PI / 4 * a / b;
        ASSERT_NEAR(got[i].x, radius * std::cos(angle), 4 * FLOAT_U) << i;
        ASSERT_NEAR(got[i].y, radius * std::sin(angle), 4 * FLOAT_U) << i;
        ASSERT_LE(std::hypot(double(got[i].x), double(got[i].y)), 1 + 2 * FLOAT_U) << i;
    }
}

TEST(Warp, DiscPointsAreUniform) {
    const Units units = random_units(SAMPLES, 2);
    std::vector<double> counts(32 * 64);
    for (const vec4& p : probe().run<vec4>("disc", units.x, units.y)) {
        const double radius_squared = double(p.x) * p.x + double(p.y) * p.y;
        const double turn = std::atan2(double(p.y), double(p.x)) / (2 * PI) + 0.5;
        ++counts[bin(radius_squared, 32) * 64 + bin(turn, 64)];
    }
    EXPECT_GT(uniform_p_value(counts), SMALLEST_P);
}

TEST(Warp, CosineHemisphereFollowsItsPdf) {
    const SphereCells cells(40, 80, 2);
    std::vector<float> cosines;
    for (const dvec3& node : cells.nodes())
        cosines.push_back(float(node.z));
    const std::vector<float> density = probe().run<float>("hemisphere_pdf", cosines);
    std::vector<double> expected = cells.integrals({density.begin(), density.end()});
    EXPECT_NEAR(total(expected), 1, 1e-6);

    const Units units = random_units(SAMPLES, 3);
    std::vector<dvec3> directions;
    for (const vec4& w : probe().run<vec4>("hemisphere", units.x, units.y)) {
        directions.push_back(to_dvec3(w));
        ASSERT_NEAR(glm::length(directions.back()), 1, 4 * FLOAT_U);
        ASSERT_GE(w.z, 0);
        ASSERT_NEAR(w.w, w.z / PI, 4 * FLOAT_U);
    }
    for (double& cell : expected)
        cell *= double(SAMPLES);
    EXPECT_GT(chi_squared_test(cells.histogram(directions), expected).p_value, SMALLEST_P);
}

TEST(Warp, ConesAreFilledUniformlyDownToTheSmallestSun) {
    const Units units = random_units(SAMPLES, 4);
    for (const double one_minus_cos : {2.0, 1.0, 1e-2, 1e-5, 1e-12}) {
        const float size = float(one_minus_cos);
        const std::vector<vec4> got =
            probe().run<vec4>("cone", units.x, units.y, std::vector<float>(SAMPLES, size));
        std::vector<double> counts(32 * 64);
        for (const vec4& w : got) {
            ASSERT_NEAR(glm::length(to_dvec3(w)), 1, 4 * FLOAT_U);
            // 1 - cos by the sine, which keeps the digits of narrow cones.
            const double sine_squared = double(w.x) * w.x + double(w.y) * w.y;
            const double height =
                w.z > 0 ? sine_squared / (1 + std::sqrt(std::max(0.0, 1 - sine_squared))) : 1.0 - w.z;
            ASSERT_LE(height, size * (1 + 1e-6) + 4 * FLOAT_U * (size > 0.1));
            ++counts[bin(height / size, 32) * 64 +
                     bin(std::atan2(double(w.y), double(w.x)) / (2 * PI) + 0.5, 64)];
        }
        EXPECT_GT(uniform_p_value(counts), SMALLEST_P) << one_minus_cos;
        EXPECT_NEAR(got[0].w * 2 * PI * size, 1, 1e-6) << one_minus_cos;
    }
}

TEST(Warp, TrianglePointsAreInsideAndUniform) {
    const Units units = random_units(SAMPLES, 5);
    const std::vector<vec4> got = probe().run<vec4>("triangle", units.x, units.y);
    // Congruent small triangles: strips of b1 and b2, halves of each square by the diagonal.
    constexpr size_t SIDE = 24;
    std::vector<double> counts;
    std::vector<std::vector<double>> by_cell(SIDE * SIDE, std::vector<double>(2));
    for (const vec4& b : got) {
        ASSERT_TRUE(b.x >= 0 && b.y >= 0 && double(b.x) + b.y <= 1);
        const double x = double(b.x) * SIDE, y = double(b.y) * SIDE;
        const bool upper = x - std::floor(x) + y - std::floor(y) > 1;
        ++by_cell[size_t(y) * SIDE + size_t(x)][upper];
    }
    for (size_t y = 0; y < SIDE; ++y)
        for (size_t x = 0; x < SIDE; ++x) {
            if (x + y < SIDE)
                counts.push_back(by_cell[y * SIDE + x][0]);
            if (x + y + 1 < SIDE)
                counts.push_back(by_cell[y * SIDE + x][1]);
        }
    EXPECT_EQ(counts.size(), SIDE * SIDE);
    EXPECT_EQ(total(counts), double(SAMPLES));
    EXPECT_GT(uniform_p_value(counts), SMALLEST_P);

    const Units corners = corner_units();
    for (const vec4& b : probe().run<vec4>("triangle", corners.x, corners.y))
        EXPECT_TRUE(b.x >= 0 && b.y >= 0 && double(b.x) + b.y <= 1) << b.x << " " << b.y;
}

TEST(Warp, IndicesHaveTheirShareOfWordsAndStayBelowTheCount) {
    Random random(6);
    std::vector<u32> words, counts;
    for (const u32 count : {1u, 2u, 3u, 7u, 1000u, 1u << 20, 10000019u, 0x80000000u, 0xffffffffu})
        for (int i = 0; i < 1000; ++i) {
            // Both sides of the limit between two indices, the ends, and anything.
            const u32 limit = u32((uint64_t(random.word() % count) << 32) / count);
            words.push_back(i % 4 == 0   ? limit
                            : i % 4 == 1 ? limit + 1
                            : i == 2     ? 0xffffffffu
                            : i == 3     ? 0
                                         : random.word());
            counts.push_back(count);
        }
    const std::vector<u32> got = probe().run<u32>("index", words, counts);
    for (size_t i = 0; i < words.size(); ++i) {
        ASSERT_EQ(got[i], u32(uint64_t(words[i]) * counts[i] >> 32)) << words[i] << " " << counts[i];
        ASSERT_LT(got[i], counts[i]);
    }
}

TEST(Warp, IndexAndRestTogetherAreTheWord) {
    Random random(7);
    std::vector<u32> words, counts, fills;
    for (int i = 0; i < 100000; ++i) {
        words.push_back(random.word());
        counts.push_back(1 + random.word() % (1u << random.word() % 31));
        fills.push_back(random.word());
    }
    const std::vector<u32> index = probe().run<u32>("index", words, counts);
    const std::vector<float> rest = probe().run<float>("rest", words, counts, fills);
    for (size_t i = 0; i < words.size(); ++i) {
        ASSERT_TRUE(rest[i] > 0 && rest[i] < 1) << i;
        // The fill adds less than one step of the word, and may carry the rest round from 1 to 0; the rest's
        // lattice is twice FLOAT_U.
        const double step = counts[i] / 4294967296.0;
        const double whole = words[i] * step;
        double added = rest[i] - (whole - index[i]);
        added -= std::floor(added + 2 * FLOAT_U);
        ASSERT_LE(added, step + 2 * FLOAT_U) << words[i] << " " << counts[i];
    }
}

TEST(Warp, RestsAreUniformWhateverTheCount) {
    Random random(8);
    for (const u32 count : {1u, 3u, 640u, 1u << 20, 1u << 28, 3000000019u}) {
        std::vector<u32> words, fills;
        for (size_t i = 0; i < 100000; ++i) {
            words.push_back(random.word());
            fills.push_back(random.word());
        }
        std::vector<double> bins(1000);
        for (const float rest :
             probe().run<float>("rest", words, std::vector<u32>(words.size(), count), fills))
            ++bins[bin(rest, bins.size())];
        EXPECT_GT(uniform_p_value(bins), SMALLEST_P) << count;
    }
}
