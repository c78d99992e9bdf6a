// SPDX-License-Identifier: Apache-2.0
// numerics/vector.h and numerics/frame.h: products, cross products of nearly parallel vectors, orthonormal
// frames.
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <gtest/gtest.h>
#include <limits>

using namespace clrt;
using glm::dvec3;

namespace {

/// Components are unit vectors' rounded to float, so lengths and dots are off by 3 u before anything is
/// computed.
constexpr double ORTHONORMAL = 6 * FLOAT_U;

const char* const TEXT = R"(
vec4 probe_vec4(real3 v, real w) { return (vec4)(convert_float3(v), (float)w); }
vec4 probe_axis(const Frame* frame, u32 axis)
{
    return probe_vec4(axis == 0 ? frame->x : axis == 1 ? frame->y : frame->z, REAL(0.0));
}
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"numerics/frame.h"});
        made.add_text(TEXT);
        made.add<vec4(vec4, vec4)>("cross",
                                   "probe_vec4(vector_cross(vector_from(a), vector_from(b)), REAL(0.0))");
        made.add<float(vec4, vec4)>("dot", "vector_dot(vector_from(a), vector_from(b))");
        made.add<vec4(vec4)>("normalize",
                             "probe_vec4(vector_normalize(vector_from(a)), vector_length(vector_from(a)))");
        made.add<vec4(vec4)>("scalars",
                             "(vec4)(vector_max_component(vector_from(a)), "
                             "vector_max_abs(vector_from(a)), vector_luminance(vector_from(a)), 0)");
        made.add<u32(vec4)>("predicates", "(vector_is_black(vector_from(a)) ? 1u : 0u) | "
                                          "(vector_is_zero(vector_from(a)) ? 2u : 0u) | "
                                          "(vector_is_finite(vector_from(a)) ? 4u : 0u)");
        made.add<vec4(vec4, vec4, float)>(
            "mix", "probe_vec4(vector_mix(vector_from(a), vector_from(b), c), REAL(0.0))");
        made.add<vec4(vec4, u32)>("frame",
                                  "const Frame f = frame_make(vector_from(a)); out = probe_axis(&f, b);");
        made.add<vec4(vec4, vec4, u32)>(
            "tangent_frame",
            "const Frame f = frame_make_tangent(vector_from(a), vector_from(b)); out = probe_axis(&f, c);");
        made.add<vec4(vec4, vec4)>("round_trip",
                                   "const Frame f = frame_make(vector_from(a));"
                                   "out = probe_vec4(frame_to_world(&f, frame_to_local(&f, vector_from(b))), "
                                   "frame_to_local(&f, vector_from(b)).z);");
        return made;
    }();
    return instance;
}

struct Axes {
    std::vector<vec4> x, y, z;
};

/// The largest departure of frames from right-handed orthonormal ones.
double departure(const Axes& axes) {
    double worst = 0;
    for (size_t i = 0; i < axes.x.size(); ++i) {
        const dvec3 x = to_dvec3(axes.x[i]), y = to_dvec3(axes.y[i]), z = to_dvec3(axes.z[i]);
        const double dots[] = {glm::dot(x, y),
                               glm::dot(y, z),
                               glm::dot(z, x),
                               glm::length(x) - 1,
                               glm::length(y) - 1,
                               glm::length(z) - 1,
                               glm::dot(glm::cross(x, y), z) - 1};
        for (const double dot : dots)
            worst =
                std::isnan(dot) ? std::numeric_limits<double>::infinity() : std::max(worst, std::abs(dot));
    }
    return worst;
}

Axes frames(const std::vector<vec4>& normals) {
    const auto axis = [&](u32 k) {
        return probe().run<vec4>("frame", normals, std::vector<u32>(normals.size(), k));
    };
    return {axis(0), axis(1), axis(2)};
}

Axes tangent_frames(const std::vector<vec4>& normals, const std::vector<vec4>& tangents) {
    const auto axis = [&](u32 k) {
        return probe().run<vec4>("tangent_frame", normals, tangents, std::vector<u32>(normals.size(), k));
    };
    return {axis(0), axis(1), axis(2)};
}

/// Random normals, the axes, both zeros, and the neighbourhood of the pole where the construction is
/// singular.
std::vector<vec4> hard_normals() {
    std::vector<vec4> normals = {{1, 0, 0, 0},     {-1, 0, 0, 0},      {0, 1, 0, 0},
                                 {0, -1, 0, 0},    {0, 0, 1, 0},       {0, 0, -1, 0},
                                 {1, 0, -0.0f, 0}, {0, -1, -0.0f, 0},  {-0.0f, -0.0f, -1, 0},
                                 {-0.0f, 0, 1, 0}, {0.6f, 0.8f, 0, 0}, {0.6f, -0.8f, -0.0f, 0}};
    Random random(1);
    for (int k = 1; k <= 64; ++k)
        for (const double sign : {-1.0, 1.0})
            normals.push_back(to_vec4(direction_at(sign * (1 - k * FLOAT_U), 2 * PI * random.unit())));
    for (int k = 0; k < 1000; ++k) // close to the equator, where the sign changes
        normals.push_back(to_vec4(direction_at(random.signed_log(1e-30, 1e-3), 2 * PI * random.unit())));
    while (normals.size() < 100000)
        normals.push_back(to_vec4(random.direction()));
    return normals;
}

} // namespace

TEST(Vector, CrossProductsOfNearlyParallelVectorsKeepTheirDigits) {
    Random random(2);
    std::vector<vec4> a, b;
    for (int i = 0; i < 200000; ++i) {
        const dvec3 v = random.direction() * random.between(0.1, 10);
        a.push_back(to_vec4(v));
        b.push_back(to_vec4(v * random.between(0.5, 2) + random.direction() * random.signed_log(1e-7, 1)));
    }
    const std::vector<vec4> got = probe().run<vec4>("cross", a, b);
    double worst = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        // Exact in double: products of two floats have 48 bits and the differences cancel.
        const dvec3 exact = glm::cross(to_dvec3(a[i]), to_dvec3(b[i]));
        worst = std::max({worst, ulp_distance(got[i].x, exact.x), ulp_distance(got[i].y, exact.y),
                          ulp_distance(got[i].z, exact.z)});
    }
    EXPECT_LE(worst, 1.5); // Kahan's difference of products
}

TEST(Vector, DotProductsHaveThreeRoundings) {
    Random random(3);
    std::vector<vec4> a, b;
    for (int i = 0; i < 100000; ++i) {
        a.push_back(to_vec4(random.in_cube(10)));
        b.push_back(to_vec4(random.in_cube(10)));
    }
    const std::vector<float> got = probe().run<float>("dot", a, b);
    double worst = 0;
    for (size_t i = 0; i < got.size(); ++i) {
        const dvec3 products = to_dvec3(a[i]) * to_dvec3(b[i]);
        const double size = std::abs(products.x) + std::abs(products.y) + std::abs(products.z);
        worst = std::max(worst, std::abs(got[i] - (products.x + products.y + products.z)) / size);
    }
    EXPECT_LE(worst, 3 * FLOAT_U);
}

TEST(Vector, NormalizedVectorsHaveLengthOneAndKeepTheirDirection) {
    Random random(4);
    std::vector<vec4> v;
    for (int i = 0; i < 100000; ++i)
        v.push_back(to_vec4(random.direction() * std::abs(random.signed_log(1e-15, 1e15))));
    const std::vector<vec4> got = probe().run<vec4>("normalize", v);
    for (size_t i = 0; i < v.size(); ++i) {
        const dvec3 exact = glm::normalize(to_dvec3(v[i])), unit = to_dvec3(got[i]);
        ASSERT_LE(glm::length(unit - exact), ORTHONORMAL) << i;
        ASSERT_NEAR(got[i].w / glm::length(to_dvec3(v[i])), 1, ORTHONORMAL) << i;
    }
}

TEST(Vector, ScalarsOfColoursAreTheLargestComponentAndTheLuminance) {
    const std::vector<vec4> got = probe().run<vec4>(
        "scalars",
        std::vector<vec4>{{1, 1, 1, 0}, {-5, 2, 3, 0}, {3, -7, 2, 0}, {0, 0, 1, 0}, {0.25f, 0.5f, 0.75f, 0}});
    const double largest[] = {1, 3, 3, 1, 0.75}, absolute[] = {1, 5, 7, 1, 0.75};
    const double luminance[] = {1, 0.2126 * -5 + 0.7152 * 2 + 0.0722 * 3,
                                0.2126 * 3 - 0.7152 * 7 + 0.0722 * 2, 0.0722,
                                0.2126 * 0.25 + 0.7152 * 0.5 + 0.0722 * 0.75};
    for (size_t i = 0; i < got.size(); ++i) {
        EXPECT_EQ(got[i].x, largest[i]);
        EXPECT_EQ(got[i].y, absolute[i]);
        EXPECT_NEAR(got[i].z, luminance[i], 4e-7);
    }
}

TEST(Vector, PredicatesSeeNanInfinityAndBothZeros) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    const std::vector<vec4> v = {{0, 0, 0, 1},   {0, -0.0f, 0, 0}, {1e-45f, 0, 0, 0}, {0, 0, 1, 0},
                                 {nan, 0, 0, 0}, {0, inf, 0, 0},   {0, 0, -inf, 0},   {0, 0, nan, 0}};
    enum { BLACK = 1, ZERO = 2, FINITE = 4 };
    EXPECT_EQ(probe().run<u32>("predicates", v),
              (std::vector<u32>{BLACK | ZERO | FINITE, BLACK | ZERO | FINITE, FINITE, FINITE, 0, 0, 0, 0}));
}

TEST(Vector, MixReturnsItsFirstArgumentExactlyAtZero) {
    Random random(5);
    std::vector<vec4> a, b;
    std::vector<float> t;
    for (int i = 0; i < 1000; ++i) {
        a.push_back(to_vec4(random.in_cube(1)));
        b.push_back(to_vec4(random.in_cube(1e6)));
        t.push_back(i < 500 ? 0 : float(random.unit()));
    }
    const std::vector<vec4> got = probe().run<vec4>("mix", a, b, t);
    for (size_t i = 0; i < got.size(); ++i) {
        const double exact = a[i].y + double(t[i]) * (double(b[i].y) - a[i].y);
        ASSERT_TRUE(t[i] != 0 || (got[i].x == a[i].x && got[i].y == a[i].y && got[i].z == a[i].z)) << i;
        ASSERT_NEAR(got[i].y, exact, 3 * FLOAT_U * (std::abs(exact) + std::abs(double(b[i].y)))) << i;
    }
}

TEST(Frame, FramesOfAllNormalsAreOrthonormalAndRightHanded) {
    const std::vector<vec4> normals = hard_normals();
    const Axes axes = frames(normals);
    EXPECT_LE(departure(axes), ORTHONORMAL);
    for (size_t i = 0; i < normals.size(); ++i)
        ASSERT_TRUE(axes.z[i].x == normals[i].x && axes.z[i].y == normals[i].y && axes.z[i].z == normals[i].z)
            << i;
}

TEST(Frame, LocalAndWorldAreInverseAndZIsTheCosine) {
    const std::vector<vec4> normals = hard_normals();
    Random random(6);
    std::vector<vec4> v;
    for (size_t i = 0; i < normals.size(); ++i)
        v.push_back(to_vec4(random.direction()));
    const std::vector<vec4> got = probe().run<vec4>("round_trip", normals, v);
    for (size_t i = 0; i < v.size(); ++i) {
        ASSERT_LE(glm::length(to_dvec3(got[i]) - to_dvec3(v[i])), 3 * ORTHONORMAL) << i;
        ASSERT_NEAR(got[i].w, glm::dot(to_dvec3(normals[i]), to_dvec3(v[i])), ORTHONORMAL) << i;
    }
}

TEST(Frame, TangentFramesTurnXToTheTangentWhateverItsLength) {
    std::vector<vec4> normals = hard_normals(), tangents;
    Random random(7);
    std::vector<double> sines;
    for (vec4& normal : normals) {
        const dvec3 n = glm::normalize(to_dvec3(normal));
        const dvec3 across = glm::normalize(glm::cross(n, random.direction()));
        const double sine = std::abs(random.signed_log(1e-5, 1));
        tangents.push_back(
            to_vec4((across * sine + n * random.between(-1, 1)) * std::abs(random.signed_log(1e-9, 1e9))));
    }
    const Axes axes = tangent_frames(normals, tangents);
    // However near the tangent is to the normal: nothing cancels.
    EXPECT_LE(departure(axes), ORTHONORMAL);
    for (size_t i = 0; i < normals.size(); ++i) {
        const dvec3 t = glm::normalize(to_dvec3(tangents[i]));
        const dvec3 n = to_dvec3(normals[i]);
        ASSERT_LE(glm::length(to_dvec3(axes.x[i]) - glm::normalize(t - n * glm::dot(t, n) / glm::dot(n, n))),
                  ORTHONORMAL)
            << i;
    }
}

TEST(Frame, TangentsThatAreZeroOrAlongTheNormalAreIgnored) {
    std::vector<vec4> normals = hard_normals(), tangents;
    for (size_t i = 0; i < normals.size(); ++i)
        tangents.push_back(i % 2 ? vec4{0, 0, 0, 0} : to_vec4(to_dvec3(normals[i]) * (i % 4 ? 2.0 : -0.5)));
    const Axes axes = tangent_frames(normals, tangents), plain = frames(normals);
    for (size_t i = 0; i < normals.size(); ++i)
        ASSERT_TRUE(axes.x[i].x == plain.x[i].x && axes.x[i].y == plain.x[i].y && axes.y[i].z == plain.y[i].z)
            << i;
}
