// SPDX-License-Identifier: Apache-2.0
// scattering/bsdf_measured.h: the formula that a file was made from, reciprocity, samples against density,
// energy, single against double.
#include "probes/bsdf_probe.h"
#include "probes/reference.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"
#include "support/test_device.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

constexpr MerlCounts DATABASE, COARSE = {30, 24, 20};

BsdfProbe make_probe(Precision precision) {
    return BsdfProbe(test_device(), {precision, {fmt::format("CLRT_EFFECTS={:#x}u", EFFECT_MEASURED)}});
}

/// With no other lobe: that compiles in a second.
BsdfProbe& probe() {
    static BsdfProbe instance = make_probe(Precision::SINGLE);
    return instance;
}

BrdfFunction metal() {
    return matte_and_glossy({0.1, 0.05, 0.02}, {0.8, 0.6, 0.4}, 0.2);
}

/// No symmetry but the one of reciprocity: about the plane of the normal and the half vector it is skew.
dvec3 skew(const dvec3& wo, const dvec3& wi) {
    const dvec3 h = glm::normalize(wo + wi), apart = wi - wo;
    const double skewness = (h.x * apart.y - h.y * apart.x) * apart.z;
    return dvec3(0.2 + 0.1 * skewness, 0.1, 0.1 + h.z * h.z * 0.1);
}

std::vector<LobeSet> sets() {
    return {measured_set("measured matte", matte_and_glossy({0.75, 0.5, 0.25}), COARSE),
            measured_set("measured metal", metal(), DATABASE),
            measured_set("measured polish", matte_and_glossy({0.3, 0.2, 0.1}, dvec3(0.3), 0.1), DATABASE),
            measured_set("measured skew", skew, COARSE)};
}

/// Directions above the surface, in float, from a cosine on.
std::vector<dvec3> above(size_t count, double smallest_cosine, u32 seed) {
    Random random(seed);
    std::vector<dvec3> directions;
    for (size_t i = 0; i < count; ++i) {
        const double cosine = smallest_cosine + (1 - smallest_cosine) * random.unit();
        directions.push_back(to_dvec3(to_vec4(direction_at(cosine, 2 * PI * random.unit()))));
    }
    return directions;
}

/// Directions to the eye: head-on, oblique, grazing.
std::vector<dvec3> eyes() {
    return {direction_at(1, 0), direction_at(0.7, 0.9), direction_at(0.3, 3.6), direction_at(0.05, -1.2)};
}

} // namespace

TEST(BsdfMeasured, ValuesAreThoseThatTheFileWasMadeFrom) {
    // A halving of all steps leaves a quarter of the error of interpolation between them.
    constexpr double MATTE_ERROR = 1e-3, METAL_ERROR = 0.02;
    const std::vector<dvec3> wo = above(20000, 0.15, 1), wi = above(20000, 0.15, 2);
    const auto expect_near = [&](const LobeSet& set, const BrdfFunction& exact, double error) {
        const BsdfValues got = probe().eval(set, wo, wi);
        for (size_t i = 0; i < wo.size(); ++i) {
            const dvec3 expected = exact(wo[i], wi[i]) * wi[i].z;
            ASSERT_LE(glm::length(got.value[i] - expected), error * glm::length(expected))
                << set.name << " wo.z " << wo[i].z << " wi.z " << wi[i].z;
        }
    };
    const BrdfFunction matte = matte_and_glossy({0.75, 0.5, 0.25});
    expect_near(measured_set("matte", matte, COARSE), matte, MATTE_ERROR);
    expect_near(measured_set("metal", metal(), DATABASE), metal(), METAL_ERROR);
    expect_near(measured_set("skew", skew, DATABASE), skew, METAL_ERROR);
}

TEST(BsdfMeasured, BothOrdersOfTwoDirectionsHaveOneValue) {
    const std::vector<dvec3> wo = above(20000, 1e-3, 3), wi = above(20000, 1e-3, 4);
    for (const LobeSet& set : sets()) {
        const BsdfValues there = probe().eval(set, wo, wi), back = probe().eval(set, wi, wo);
        for (size_t i = 0; i < wo.size(); ++i) {
            const dvec3 f = there.value[i] / wi[i].z, g = back.value[i] / wo[i].z;
            // The probe's tilted frame moves cosines by a few units of the last place.
            const double error = 1e-5 + 64 * FLOAT_U / std::min(wo[i].z, wi[i].z);
            ASSERT_LE(glm::length(f - g), error * glm::length(f))
                << set.name << " wo.z " << wo[i].z << " wi.z " << wi[i].z;
            ASSERT_NEAR(there.pdf_w_reverse[i], back.pdf_w[i], 1e-3 * back.pdf_w[i]) << set.name;
        }
    }
}

TEST(BsdfMeasured, SampledDirectionsFollowPdf) {
    const SphereCells cells(48, 48, 10);
    const std::vector<dvec3> nodes = cells.nodes(), u = random_triples(400000, 1);
    for (const LobeSet& set : sets())
        for (const dvec3& wo : eyes()) {
            std::vector<double> expected =
                cells.integrals(probe().eval(set, repeated(wo, nodes.size()), nodes).pdf_w);
            const BsdfSamples samples = probe().sample(set, repeated(wo, u.size()), u);
            for (double& cell : expected)
                cell *= double(u.size());
            EXPECT_GT(chi_squared_test(cells.histogram(samples.found()), expected).p_value, SMALLEST_P)
                << set.name << ", cos " << wo.z;
        }
}

TEST(BsdfMeasured, AWhiteOneIsWhiteAndOthersHaveTheirAlbedo) {
    const std::vector<dvec3> u = random_triples(200000, 5);
    const LobeSet white = measured_set("white", matte_and_glossy(dvec3(1)), COARSE);
    const SphereCells cells(128, 128, 4);
    const std::vector<dvec3> nodes = cells.nodes();
    std::vector<LobeSet> all = sets();
    all.push_back(white);
    for (const LobeSet& set : all)
        for (const dvec3& wo : eyes()) {
            const BsdfSamples samples = probe().sample(set, repeated(wo, u.size()), u);
            std::vector<double> weights, values;
            for (size_t i = 0; i < u.size(); ++i)
                weights.push_back(samples.eta[i] > 0 ? samples.weight[i].x : 0.0);
            for (const dvec3& value : probe().eval(set, repeated(wo, nodes.size()), nodes).value)
                values.push_back(value.x);
            const double albedo = total(cells.integrals(values));
            const Moments moments = moments_of(weights);
            EXPECT_NEAR(moments.mean, albedo, 0.003 * albedo + 5 * std::sqrt(moments.variance_of_mean()))
                << set.name << ", cos " << wo.z;
            if (set.name == white.name)
                EXPECT_NEAR(moments.mean, 1, 0.003) << "cos " << wo.z;
        }
}

TEST(BsdfMeasured, SingleAndDoubleAgree) {
    static BsdfProbe in_double = make_probe(Precision::DOUBLE);
    const std::vector<dvec3> wo = above(20000, 0.01, 6), wi = above(20000, 0.01, 7);
    for (const LobeSet& set : sets()) {
        const BsdfValues found = probe().eval(set, wo, wi), exact = in_double.eval(set, wo, wi);
        size_t other_cells = 0;
        for (size_t i = 0; i < wo.size(); ++i) {
            ASSERT_LE(glm::length(found.value[i] - exact.value[i]), 1e-3 * glm::length(exact.value[i]))
                << set.name << " wo.z " << wo[i].z << " wi.z " << wi[i].z;
            other_cells += std::abs(found.pdf_w[i] - exact.pdf_w[i]) > 1e-3 * exact.pdf_w[i];
        }
        // Densities jump from cell to cell, and rounding decides which one it is.
        EXPECT_LE(other_cells, wo.size() / 1000) << set.name;
    }
}
