// SPDX-License-Identifier: Apache-2.0
// scattering/microfacet.h: GGX against double precision by slopes, its normalisations, and sampled normals.
#include "probes/kernel_probe.h"
#include "probes/reference.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

/// Ten roundings of a product of well-conditioned factors.
constexpr double RELATIVE = 1e-6;

const char* const TEXT = R"(
vec4 probe_vec4(real3 v, real w) { return (vec4)(convert_float3(v), (float)w); }
)";

KernelProbe& probe() {
    static KernelProbe instance = [] {
        KernelProbe made(test_device(), {"scattering/microfacet.h"});
        made.add_text(TEXT);
        made.add<float(vec4, float, float)>("d", "microfacet_d(vector_from(a), b, c)");
        made.add<float(vec4, float, float)>("lambda", "microfacet_lambda(vector_from(a), b, c)");
        made.add<float(vec4, float, float)>("g1", "microfacet_g1(vector_from(a), b, c)");
        made.add<float(vec4, vec4, float, float)>("g2",
                                                  "microfacet_g2(vector_from(a), vector_from(b), c, d)");
        // a: wo, b: u
        made.add<vec4(vec4, vec4, float, float)>(
            "sample", "const real3 h = microfacet_sample(vector_from(a), c, d, (real2)(b.x, b.y));"
                      "out = probe_vec4(h, vector_dot(vector_from(a), h));");
        made.add<float(vec4, vec4, float, float)>(
            "pdf", "const real oh = vector_dot(vector_from(a), vector_from(b));"
                   "out = oh > 0.0f ? microfacet_pdf_w(vector_from(a), vector_from(b), oh, c, d) : 0.0f;");
        return made;
    }();
    return instance;
}

struct Roughness {
    float x, y;
};

const Roughness ROUGHNESSES[] = {{1, 1},         {0.5f, 0.5f},   {0.1f, 0.1f},  {0.01f, 0.01f},
                                 {1e-3f, 1e-3f}, {1e-4f, 1e-4f}, {0.4f, 0.05f}, {0.01f, 0.3f}};

template <class T>
std::vector<T> same(const T& value, size_t count) {
    return std::vector<T>(count, value);
}

/// Directions above the surface from head-on to a millionth above the horizon.
std::vector<vec4> upper_directions(size_t count, u32 seed) {
    Random random(seed);
    std::vector<vec4> directions = {{0, 0, 1, 0}, {1, 0, 1e-6f, 0}};
    while (directions.size() < count) {
        const double z = directions.size() % 2 ? random.unit() : std::abs(random.signed_log(1e-6, 1));
        directions.push_back(to_vec4(direction_at(z, 2 * PI * random.unit())));
    }
    return directions;
}

/// Midpoints in polar slope coordinates: normals and the solid angle that each stands for. The integrand's
/// tail falls like the weight, so that a plain midpoint rule converges for every roughness.
struct SlopeRule {
    std::vector<vec4> normals;
    std::vector<double> weights;

    SlopeRule(const Roughness& alpha, size_t radii, size_t angles) {
        for (size_t i = 0; i < radii; ++i)
            for (size_t j = 0; j < angles; ++j) {
                const double q = (double(i) + 0.5) / double(radii) * PI / 2,
                             phi = (double(j) + 0.5) / double(angles) * 2 * PI;
                const double r = std::tan(q);
                const dvec3 h =
                    glm::normalize(dvec3(alpha.x * r * std::cos(phi), alpha.y * r * std::sin(phi), 1));
                normals.push_back(to_vec4(h));
                const double dr = PI / 2 / double(radii) / std::pow(std::cos(q), 2),
                             dphi = 2 * PI / double(angles);
                weights.push_back(alpha.x * alpha.y * r * dr * dphi * std::pow(h.z, 3));
            }
    }
};

/// What the largest and the smallest number of the sampler can do, and anything between.
std::vector<vec4> random_pairs(size_t count, u32 seed) {
    Random random(seed);
    std::vector<vec4> pairs;
    for (size_t i = 0; i < count; ++i) {
        const double x = random.unit();
        pairs.push_back(to_vec4({x, random.unit(), 0}));
    }
    return pairs;
}

} // namespace

TEST(Microfacet, DistributionIsGgxDownToAlphaOneTenThousandth) {
    Random random(1);
    for (const Roughness& alpha : ROUGHNESSES) {
        std::vector<vec4> h;
        for (int i = 0; i < 20000; ++i) {
            const double r = random.between(0, 8), phi = 2 * PI * random.unit();
            h.push_back(
                to_vec4(glm::normalize(dvec3(alpha.x * r * std::cos(phi), alpha.y * r * std::sin(phi), 1))));
        }
        const std::vector<float> got =
            probe().run<float>("d", h, same(alpha.x, h.size()), same(alpha.y, h.size()));
        for (size_t i = 0; i < h.size(); ++i)
            ASSERT_NEAR(got[i] / reference::ggx_d(to_dvec3(h[i]), alpha.x, alpha.y), 1, RELATIVE)
                << "alpha " << alpha.x << " " << alpha.y;
    }
}

TEST(Microfacet, MaskingAndShadowingAreSmiths) {
    const std::vector<vec4> wo = upper_directions(20000, 2);
    std::vector<vec4> wi = upper_directions(20000, 3);
    for (size_t i = 0; i < wi.size(); i += 3) // below the surface too, as for refraction
        wi[i].z = -wi[i].z;
    for (const Roughness& alpha : ROUGHNESSES) {
        const std::vector<float> ax = same(alpha.x, wo.size()), ay = same(alpha.y, wo.size());
        const std::vector<float> lambda = probe().run<float>("lambda", wi, ax, ay);
        const std::vector<float> g1 = probe().run<float>("g1", wo, ax, ay);
        const std::vector<float> g2 = probe().run<float>("g2", wo, wi, ax, ay);
        EXPECT_EQ(probe().run<float>("g2", wi, wo, ax, ay).size(), g2.size());
        for (size_t i = 0; i < wo.size(); ++i) {
            const dvec3 o = to_dvec3(wo[i]), w = to_dvec3(wi[i]);
            const double exact = reference::ggx_lambda(w, alpha.x, alpha.y);
            ASSERT_NEAR(lambda[i], exact, RELATIVE * exact);
            ASSERT_NEAR(g1[i] / reference::ggx_g1(o, alpha.x, alpha.y), 1, RELATIVE);
            ASSERT_NEAR(g2[i] / reference::ggx_g2(o, w, alpha.x, alpha.y), 1, RELATIVE);
            ASSERT_LE(g2[i], g1[i]); // so that no sampled reflection gains energy
        }
    }
}

TEST(Microfacet, TheNormalsProjectedAreaIsOne) {
    for (const Roughness& alpha : ROUGHNESSES) {
        const SlopeRule rule(alpha, 512, 32);
        const size_t n = rule.normals.size();
        const std::vector<float> d =
            probe().run<float>("d", rule.normals, same(alpha.x, n), same(alpha.y, n));
        double area = 0;
        for (size_t i = 0; i < n; ++i)
            area += rule.weights[i] * d[i] * rule.normals[i].z;
        EXPECT_NEAR(area, 1, 1e-5) << alpha.x << " " << alpha.y;
    }
}

TEST(Microfacet, VisibleNormalsIntegrateToOneFromEveryDirection) {
    // Heitz's weak white furnace: without it microfacets would gain or lose energy by masking alone.
    for (const Roughness& alpha : ROUGHNESSES) {
        const SlopeRule rule(alpha, 512, 512);
        const size_t n = rule.normals.size();
        for (const double z : {1.0, 0.7, 0.2, 0.02}) {
            const vec4 wo = to_vec4(direction_at(z, 0.7));
            const std::vector<float> pdf =
                probe().run<float>("pdf", same(wo, n), rule.normals, same(alpha.x, n), same(alpha.y, n));
            double mass = 0;
            for (size_t i = 0; i < n; ++i)
                mass += rule.weights[i] * pdf[i];
            EXPECT_NEAR(mass, 1, 1e-4) << "cos " << z << " alpha " << alpha.x << " " << alpha.y;
        }
    }
}

TEST(Microfacet, SampledNormalsFollowTheDensityOfVisibleNormals) {
    // Stretched by 1 / alpha, every GGX surface is the one of roughness 1, whose visible normals have the
    // density 2 (w.h) / (pi (1 + w.z)) on the hemisphere: one grid fits lobes of all widths.
    constexpr size_t SAMPLES = 200000;
    const SphereCells cells(32, 32, 8);
    const std::vector<vec4> u = random_pairs(SAMPLES, 4);
    for (const Roughness& alpha : ROUGHNESSES)
        for (const double z : {1.0, 0.6, 0.05, 1e-3}) {
            const vec4 wo = to_vec4(direction_at(z, 2.5));
            const dvec3 w = glm::normalize(to_dvec3(wo) * dvec3(alpha.x, alpha.y, 1));
            std::vector<double> density;
            for (const dvec3& h : cells.nodes())
                density.push_back(h.z > 0 ? std::max(0.0, glm::dot(w, h)) * 2 / (PI * (1 + w.z)) : 0);
            std::vector<double> expected = cells.integrals(density);
            EXPECT_NEAR(total(expected), 1, 1e-3);

            std::vector<dvec3> normals;
            for (const vec4& h : probe().run<vec4>("sample", same(wo, SAMPLES), u, same(alpha.x, SAMPLES),
                                                   same(alpha.y, SAMPLES))) {
                ASSERT_NEAR(glm::length(to_dvec3(h)), 1, 4 * FLOAT_U);
                ASSERT_GE(h.w, -4 * FLOAT_U); // visible but for rounding
                normals.push_back(glm::normalize(to_dvec3(h) * dvec3(1 / alpha.x, 1 / alpha.y, 1)));
            }
            // No node of a cell may see the sliver that lies inside the terminator.
            for (double& cell : expected)
                cell = double(SAMPLES) * std::max(cell, 1e-9);
            const std::vector<double> counts = cells.histogram(normals);
            EXPECT_GT(chi_squared_test(counts, expected).p_value, SMALLEST_P)
                << "cos " << z << " alpha " << alpha.x << " " << alpha.y;
        }
}

TEST(Microfacet, TheDensityOfVisibleNormalsIsItsFormula) {
    Random random(5);
    const std::vector<vec4> wo = upper_directions(20000, 6);
    for (const Roughness& alpha : ROUGHNESSES) {
        std::vector<vec4> h;
        for (size_t i = 0; i < wo.size(); ++i) {
            const double r = random.between(0, 8), phi = 2 * PI * random.unit();
            h.push_back(
                to_vec4(glm::normalize(dvec3(alpha.x * r * std::cos(phi), alpha.y * r * std::sin(phi), 1))));
        }
        const std::vector<float> got =
            probe().run<float>("pdf", wo, h, same(alpha.x, h.size()), same(alpha.y, h.size()));
        for (size_t i = 0; i < h.size(); ++i) {
            const dvec3 o = to_dvec3(wo[i]), m = to_dvec3(h[i]);
            const double cos_oh = glm::dot(o, m);
            if (cos_oh < 1e-3) // the dot product's own rounding decides
                continue;
            const double exact =
                reference::ggx_g1(o, alpha.x, alpha.y) * cos_oh * reference::ggx_d(m, alpha.x, alpha.y) / o.z;
            ASSERT_NEAR(got[i] / exact, 1, RELATIVE + 3 * FLOAT_U / cos_oh);
        }
    }
}

TEST(Microfacet, CornerNumbersGiveUnitNormalsAboveTheSurface) {
    std::vector<vec4> u, wo;
    for (const double x : {FLOAT_U, 0.5 - FLOAT_U, 0.5 + FLOAT_U, 1 - FLOAT_U})
        for (const double y : {FLOAT_U, 0.5 + FLOAT_U, 1 - FLOAT_U})
            for (const double z : {1.0, 0.5, 1e-3, 1e-6, 1e-12, 1e-30, 0.0})
                for (const double phi : {0.0, 0.3, PI / 2}) {
                    u.push_back(to_vec4({x, y, 0}));
                    wo.push_back(to_vec4(direction_at(z, phi)));
                }
    for (const Roughness& alpha : ROUGHNESSES)
        for (const vec4& h :
             probe().run<vec4>("sample", wo, u, same(alpha.x, u.size()), same(alpha.y, u.size()))) {
            ASSERT_NEAR(glm::length(to_dvec3(h)), 1, 4 * FLOAT_U);
            ASSERT_GE(h.z, 0);
        }
}

TEST(Microfacet, LambdaStaysANumberUpToTheHorizon) {
    // On the horizon nothing is visible: Lambda is infinite, G1 and G2 are 0.
    std::vector<vec4> w;
    for (const double z : {1e-6, 1e-12, 1e-19, 1e-25, 1e-38, 0.0})
        w.push_back({1, 0, float(z), 0});
    for (const Roughness& alpha : ROUGHNESSES) {
        const std::vector<float> ax = same(alpha.x, w.size()), ay = same(alpha.y, w.size());
        const std::vector<float> lambda = probe().run<float>("lambda", w, ax, ay),
                                 g1 = probe().run<float>("g1", w, ax, ay);
        for (size_t i = 0; i < w.size(); ++i) {
            ASSERT_GT(lambda[i], 0) << w[i].z;
            ASSERT_TRUE(g1[i] >= 0 && g1[i] <= 1) << w[i].z;
        }
        EXPECT_EQ(g1.back(), 0);
    }
}
