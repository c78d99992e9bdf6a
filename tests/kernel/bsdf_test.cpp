// SPDX-License-Identifier: Apache-2.0
// scattering/bsdf.h and the lobes below it: formulas in double precision, sample against eval, reciprocity,
// energy.
#include "probes/bsdf_probe.h"
#include "probes/reference.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"
#include "scene/vectors.h"
#include "support/bsdf_reference.h"
#include "support/test_device.h"

#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

/// Relative error of values and densities: the half vector of two float directions is off by 2 u, which D of
/// roughness 0.15 magnifies thirtyfold; the tilted frame moves cosines by 16 u at most. 1 - F of a dielectric
/// microfacet loses digits where it is seen edge-on, and F where refraction ends: its cosine is the root of
/// what is left.
double tolerance(const LobeSet& set, const dvec3& wo, const dvec3& wi) {
    const double general = 1e-5 + 16 * FLOAT_U / std::abs(wi.z);
    if (set.lobes & LOBE_SHEEN) { // a high power of the sine of the half vector's angle
        const dvec3 h = glm::normalize(wo + wi);
        return general + 64 * FLOAT_U / (set.sheen_alpha * std::hypot(h.x, h.y));
    }
    if (!(set.lobes & LOBES_GLASS))
        return general;
    if (set.lobes & LOBE_PANE) // what passes is mirrored by the facet, then by the plane
        return general + 256 * FLOAT_U / wo.z;
    const double cos_o = glm::dot(wo, glm::normalize(wi.z > 0 ? wo + wi : set.eta * wo + wi));
    const double left = std::abs(double(reference::cos_t_squared(cos_o, set.eta)));
    return general + 64 * FLOAT_U / std::abs(cos_o) + 64 * FLOAT_U / std::max(left, FLOAT_U);
}

BsdfProbe& probe() {
    static BsdfProbe instance(test_device());
    return instance;
}

std::vector<LobeSet> smooth_sets() {
    std::vector<LobeSet> sets;
    for (const LobeSet& set : all_lobe_sets())
        if (probe().has_smooth_lobe(set))
            sets.push_back(set);
    return sets;
}

/// Directions above the surface, in float, half of them towards the horizon down to a thousandth.
std::vector<dvec3> eyes(size_t count, u32 seed) {
    Random random(seed);
    std::vector<dvec3> directions;
    for (size_t i = 0; i < count; ++i) {
        const double z = i % 2 ? random.unit() : std::abs(random.signed_log(1e-3, 1));
        directions.push_back(to_dvec3(to_vec4(direction_at(z, 2 * PI * random.unit()))));
    }
    return directions;
}

std::vector<dvec3> anywhere(size_t count, u32 seed) {
    Random random(seed);
    std::vector<dvec3> directions;
    while (directions.size() < count) {
        const dvec3 w = to_dvec3(to_vec4(random.direction()));
        if (std::abs(w.z) > 1e-4) // the tilted frame's roundings decide the side of what is closer
            directions.push_back(w);
    }
    return directions;
}

/// Mean of value over cosine-free directions by the samples: reflected energy, refraction freed of its eta^2.
Moments energy(const BsdfSamples& samples, double eta) {
    std::vector<double> weights;
    for (size_t i = 0; i < samples.wi.size(); ++i)
        weights.push_back(
            samples.eta[i] == 0 ? 0 : samples.weight[i].x / (samples.wi[i].z < 0 ? eta * eta : 1.0));
    return moments_of(weights);
}

} // namespace

TEST(Bsdf, ValueAndDensityAreTheTextbooks) {
    constexpr size_t COUNT = 40000;
    const std::vector<dvec3> wo = eyes(COUNT, 1), wi = anywhere(COUNT, 2);
    for (const LobeSet& set : smooth_sets()) {
        if (!set.has_textbook)
            continue;
        const BsdfValues got = probe().eval(set, wo, wi);
        const std::vector<AlbedoSample> from = probe().albedos(set, wo), to = probe().albedos(set, wi);
        const double there = probe().albedos(set, {{0, 0, -1}})[0].mean_loss;
        for (size_t i = 0; i < COUNT; ++i) {
            const reference::BsdfReference exact =
                reference::bsdf_eval(set, wo[i], wi[i], from[i], to[i], there);
            // Where the microfacet is seen edge-on, the sign of a cosine is decided by rounding.
            if (set.lobes == LOBE_DIELECTRIC && (got.pdf_w[i] == 0) != (exact.pdf_w == 0)) {
                ASSERT_LT(std::max(got.pdf_w[i], exact.pdf_w), 1e-3) << set.name;
                continue;
            }
            ASSERT_LE(glm::length(got.value[i] - exact.value),
                      tolerance(set, wo[i], wi[i]) * glm::length(exact.value))
                << set.name << " wo.z " << wo[i].z << " wi.z " << wi[i].z;
            ASSERT_NEAR(got.pdf_w[i], exact.pdf_w, tolerance(set, wo[i], wi[i]) * exact.pdf_w)
                << set.name << " wo.z " << wo[i].z << " wi.z " << wi[i].z;
        }
    }
}

TEST(Bsdf, SamplesCarryTheValueAndTheDensityOfEval) {
    constexpr size_t COUNT = 200000;
    const std::vector<dvec3> wo = eyes(COUNT, 3), u = random_triples(COUNT, 4);
    for (const LobeSet& set : smooth_sets()) {
        const BsdfSamples samples = probe().sample(set, wo, u);
        const BsdfValues eval = probe().eval(set, wo, samples.wi);
        size_t valid = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            if (samples.eta[i] == 0 || samples.pdf_w[i] == 0 || std::abs(samples.wi[i].z) < 1e-4)
                continue;
            ++valid;
            const double bound =
                3 * tolerance(set, wo[i], samples.wi[i]); // through the tilted frame and back
            ASSERT_NEAR(samples.pdf_w[i] / eval.pdf_w[i], 1, bound) << set.name << " wo.z " << wo[i].z;
            ASSERT_LE(glm::length(samples.weight[i] * eval.pdf_w[i] - eval.value[i]),
                      bound * glm::length(eval.value[i]))
                << set.name << " wo.z " << wo[i].z << " wi.z " << samples.wi[i].z;
        }
        // Half of the eyes are near the horizon, where a mirror takes most.
        EXPECT_GT(valid, COUNT / 5) << set.name;
    }
}

TEST(Bsdf, ReflectionIsReciprocal) {
    constexpr size_t COUNT = 50000;
    const std::vector<dvec3> a = eyes(COUNT, 5), b = eyes(COUNT, 6);
    for (const LobeSet& set : smooth_sets()) {
        const BsdfValues there = probe().eval(set, a, b), back = probe().eval(set, b, a);
        for (size_t i = 0; i < COUNT; ++i) {
            const dvec3 f = there.value[i] / b[i].z, g = back.value[i] / a[i].z;
            ASSERT_LE(glm::length(f - g),
                      (tolerance(set, a[i], b[i]) + tolerance(set, b[i], a[i])) * glm::length(f))
                << set.name;
        }
    }
}

TEST(Bsdf, TransmissionOverTheSquaredIndexIsReciprocal) {
    constexpr size_t COUNT = 50000;
    const std::vector<dvec3> a = eyes(COUNT, 7), below = eyes(COUNT, 8);
    std::vector<dvec3> b, a_flipped;
    for (size_t i = 0; i < COUNT; ++i) {
        b.push_back({below[i].x, below[i].y, -below[i].z});
        a_flipped.push_back({a[i].x, a[i].y, -a[i].z});
    }
    for (const char* name : {"rough glass from outside", "rough glass from inside"}) {
        const LobeSet set = lobe_set(name);
        LobeSet other = set;
        other.eta = 1 / set.eta;
        const BsdfValues there = probe().eval(set, a, b), back = probe().eval(other, below, a_flipped);
        size_t seen = 0;
        for (size_t i = 0; i < COUNT; ++i) {
            const dvec3 f = there.value[i] / std::abs(b[i].z),
                        g = back.value[i] / std::abs(a[i].z) * (set.eta * set.eta);
            if ((f.x == 0) != (g.x == 0)) { // edge-on microfacets, as above
                ASSERT_LT(std::max(f.x, g.x), 1e-3);
                continue;
            }
            const double bound = tolerance(set, a[i], b[i]) + tolerance(other, below[i], a_flipped[i]);
            ASSERT_LE(glm::length(f - g), bound * glm::length(f)) << name;
            seen += f.x > 0;
        }
        EXPECT_GT(seen, COUNT / 20) << name;
    }
}

TEST(Bsdf, MatteAndMirrorLobesReturnTheirColourExactly) {
    constexpr size_t COUNT = 100000;
    const std::vector<dvec3> wo = eyes(COUNT, 9), u = random_triples(COUNT, 10);
    const LobeSet matte = lobe_set("matte"), mirror = lobe_set("mirror"),
                  schlick = lobe_set("mirror, Schlick");
    const BsdfSamples spread = probe().sample(matte, wo, u), reflected = probe().sample(mirror, wo, u),
                      tinted = probe().sample(schlick, wo, u);
    for (size_t i = 0; i < COUNT; ++i) {
        ASSERT_EQ(spread.weight[i], matte.matte);
        ASSERT_TRUE(spread.eta[i] == 1 && reflected.eta[i] == 1 && tinted.eta[i] == 1);
        ASSERT_EQ(reflected.weight[i], mirror.specular);
        ASSERT_EQ(reflected.pdf_w[i], 0);
        ASSERT_LE(glm::length(reflected.wi[i] - dvec3(-wo[i].x, -wo[i].y, wo[i].z)), 16 * FLOAT_U);
        ASSERT_LE(glm::length(tinted.weight[i] - reference::reflection_color(schlick, wo[i].z)), 1e-6);
    }
}

TEST(Bsdf, AMirrorBesideAMatteLobeSharesTheSamples) {
    constexpr size_t COUNT = 100000;
    const std::vector<dvec3> wo = eyes(COUNT, 11), u = random_triples(COUNT, 12);
    for (const char* name : {"matte and mirror", "matte and mirror, Schlick"}) {
        const LobeSet set = lobe_set(name);
        const BsdfSamples samples = probe().sample(set, wo, u);
        for (size_t i = 0; i < COUNT; ++i) {
            const dvec3 color = reference::reflection_color(set, wo[i].z);
            // Below Schlick's mirror (1 - E) (1 - E') / mean(1 - E), and 1 - E = (1 - F0) (1 - (1 - cos)^5).
            const auto left = [&](double cosine) {
                return reference::is_coupled(set) ? 1 - std::pow(1 - cosine, 5) : 1.0;
            };
            const dvec3 seen = reference::is_coupled(set)
                                   ? set.matte * (dvec3(1) - set.specular) * left(wo[i].z)
                                   : set.matte;
            const dvec3 matte =
                reference::is_coupled(set) ? seen * left(samples.wi[i].z) * (21.0 / 20) : seen;
            const double choose_matte = glm::length(seen) / (glm::length(seen) + glm::length(color));
            const bool spread = samples.pdf_w[i] > 0;
            ASSERT_TRUE(std::abs(u[i].x - choose_matte) < 1e-6 || spread == (u[i].x < choose_matte)) << name;
            const dvec3 weight = spread ? matte / choose_matte : color / (1 - choose_matte);
            ASSERT_LE(glm::length(samples.weight[i] - weight), 1e-5 * glm::length(weight)) << name;
        }
    }
}

TEST(Bsdf, SmoothGlassReflectsWithProbabilityFAndRefractsTheRest) {
    constexpr size_t COUNT = 200000;
    const std::vector<dvec3> wo = eyes(COUNT, 13), u = random_triples(COUNT, 14);
    for (const char* name : {"smooth glass from outside", "smooth glass from inside"}) {
        const LobeSet set = lobe_set(name);
        const double eta = float(set.eta);
        const BsdfSamples samples = probe().sample(set, wo, u);
        for (size_t i = 0; i < COUNT; ++i) {
            const double f = reference::fresnel_dielectric(wo[i].z, eta);
            const bool reflects = samples.wi[i].z > 0;
            ASSERT_TRUE(std::abs(u[i].x - f) < 1e-6 || reflects == (u[i].x < f)) << name;
            ASSERT_EQ(samples.pdf_w[i], 0);
            ASSERT_EQ(samples.eta[i], reflects ? 1 : eta);
            const dvec3 weight = reflects ? set.specular : set.transmission * (eta * eta);
            ASSERT_LE(glm::length(samples.weight[i] - weight), 4 * FLOAT_U * glm::length(weight)) << name;
            const double cos_t = std::sqrt(std::max(0.0, 1 - eta * eta * (1 - wo[i].z * wo[i].z)));
            const dvec3 wi =
                reflects ? dvec3(-wo[i].x, -wo[i].y, wo[i].z) : dvec3(-eta * wo[i].x, -eta * wo[i].y, -cos_t);
            // Next to the critical angle wi turns quickly; its parallel part is off by roundings alone.
            ASSERT_LE(std::hypot(samples.wi[i].x - wi.x, samples.wi[i].y - wi.y),
                      16 * FLOAT_U * std::max(1.0, eta))
                << name;
        }
    }
}

TEST(Bsdf, EnergyIsNeverGainedAndIsThatOfTheQuadrature) {
    constexpr size_t COUNT = 400000;
    const std::vector<dvec3> u = random_triples(COUNT, 15);
    for (const LobeSet& set : smooth_sets()) {
        if ((set.lobes & LOBE_MATTE) || !set.has_textbook)
            continue;
        for (const double z : {1.0, 0.6, 0.1}) {
            const dvec3 wo = direction_at(z, 0.4);
            const Moments got = energy(probe().sample(set, repeated(wo, COUNT), u), set.eta);
            EXPECT_LE(got.mean, 1 + 1e-3 + 6 * std::sqrt(got.variance_of_mean())) << set.name;
            // 2e-4: the quadrature's error where directions disappear below the horizon.
            const AlbedoSample o = probe().albedos(set, {wo})[0];
            const double more =
                set.lobes == LOBE_DIELECTRIC ? 1 : reference::multiple_color(set, o.mean_loss).x;
            const double expected = reference::first_facet_albedo(set, wo, 512, 512) + more * o.loss;
            EXPECT_NEAR(got.mean, expected, 2e-4 + 6 * std::sqrt(got.variance_of_mean()))
                << set.name << " cos " << z;
        }
    }
}

TEST(Bsdf, SumsOfLobesReflectTheSumOfTheirEnergies) {
    constexpr size_t COUNT = 400000;
    const std::vector<dvec3> u = random_triples(COUNT, 16);
    for (const char* name : {"matte and glossy", "matte and glossy, no Fresnel"}) {
        const LobeSet set = lobe_set(name);
        LobeSet glossy = set;
        glossy.lobes = LOBE_GLOSSY;
        for (const double z : {1.0, 0.6, 0.1}) {
            const dvec3 wo = direction_at(z, 0.4);
            const Moments got = energy(probe().sample(set, repeated(wo, COUNT), u), 1);
            const AlbedoSample o = probe().albedos(set, {wo})[0];
            EXPECT_NEAR(got.mean,
                        reference::matte_albedo(set, o).x +
                            reference::multiple_color(set, o.mean_loss).x * o.loss +
                            reference::first_facet_albedo(glossy, wo, 512, 256),
                        2e-4 + 6 * std::sqrt(got.variance_of_mean()))
                << name << " cos " << z;
        }
    }
}

TEST(Bsdf, NothingPassesWhereTheNormalsDisagreeAboutTheSide) {
    constexpr size_t COUNT = 50000;
    const dvec3 normal_g = glm::normalize(dvec3(0.6, 0, 0.8));
    const std::vector<dvec3> wo = repeated(direction_at(0.9, 0.2), COUNT), wi = anywhere(COUNT, 17);
    const std::vector<dvec3> u = random_triples(COUNT, 18);
    for (const LobeSet& set : all_lobe_sets()) {
        const BsdfValues eval = probe().eval(set, wo, wi, normal_g), same = probe().eval(set, wo, wi);
        const BsdfSamples samples = probe().sample(set, wo, u, normal_g);
        for (size_t i = 0; i < COUNT; ++i) {
            const double side = glm::dot(wi[i], normal_g);
            if (std::abs(side) < 1e-6)
                continue;
            const bool agree = (side > 0) == (wi[i].z > 0);
            ASSERT_EQ(eval.value[i], agree ? same.value[i] : dvec3(0)) << set.name;
            ASSERT_EQ(eval.pdf_w[i], agree ? same.pdf_w[i] : 0) << set.name;
            const double sampled_side = glm::dot(samples.wi[i], normal_g);
            ASSERT_TRUE(samples.eta[i] == 0 || std::abs(sampled_side) < 1e-6 ||
                        (sampled_side > 0) == (samples.wi[i].z > 0))
                << set.name;
        }
    }
}

TEST(Bsdf, OnlyDeltaLobesCannotBeConnectedToALight) {
    for (const LobeSet& set : all_lobe_sets()) {
        const bool delta =
            set.lobes == LOBE_MIRROR || ((set.lobes & LOBES_GLASS) == set.lobes && set.alpha_x == 0);
        EXPECT_EQ(probe().has_smooth_lobe(set), !delta) << set.name;
    }
}

TEST(Bsdf, GrazingEyesAndCornerNumbersGiveFiniteSamples) {
    std::vector<dvec3> wo, u;
    const double corners[] = {FLOAT_U, 0.5 + FLOAT_U, 1 - FLOAT_U};
    for (const double z : {1.0, 0.5, 1e-3, 1e-6, 1e-9, 1e-12, 1e-20, 1e-25, 1e-38, 0.0})
        for (const double phi : {0.0, 0.7, PI / 2})
            for (const double a : corners)
                for (const double b : corners)
                    for (const double c : corners) {
                        wo.push_back(direction_at(z, phi));
                        wo.back().z = z;
                        u.push_back({a, b, c});
                    }
    std::vector<LobeSet> sets = all_lobe_sets();
    for (const double alpha : {1e-4, 1e-2, 1.0})
        for (const char* name :
             {"rough glass from outside", "rough glass from inside", "glossy", "matte and glossy"}) {
            sets.push_back(lobe_set(name));
            sets.back().alpha_x = sets.back().alpha_y = alpha;
            sets.back().name += ", alpha " + std::to_string(alpha);
        }
    for (const double eta : {1 - FLOAT_U, 1 + 2 * FLOAT_U, 1.0001}) { // half vectors that nearly cancel
        sets.push_back(lobe_set("rough glass from outside"));
        sets.back().eta = eta;
        sets.back().name += ", eta " + std::to_string(eta);
    }
    for (const LobeSet& set : sets) {
        const BsdfSamples samples = probe().sample(set, wo, u);
        const BsdfValues eval = probe().eval(set, wo, samples.wi);
        for (size_t i = 0; i < wo.size(); ++i) {
            ASSERT_TRUE(is_finite(eval.value[i]) && std::isfinite(eval.pdf_w[i]))
                << set.name << " wo.z " << wo[i].z;
            ASSERT_TRUE(eval.pdf_w[i] >= 0 && eval.value[i].y >= 0) << set.name << " wo.z " << wo[i].z;
            if (samples.eta[i] == 0)
                continue;
            ASSERT_TRUE(is_finite(samples.wi[i]) && is_finite(samples.weight[i]) &&
                        std::isfinite(samples.pdf_w[i]))
                << set.name << " wo.z " << wo[i].z;
            ASSERT_NEAR(glm::length(samples.wi[i]), 1, 16 * FLOAT_U) << set.name << " wo.z " << wo[i].z;
            ASSERT_GT(samples.weight[i].x + samples.weight[i].y + samples.weight[i].z, 0) << set.name;
        }
    }
}

TEST(Bsdf, EqualIndicesLetEverythingPassStraight) {
    constexpr size_t COUNT = 50000;
    const std::vector<dvec3> wo = eyes(COUNT, 19), u = random_triples(COUNT, 20);
    for (const double alpha : {0.0, 0.3, 0.01}) {
        LobeSet set = lobe_set("smooth glass from outside");
        set.alpha_x = set.alpha_y = alpha;
        set.eta = 1;
        const BsdfSamples samples = probe().sample(set, wo, u);
        const BsdfValues eval = probe().eval(set, wo, samples.wi);
        for (size_t i = 0; i < COUNT; ++i) {
            ASSERT_LE(glm::length(samples.wi[i] + wo[i]), 16 * FLOAT_U) << alpha;
            ASSERT_TRUE(std::isfinite(samples.pdf_w[i]) && is_finite(samples.weight[i])) << alpha;
            ASSERT_TRUE(std::isfinite(eval.pdf_w[i]) && is_finite(eval.value[i])) << alpha;
            ASSERT_EQ(samples.eta[i], 1) << alpha;
        }
    }
}
