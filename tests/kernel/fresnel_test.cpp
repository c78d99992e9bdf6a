// SPDX-License-Identifier: Apache-2.0
// scattering/fresnel.h against the textbook in long double, around critical angles float by float, and by
// laws.
#include "probes/kernel_probe.h"
#include "probes/random_inputs.h"
#include "probes/reference.h"
#include "scene/conductors.h"
#include "support/test_device.h"

#include <algorithm>
#include <complex>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

/// Of a reflectance: about seven roundings of values below 1.
constexpr double REFLECTANCE = 4e-7;

const char* const TEXT = R"(
vec4 probe_vec4(real3 v, real w) { return (vec4)(convert_float3(v), (float)w); }
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"scattering/fresnel.h"});
        made.add_text(TEXT);
        made.add<float(float, float)>("dielectric", "real t; out = fresnel_dielectric(a, b, &t);");
        made.add<float(float, float)>("cos_t", "real t; fresnel_dielectric(a, b, &t); out = t;");
        made.add<float(float, float)>("cos_t_squared", "fresnel_cos_t_squared(a, b)");
        made.add<float(float, float)>("schlick", "fresnel_schlick((real3)(a), b).x");
        made.add<vec4(vec4, float)>("schlick_color",
                                    "probe_vec4(fresnel_schlick(vector_from(a), b), REAL(0.0))");
        made.add<float(float, float, float)>("conductor", "fresnel_conductor(a, b, c)");
        made.add<float(float, float)>("conductor_mean", "fresnel_conductor_mean((real3)(a), (real3)(b)).x");
        // a: wo, b: the normal on its side, c: eta; gives the refracted direction and the cosine that went in
        made.add<vec4(vec4, vec4, float)>(
            "refract", "real t; const real ci = vector_dot(vector_from(a), vector_from(b));"
                       "fresnel_dielectric(ci, c, &t);"
                       "out = probe_vec4(fresnel_refract(vector_from(a), vector_from(b), ci, t, c), ci);");
        return made;
    }();
    return instance;
}

KernelProbe& double_probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"scattering/fresnel.h"}, {Precision::DOUBLE, {}});
        made.add<double(float, float)>("dielectric",
                                       "real t; out = fresnel_dielectric((real)a, (real)b, &t);");
        made.add<double(float, float, float)>("conductor", "fresnel_conductor((real)a, (real)b, (real)c)");
        return made;
    }();
    return instance;
}

std::vector<float> same(float value, size_t count) {
    return std::vector<float>(count, value);
}

/// Index ratios of both directions through diamond, glass, water and nearly nothing.
std::vector<float> ratios() {
    std::vector<float> ratios;
    for (const double index : {2.417, 2.4, 1.5, 1.333, 1.1, 1.001, 1.0001, 4.0})
        for (const double eta : {index, 1 / index})
            ratios.push_back(float(eta));
    return ratios;
}

struct Index {
    float eta, k;
};

/// Metals, what absorbs next to nothing or nothing, what reflects all, and nearly no boundary.
std::vector<Index> conductors() {
    std::vector<Index> found = {{0.001f, 0},    {0.001f, 5}, {1.5f, 0},        {1.5f, 1e-6f}, {0.7f, 0},
                                {1, 1e-3f},     {1, 1},      {1.0001f, 1e-4f}, {10, 10},      {1e4f, 1e4f},
                                {0.001f, 1e4f}, {1e4f, 0},   {2.5f, 1e-20f}};
    for (const std::string& name : conductor_names()) {
        const ConductorIndex index = *find_conductor(name);
        for (int c = 0; c < 3; ++c)
            found.push_back({float(index.eta[c]), float(index.k[c])});
    }
    return found;
}

/// Of the reflectance in numbers of roundoff u: seven roundings, and the root of (eta + i k)^2 - sin^2 where
/// next to nothing is left of it, near a critical angle.
double conductor_error(const Index& index, float cosine, double u) {
    const std::complex<double> n(index.eta, index.k);
    const double left = std::abs(n * n - (1 - double(cosine) * cosine));
    return 8 * u + 16 * u / std::sqrt(std::max(left, u));
}

/// Cosines from 0 to 1, denser at both ends.
std::vector<float> cosines(size_t count) {
    std::vector<float> cosines = {0, 1e-30f, 1e-7f, float(1 - FLOAT_U), 1};
    for (size_t i = 0; cosines.size() < count; ++i) {
        const double t = (double(i) + 0.5) / double(count);
        cosines.push_back(float(i % 2 ? t : 0.5 - 0.5 * std::cos(PI * t)));
    }
    return cosines;
}

} // namespace

TEST(Fresnel, ReflectanceOfDielectricsIsThatOfTheTextbook) {
    const std::vector<float> grid = cosines(4096);
    for (const float eta : ratios()) {
        const std::vector<float> got = probe().run<float>("dielectric", grid, same(eta, grid.size()));
        for (size_t i = 0; i < grid.size(); ++i)
            ASSERT_NEAR(got[i], reference::fresnel_dielectric(grid[i], eta), REFLECTANCE)
                << "cos " << grid[i] << " eta " << eta;
    }
}

TEST(Fresnel, ReflectanceOfConductorsIsThatOfTheTextbook) {
    const std::vector<float> grid = cosines(2048);
    for (const Index& index : conductors()) {
        const std::vector<float> got =
            probe().run<float>("conductor", grid, same(index.eta, grid.size()), same(index.k, grid.size()));
        for (size_t i = 0; i < grid.size(); ++i)
            ASSERT_NEAR(got[i], reference::fresnel_conductor(grid[i], index.eta, index.k),
                        conductor_error(index, grid[i], FLOAT_U))
                << "cos " << grid[i] << " eta " << index.eta << " k " << index.k;
        if (!test_device().info.fp64)
            continue;
        const std::vector<double> twin = double_probe().run<double>(
            "conductor", grid, same(index.eta, grid.size()), same(index.k, grid.size()));
        for (size_t i = 0; i < grid.size(); ++i)
            ASSERT_NEAR(twin[i], reference::fresnel_conductor(grid[i], index.eta, index.k),
                        conductor_error(index, grid[i], 0x1p-53))
                << "cos " << grid[i] << " eta " << index.eta << " k " << index.k;
    }
}

TEST(Fresnel, ConductorsThatAbsorbNothingAreDielectrics) {
    const std::vector<float> grid = cosines(512);
    for (const float eta : ratios()) {
        const std::vector<float> metal =
            probe().run<float>("conductor", grid, same(eta, grid.size()), same(0, grid.size()));
        const std::vector<float> glass = probe().run<float>("dielectric", grid, same(1 / eta, grid.size()));
        for (size_t i = 0; i < grid.size(); ++i) // 1 / eta is rounded
            ASSERT_NEAR(metal[i], glass[i], eta < 1.01f ? 2e-3 : 10 * REFLECTANCE)
                << "cos " << grid[i] << " eta " << eta;
    }
    // No boundary reflects nothing, at grazing incidence, too.
    for (const float none :
         probe().run<float>("conductor", std::vector<float>{0, 1e-6f, 0.5f, 1}, same(1, 4), same(0, 4)))
        EXPECT_EQ(none, 0);
}

TEST(Fresnel, TheMeanOfConductorsIsThatOfTheHemisphere) {
    for (const std::string& name : conductor_names()) {
        const ConductorIndex index = *find_conductor(name);
        for (int c = 0; c < 3; ++c) {
            double exact = 0;
            for (int i = 0; i < 4096; ++i)
                exact += reference::fresnel_conductor(std::sqrt((i + 0.5) / 4096), index.eta[c], index.k[c]);
            const float got = probe().run<float>("conductor_mean", std::vector<float>{float(index.eta[c])},
                                                 std::vector<float>{float(index.k[c])})[0];
            EXPECT_NEAR(got, exact / 4096, 2e-3) << name;
        }
    }
}

TEST(Fresnel, InDoubleTheReflectanceHasTheDigitsOfDouble) {
    if (!test_device().info.fp64) {
        EXPECT_THROW(double_probe().program(), DeviceError);
        return;
    }
    const std::vector<float> grid = cosines(1024);
    for (const float eta : ratios()) {
        const std::vector<double> got =
            double_probe().run<double>("dielectric", grid, same(eta, grid.size()));
        for (size_t i = 0; i < grid.size(); ++i)
            ASSERT_NEAR(got[i], reference::fresnel_dielectric(grid[i], eta), 1e-15)
                << "cos " << grid[i] << " eta " << eta;
    }
}

TEST(Fresnel, TotalReflectionBeginsAtTheRightFloat) {
    struct Case {
        double index, degrees;
    };
    for (const Case& c :
         {Case{2.4, 24.62}, Case{2.417, 24.44}, Case{1.333, 48.61}, Case{1.5, 41.81}, Case{1.0001, 89.19}}) {
        const float eta = float(c.index);
        const double critical = std::sqrt((double(eta) - 1) * (double(eta) + 1)) / eta;
        std::vector<float> cosine = {float(critical)};
        for (int k = 0; k < 2048; ++k) {
            cosine.push_back(std::nextafter(cosine.back(), 1.0f));
            cosine.insert(cosine.begin(), std::nextafter(cosine.front(), 0.0f));
        }
        const std::vector<float> got = probe().run<float>("dielectric", cosine, same(eta, cosine.size()));
        const std::vector<float> cos_t = probe().run<float>("cos_t", cosine, same(eta, cosine.size()));
        int wrong = 0;
        float last_total = 0;
        for (size_t i = 0; i < cosine.size(); ++i) {
            const double exact = reference::fresnel_dielectric(cosine[i], eta);
            wrong += (got[i] == 1) != (exact == 1);
            ASSERT_NEAR(got[i], exact, REFLECTANCE) << "cos " << cosine[i] << " eta " << eta;
            ASSERT_EQ(cos_t[i] == 0, got[i] == 1);
            last_total = got[i] == 1 ? cosine[i] : last_total;
        }
        EXPECT_LE(wrong, 1) << eta;
        EXPECT_NEAR(std::acos(double(last_total)) * 180 / PI, c.degrees, 0.005) << eta;
    }
}

TEST(Fresnel, RefractedCosinesKeepTheirDigitsUpToTheCriticalAngle) {
    const std::vector<float> grid = cosines(4096);
    for (const float eta : ratios()) {
        const std::vector<float> got = probe().run<float>("cos_t_squared", grid, same(eta, grid.size()));
        for (size_t i = 0; i < grid.size(); ++i) {
            const double exact = double(reference::cos_t_squared(grid[i], eta));
            ASSERT_NEAR(got[i], exact, 4 * FLOAT_U * std::abs(exact)) << "cos " << grid[i] << " eta " << eta;
        }
    }
}

TEST(Fresnel, EqualIndicesReflectNothingAtAnyAngleAndBendNothing) {
    const std::vector<float> grid = cosines(4096);
    EXPECT_EQ(probe().run<float>("dielectric", grid, same(1, grid.size())), same(0, grid.size()));
    EXPECT_EQ(probe().run<float>("cos_t", grid, same(1, grid.size())), grid);
    Random random(1);
    std::vector<vec4> wo, n;
    for (int i = 0; i < 10000; ++i) {
        n.push_back(to_vec4(random.direction()));
        const dvec3 w = random.direction();
        wo.push_back(to_vec4(glm::dot(w, to_dvec3(n[size_t(i)])) < 0 ? -w : w));
    }
    const std::vector<vec4> wi = probe().run<vec4>("refract", wo, n, same(1, wo.size()));
    for (size_t i = 0; i < wi.size(); ++i)
        ASSERT_LE(glm::length(to_dvec3(wi[i]) + to_dvec3(wo[i])), 4 * FLOAT_U);
}

TEST(Fresnel, HeadOnAndGrazingReflectancesAreTheKnownOnes) {
    for (const float eta : ratios()) {
        const double r = (double(eta) - 1) / (double(eta) + 1);
        EXPECT_NEAR(probe().run<float>("dielectric", same(1, 1), same(eta, 1))[0], r * r, REFLECTANCE) << eta;
        EXPECT_EQ(probe().run<float>("dielectric", same(0, 1), same(eta, 1))[0], 1) << eta;
    }
}

TEST(Fresnel, LightReturnsTheWayItCame) {
    const std::vector<float> grid = cosines(4096);
    for (const float eta : {1.5f, 1 / 1.5f, 2.417f}) {
        const std::vector<float> back = probe().run<float>("cos_t", grid, same(eta, grid.size()));
        const std::vector<float> there = probe().run<float>("dielectric", grid, same(eta, grid.size()));
        const std::vector<float> returned =
            probe().run<float>("dielectric", back, same(1 / eta, grid.size()));
        for (size_t i = 0; i < grid.size(); ++i) {
            // Roundings move the smaller cosine by 4 u / cosine, and F falls from 1 by at most 6 times that
            // cosine.
            const double smallest = std::min(grid[i], back[i]);
            ASSERT_NEAR(there[i], returned[i], smallest < 1e-3 ? 1 : REFLECTANCE + 24 * FLOAT_U / smallest)
                << grid[i] << " " << eta;
        }
    }
}

TEST(Fresnel, SchlickRunsFromF0ToOneAndStaysBetween) {
    // Gold, silver, glass, diamond, black, white.
    for (const float f0 : {0.82f, 0.95f, 0.04f, 0.15f, 0.0f, 1.0f}) {
        std::vector<float> grid = cosines(4096);
        for (int k = 1; k <= 4; ++k)
            for (const double end : {1 + 2 * k * FLOAT_U, -k * 1e-7})
                grid.push_back(float(end));
        const std::vector<float> got = probe().run<float>("schlick", same(f0, grid.size()), grid);
        for (size_t i = 0; i < grid.size(); ++i) {
            ASSERT_NEAR(got[i], reference::fresnel_schlick(f0, grid[i]), REFLECTANCE) << grid[i];
            ASSERT_TRUE(got[i] >= f0 && got[i] <= 1)
                << "cos " << grid[i] << " f0 " << f0 << " gives " << got[i];
        }
        EXPECT_EQ(probe().run<float>("schlick", same(f0, 1), same(1, 1))[0], f0);
        EXPECT_EQ(probe().run<float>("schlick", same(f0, 1), same(0, 1))[0], 1);
    }
    const vec4 color =
        probe().run<vec4>("schlick_color", std::vector<vec4>{{0.1f, 0.5f, 0.9f, 0}}, same(0.25f, 1))[0];
    EXPECT_NEAR(color.x, reference::fresnel_schlick(0.1, 0.25), REFLECTANCE);
    EXPECT_NEAR(color.y, reference::fresnel_schlick(0.5, 0.25), REFLECTANCE);
    EXPECT_NEAR(color.z, reference::fresnel_schlick(0.9, 0.25), REFLECTANCE);
}

TEST(Fresnel, RefractedDirectionsObeySnellsLaw) {
    Random random(2);
    std::vector<vec4> wo, n;
    std::vector<float> eta;
    const std::vector<float> all = ratios();
    while (wo.size() < 400000) {
        const dvec3 normal = glm::normalize(to_dvec3(to_vec4(random.direction())));
        const dvec3 across = glm::normalize(glm::cross(normal, random.direction()));
        const double cosine = random.word() % 2 ? random.unit() : std::abs(random.signed_log(1e-6, 1));
        const float ratio = all[wo.size() % all.size()];
        // Only what is refracted, and not the last per cent before the critical angle.
        if (ratio * ratio * (1 - cosine * cosine) >= 0.99)
            continue;
        wo.push_back(to_vec4(normal * cosine + across * std::sqrt(1 - cosine * cosine)));
        n.push_back(to_vec4(normal));
        eta.push_back(ratio);
    }
    const std::vector<vec4> wi = probe().run<vec4>("refract", wo, n, eta);
    double length = 0, snell = 0, side = -1;
    for (size_t i = 0; i < wi.size(); ++i) {
        const dvec3 w = to_dvec3(wi[i]), o = to_dvec3(wo[i]), normal = to_dvec3(n[i]);
        length = std::max(length, std::abs(glm::length(w) - 1));
        // Snell's law for vectors: the parts along the surface are opposite, in the ratio eta.
        const dvec3 residual = glm::cross(normal, w) + double(eta[i]) * glm::cross(normal, o);
        snell = std::max(snell, glm::length(residual) / std::max(1.0, double(eta[i])));
        side = std::max(side, glm::dot(w, normal));
    }
    EXPECT_LE(length, 4 * FLOAT_U);
    EXPECT_LE(snell, 8 * FLOAT_U); // 4 u of the direction, 3 u of the length of n, 1 u of wo's
    EXPECT_LT(side, 0);
}
