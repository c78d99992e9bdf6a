// SPDX-License-Identifier: Apache-2.0
// What methods ask of a BSDF that build paths from both ends (scattering/bsdf_reverse.h and the transport
// mode of scattering/bsdf.h): the density of the reverse direction, and importance as the adjoint of
// radiance.
#include "probes/bsdf_probe.h"
#include "probes/reference.h"
#include "scene/lobes.h"
#include "support/test_device.h"

#include <algorithm>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

constexpr size_t COUNT = 50000;

BsdfProbe& probe() {
    static BsdfProbe instance(test_device());
    return instance;
}

/// Two directions of the surface and how each is seen from the other.
struct Pair {
    dvec3 wo, wi;
    bool crosses() const { return wi.z < 0; }
    /// The same directions from wi's side: half a turn about x takes the normal there.
    dvec3 turned(const dvec3& v) const { return crosses() ? dvec3(v.x, -v.y, -v.z) : v; }
};

/// Eyes above the surface and directions on both sides, neither next to the horizon.
std::vector<Pair> random_pairs(u32 seed) {
    Random random(seed);
    const auto away_from_horizon = [&] {
        dvec3 w(0);
        while (std::abs(w.z) < 0.02)
            w = to_dvec3(to_vec4(random.direction()));
        return w;
    };
    std::vector<Pair> pairs;
    for (size_t i = 0; i < COUNT; ++i) {
        const dvec3 wo = away_from_horizon();
        pairs.push_back({{wo.x, wo.y, std::abs(wo.z)}, away_from_horizon()});
    }
    return pairs;
}

/// Evaluates a set for the pairs, and for the pairs as seen from wi.
struct BothWays {
    BsdfValues there, back;
};

BothWays eval_both_ways(const LobeSet& there, const LobeSet& back, const std::vector<Pair>& pairs) {
    std::vector<dvec3> wo, wi, back_wo, back_wi;
    for (const Pair& pair : pairs) {
        wo.push_back(pair.wo);
        wi.push_back(pair.wi);
        back_wo.push_back(pair.turned(pair.wi));
        back_wi.push_back(pair.turned(pair.wo));
    }
    // On the other side the index ratio is the inverse: evaluated for all, taken where the pair crosses.
    const LobeSet across = back.from_other_side();
    BothWays both{probe().eval(there, wo, wi), probe().eval(back, back_wo, back_wi)};
    const BsdfValues crossed = probe().eval(across, back_wo, back_wi);
    for (size_t i = 0; i < pairs.size(); ++i)
        if (pairs[i].crosses()) {
            both.back.value[i] = crossed.value[i];
            both.back.pdf_w[i] = crossed.pdf_w[i];
        }
    return both;
}

/// Half vectors, and where dielectrics are seen edge-on or refract least, their Fresnel (bsdf_test.cpp).
double tolerance(const LobeSet& set, const Pair& pair) {
    const double general = 2e-5 + 32 * FLOAT_U / std::min(std::abs(pair.wi.z), pair.wo.z);
    if (set.lobes & LOBE_SHEEN) { // a high power of the sine of the half vector's angle
        const dvec3 h = glm::normalize(pair.wo + pair.wi);
        return general + 64 * FLOAT_U / (set.sheen_alpha * std::hypot(h.x, h.y));
    }
    if (!(set.lobes & LOBES_GLASS))
        return general;
    if (set.lobes & LOBE_PANE)
        return general + 256 * FLOAT_U / std::min(pair.wo.z, std::abs(pair.wi.z));
    const dvec3 h = glm::normalize(pair.crosses() ? set.eta * pair.wo + pair.wi : pair.wo + pair.wi);
    const double cos_o = glm::dot(pair.wo, h), cos_i = glm::dot(pair.wi, h);
    const double left = std::min(std::abs(double(reference::cos_t_squared(cos_o, set.eta))),
                                 std::abs(double(reference::cos_t_squared(cos_i, 1 / set.eta))));
    return general + 256 * FLOAT_U / std::min(std::abs(cos_o), std::abs(cos_i)) +
           256 * FLOAT_U / std::max(left, FLOAT_U);
}

/// Microfacets seen edge-on: rounding decides the sign of a cosine, and with it whether anything is there.
bool is_edge_on(double a, double b) {
    return (a == 0) != (b == 0) && std::max(a, b) < 1e-3;
}

/// All lobes, that of a measured BRDF too.
std::vector<LobeSet> every_lobe_set() {
    static const LobeSet measured =
        measured_set("measured", matte_and_glossy({0.2, 0.1, 0.3}, {0.6, 0.5, 0.4}, 0.3), {24, 20, 16});
    std::vector<LobeSet> sets = all_lobe_sets();
    sets.push_back(measured);
    return sets;
}

std::vector<LobeSet> smooth_sets() {
    std::vector<LobeSet> sets;
    for (const LobeSet& set : every_lobe_set())
        if (probe().has_smooth_lobe(set))
            sets.push_back(set);
    return sets;
}

LobeSet importance(LobeSet set) {
    set.is_importance = true;
    return set;
}

const dvec3 TILTED = glm::normalize(dvec3(0.3, -0.1, 0.95));

/// |cos_o(n_s) cos_i(n_g)| / |cos_o(n_g) cos_i(n_s)|, Veach 1997, eq. 5.19.
double shading_factor(const dvec3& wo, const dvec3& wi, const dvec3& normal_g) {
    return std::abs(wo.z * glm::dot(wi, normal_g)) / std::abs(glm::dot(wo, normal_g) * wi.z);
}

} // namespace

TEST(BsdfTransport, EveryLobeOfTheTableIsTestedAloneAndHasItsBit) {
    u32 bit = 1;
    for (const LobeSpec& lobe : LOBE_SPECS) {
        EXPECT_EQ(lobe.bit, bit) << lobe.name;
        EXPECT_NE(lobe.letters | lobe.delta_letters, 0u) << lobe.name;
        const std::vector<LobeSet> sets = every_lobe_set();
        EXPECT_TRUE(std::any_of(sets.begin(), sets.end(), [&](const LobeSet& set) {
            return set.lobes == lobe.bit;
        })) << lobe.name;
        bit *= 2;
    }
    EXPECT_EQ(bit, 1u << LOBE_COUNT);
}

TEST(BsdfTransport, TheReverseDensityIsThatOfTheSwappedDirections) {
    const std::vector<Pair> pairs = random_pairs(1);
    for (const LobeSet& set : smooth_sets()) {
        const BothWays both = eval_both_ways(set, set, pairs);
        size_t seen = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const double got = both.there.pdf_w_reverse[i], expected = both.back.pdf_w[i];
            if (is_edge_on(got, expected))
                continue;
            ASSERT_NEAR(got, expected, tolerance(set, pairs[i]) * expected)
                << set.name << " wo.z " << pairs[i].wo.z << " wi.z " << pairs[i].wi.z;
            seen += expected > 0 && std::abs(expected - both.there.pdf_w[i]) > 0.01 * expected;
        }
        if (set.lobes == LOBE_SHEEN) // sampled alike from everywhere
            continue;
        EXPECT_GT(seen, COUNT / 20) << set.name << ": the densities of both directions are not told apart";
    }
}

TEST(BsdfTransport, ImportanceIsTheAdjointOfRadiance) {
    // f*(wo -> wi) = f(wi -> wo): without the cosines, which belong to the directions.
    const std::vector<Pair> pairs = random_pairs(2);
    for (const LobeSet& set : smooth_sets()) {
        const BothWays both = eval_both_ways(importance(set), set, pairs);
        size_t seen = 0, crossed = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const dvec3 there = both.there.value[i] / std::abs(pairs[i].wi.z),
                        back = both.back.value[i] / pairs[i].wo.z;
            if (is_edge_on(there.x, back.x))
                continue;
            ASSERT_LE(glm::length(there - back), tolerance(set, pairs[i]) * glm::length(back))
                << set.name << " wo.z " << pairs[i].wo.z << " wi.z " << pairs[i].wi.z;
            seen += back.x > 0;
            crossed += back.x > 0 && pairs[i].crosses();
        }
        EXPECT_GT(seen, COUNT / 20) << set.name;
        EXPECT_TRUE(!(set.lobes & LOBES_GLASS) || set.alpha_x == 0 || crossed > COUNT / 50) << set.name;
    }
}

TEST(BsdfTransport, OnlyRadianceGrowsByTheSquaredIndexWhereItCrosses) {
    const std::vector<Pair> pairs = random_pairs(3);
    for (const LobeSet& set : smooth_sets()) {
        const BothWays both = eval_both_ways(set, importance(set), pairs);
        const BsdfValues carried = eval_both_ways(importance(set), set, pairs).there;
        for (size_t i = 0; i < COUNT; ++i) {
            const double squared = pairs[i].crosses() ? std::pow(set.crossed_eta(), 2) : 1;
            ASSERT_LE(glm::length(both.there.value[i] - squared * carried.value[i]),
                      tolerance(set, pairs[i]) * glm::length(both.there.value[i]))
                << set.name;
            ASSERT_EQ(both.there.pdf_w[i], carried.pdf_w[i]) << set.name;
        }
    }
}

TEST(BsdfTransport, SampledWeightsOfSmoothGlassCarryTheFactorOfTheirMode) {
    const std::vector<dvec3> wo = repeated(direction_at(0.8, 0.3), COUNT), u = random_triples(COUNT, 4);
    for (const char* name : {"smooth glass from outside", "smooth glass from inside"}) {
        const LobeSet set = lobe_set(name);
        const BsdfSamples radiance = probe().sample(set, wo, u),
                          carried = probe().sample(importance(set), wo, u);
        size_t refracted = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const bool crosses = radiance.wi[i].z < 0;
            const dvec3 expected = crosses ? set.transmission : set.specular;
            ASSERT_LE(glm::length(carried.weight[i] - expected), 1e-5) << name;
            ASSERT_LE(glm::length(radiance.weight[i] - expected * (crosses ? set.eta * set.eta : 1)), 1e-5);
            refracted += crosses;
        }
        EXPECT_GT(refracted, COUNT / 2) << name;
    }
}

TEST(BsdfTransport, ImportanceIsCorrectedForShadingNormals) {
    const std::vector<Pair> pairs = random_pairs(5);
    std::vector<dvec3> wo, wi;
    for (const Pair& pair : pairs) {
        wo.push_back(pair.wo);
        wi.push_back(pair.wi);
    }
    for (const LobeSet& set : smooth_sets()) {
        LobeSet plain = importance(set);
        const BsdfValues flat = probe().eval(plain, wo, wi), tilted = probe().eval(plain, wo, wi, TILTED),
                         radiance = probe().eval(set, wo, wi, TILTED), straight = probe().eval(set, wo, wi);
        size_t seen = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const double cos_i = glm::dot(wi[i], TILTED), cos_o = glm::dot(wo[i], TILTED);
            if (std::abs(cos_i) < 1e-3 || cos_o < 1e-3)
                continue;
            const bool agree = (cos_i > 0) == (wi[i].z > 0);
            const dvec3 expected = agree ? flat.value[i] * shading_factor(wo[i], wi[i], TILTED) : dvec3(0);
            ASSERT_LE(glm::length(tilted.value[i] - expected), 1e-3 * glm::length(expected)) << set.name;
            ASSERT_EQ(radiance.value[i], agree ? straight.value[i] : dvec3(0))
                << set.name << ": radiance is not";
            ASSERT_EQ(tilted.pdf_w[i], radiance.pdf_w[i]) << set.name << ": nor are densities";
            seen += agree && expected.x > 0;
        }
        EXPECT_GT(seen, COUNT / 20) << set.name;
    }
}

TEST(BsdfTransport, BeamsAndRaysMeetUnderShadingNormals) {
    // The flux of a beam from wo to wi over the plane's cosine is the light of the ray from wi to wo over it.
    std::vector<dvec3> wo, wi;
    for (const Pair& pair : random_pairs(6))
        if (!pair.crosses() && glm::dot(pair.wo, TILTED) > 0.01 && glm::dot(pair.wi, TILTED) > 0.01) {
            wo.push_back(pair.wo);
            wi.push_back(pair.wi);
        }
    ASSERT_GT(wo.size(), COUNT / 4);
    for (const LobeSet& set : smooth_sets()) {
        const BsdfValues beam = probe().eval(importance(set), wo, wi, TILTED),
                         ray = probe().eval(set, wi, wo, TILTED);
        for (size_t i = 0; i < wo.size(); ++i) {
            const dvec3 there = beam.value[i] / glm::dot(wi[i], TILTED),
                        back = ray.value[i] / glm::dot(wo[i], TILTED);
            if (is_edge_on(there.x, back.x))
                continue;
            ASSERT_LE(glm::length(there - back), (1e-3 + tolerance(set, {wo[i], wi[i]})) * glm::length(back))
                << set.name;
        }
    }
}

TEST(BsdfTransport, SamplesOfImportanceCarryTheValueOfEval) {
    const std::vector<dvec3> u = random_triples(COUNT, 7);
    std::vector<dvec3> wo;
    for (const Pair& pair : random_pairs(8))
        wo.push_back(glm::dot(pair.wo, TILTED) > 0.01 ? pair.wo : dvec3(0, 0, 1));
    for (const LobeSet& set : smooth_sets()) {
        const BsdfSamples samples = probe().sample(importance(set), wo, u, TILTED);
        const BsdfValues eval = probe().eval(importance(set), wo, samples.wi, TILTED);
        size_t seen = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const Pair pair{wo[i], samples.wi[i]};
            if (samples.eta[i] == 0 || samples.pdf_w[i] == 0 || std::abs(glm::dot(pair.wi, TILTED)) < 0.01 ||
                std::abs(pair.wi.z) < 0.01)
                continue;
            ASSERT_LE(glm::length(samples.weight[i] * eval.pdf_w[i] - eval.value[i]),
                      (1e-3 + 3 * tolerance(set, pair)) * glm::length(eval.value[i]))
                << set.name;
            ++seen;
        }
        EXPECT_GT(seen, COUNT / 4) << set.name;
    }
}
