// SPDX-License-Identifier: Apache-2.0
// Roughness from a mirror's to the largest: the distribution of normals, what is sampled, what is lost.
#include "stability/bsdf_set.h"
#include "stability/catalogue.h"
#include "stability/choices.h"

#include "probes/random_inputs.h"
#include "probes/reference.h"
#include "probes/sphere_cells.h"

#include <fmt/format.h>

namespace clrt {

namespace {

using glm::dvec3;

/// a, b, c: normal of the microfacet, d: alpha.
const ProbedExpression D = {"ggx_d", 4, 1, "out[0] = microfacet_d(vector_make(a, b, c), d, d);",
                            "const real c2 = c * c, t = c2 * (d * d - REAL(1.0)) + REAL(1.0);"
                            "out[0] = d * d / (REAL_PI * t * t);"};

/// a, b, c: the eye; d, e, f: normal of the microfacet; g: alpha. G1 D (wo h) / cos_o: the density of visible
/// normals.
const ProbedExpression VISIBLE = {
    "visible", 7, 1,
    "const real3 o = vector_make(a, b, c), h = vector_make(d, e, f); const real oh = vector_dot(o, h);"
    "out[0] = oh > REAL(0.0) ? microfacet_pdf_w(o, h, oh, g, g) : REAL(0.0);",
    "const real oh = a * d + b * e + c * f, f2 = f * f, t = f2 * (g * g - REAL(1.0)) + REAL(1.0);"
    "const real tan2 = (REAL(1.0) - c * c) / (c * c), lambda = REAL(0.5) * (sqrt(REAL(1.0) + g * g * tan2) - "
    "REAL(1.0));"
    "out[0] = oh > REAL(0.0) ? oh / (c * (REAL(1.0) + lambda)) * (g * g / (REAL_PI * t * t)) : REAL(0.0);"};

/// The normal whose slopes are `alpha` times (r cos phi, r sin phi).
dvec3 normal_at(double alpha, double r, double phi) {
    return glm::normalize(dvec3(alpha * r * std::cos(phi), alpha * r * std::sin(phi), 1));
}

void push(Columns& columns, std::initializer_list<double> row) {
    size_t k = 0;
    for (const double value : row)
        columns[k++].push_back(float(value));
}

void distribution(CaseRun& run) {
    ProbeSet probes(run.device, {"scattering/microfacet.h"}, {D});
    Figure& error = run.figure("relative |dD|", 1e-6);
    Columns inputs(4);
    Random random(1);
    const size_t count = run.count(2e4, 2e5, 1e6);
    for (const double alpha : {1.0, 1e-1, 1e-2, 1e-3, 1e-4})
        for (size_t i = 0; i < count; ++i) {
            const dvec3 h = normal_at(alpha, random.between(0, 8), 2 * PI * random.unit());
            push(inputs, {h.x, h.y, h.z, alpha});
        }
    for (const Build build : run.builds()) {
        const std::vector<double> got = probes.run(build, "ggx_d", inputs)[0];
        for (size_t i = 0; i < got.size(); ++i) {
            const dvec3 h(inputs[0][i], inputs[1][i], inputs[2][i]);
            error[build].see(std::abs(got[i] / reference::ggx_d(h, inputs[3][i], inputs[3][i]) - 1), [&] {
                return fmt::format("alpha {}, h {:a} {:a} {:a}", inputs[3][i], inputs[0][i], inputs[1][i],
                                   inputs[2][i]);
            });
        }
    }
}

/// The midpoint rule over slopes r = tan q: the integrand falls like the weight, so that it converges for
/// every alpha.
void weak_furnace(CaseRun& run) {
    ProbeSet probes(run.device, {"scattering/microfacet.h"}, {VISIBLE});
    Figure& rough = run.figure("|integral - 1|, alpha >= 0.05", 1e-4);
    Figure& smooth = run.figure("|integral - 1|, alpha 0.01 to 1e-4", 1e-3);
    const size_t side = run.count(256, 512, 2048);
    for (const double alpha : {1.0, 0.3, 0.05, 0.01, 1e-3, 1e-4})
        for (const double cosine : {1.0, 0.6, 0.1}) {
            const dvec3 wo = direction_at(cosine, 0.7);
            Columns inputs(7);
            std::vector<double> weights;
            for (size_t i = 0; i < side; ++i)
                for (size_t j = 0; j < side; ++j) {
                    const double q = (double(i) + 0.5) / double(side) * PI / 2,
                                 phi = (double(j) + 0.5) / double(side) * 2 * PI;
                    const dvec3 h = normal_at(alpha, std::tan(q), phi);
                    push(inputs, {wo.x, wo.y, wo.z, h.x, h.y, h.z, alpha});
                    weights.push_back(alpha * alpha * std::tan(q) * std::pow(h.z, 3) /
                                      std::pow(std::cos(q), 2) * PI * PI / double(side * side));
                }
            for (const Build build : run.builds()) {
                const std::vector<double> got = probes.run(build, "visible", inputs)[0];
                double mass = 0;
                for (size_t i = 0; i < got.size(); ++i)
                    mass += weights[i] * got[i];
                (alpha >= 0.05 ? rough : smooth)[build].see(
                    std::abs(mass - 1), [&] { return fmt::format("alpha {}, cos {}", alpha, cosine); });
            }
        }
}

/// a, b, c: the eye; d: alpha; e, f: random numbers. G2 / G1 of a facet's reflection, 0 where it is lost.
const ProbedExpression WEIGHT = {
    "weight", 6, 1,
    "const real3 o = vector_make(a, b, c), h = microfacet_sample(o, d, d, (real2)(e, f)); const real3 w = "
    "REAL(2.0) * "
    "vector_dot(o, h) * h - o;"
    "out[0] = w.z > REAL(0.0) ? microfacet_g2(o, w, d, d) / microfacet_g1(o, d, d) : REAL(0.0);",
    ""};

/// Index of a set of one glossy lobe of colour 0.9 without Fresnel.
size_t glossy_set() {
    const std::vector<LobeSet> sets = textbook_sets();
    for (size_t i = 0; i < sets.size(); ++i)
        if (sets[i].name == "glossy")
            return i;
    throw std::logic_error("no set of one glossy lobe");
}

constexpr double GLOSSY_COLOUR = 0.9;

void visible_weights(CaseRun& run) {
    Figure& excess = run.figure("largest G2 / G1", 1 + 4 * FLOAT_U);
    Figure& bad = run.figure("weights that are no number", 0);
    ProbeSet probes(run.device, {"scattering/microfacet.h"}, {WEIGHT});
    Columns inputs(6);
    Random random(2);
    const size_t count = run.count(2e5, 2e6, 8e6);
    for (size_t i = 0; i < count; ++i) {
        const double alpha = std::abs(random.signed_log(1e-4, 1)),
                     cosine = std::abs(random.signed_log(1e-6, 1));
        const double x = random.unit();
        const dvec3 wo = direction_at(cosine, 2 * PI * random.unit());
        push(inputs, {wo.x, wo.y, wo.z, alpha, x, random.unit()});
    }
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        const std::vector<double> got = probes.run(build, "weight", inputs)[0];
        for (size_t i = 0; i < count; ++i) {
            const auto describe = [&] {
                return fmt::format("alpha {}, wo {:a} {:a} {:a}", inputs[3][i], inputs[0][i], inputs[1][i],
                                   inputs[2][i]);
            };
            bad[build].count(!std::isfinite(got[i]) || got[i] < 0, describe);
            excess[build].see(got[i], describe);
        }
    }
}

/// The share of energy that a lobe sends into a disc of half angle 0.2 rad around the mirrored direction,
/// over what a mirror sends: the mean of the weights over a lattice of random numbers.
double share_in_disc(CaseRun& run, Build build, double alpha, double cosine) {
    const dvec3 wo = direction_at(cosine, 0.4), mirrored(-wo.x, -wo.y, wo.z);
    BsdfInputs inputs;
    const int side = 128;
    for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
            inputs.add(glossy_set(), alpha, wo, {0.5, (i + 0.5) / side, (j + 0.5) / side});
    const auto got = bsdf_probes(run.device).run(build, "sample", inputs.columns);
    double sum = 0;
    for (size_t i = 0; i < inputs.size(); ++i)
        if (glm::dot(output_vector(got, SAMPLED_WI, i), mirrored) > std::cos(0.2))
            sum += got[SAMPLED_WEIGHT][i];
    return sum / GLOSSY_COLOUR / double(inputs.size());
}

void towards_mirror(CaseRun& run) {
    Figure& energy = run.figure("|share in the disc - 1|, alpha 2e-3 to 1e-4", 1e-3);
    Figure& jump = run.figure("jump at the smallest alpha, below which lobes are mirrors", 1e-3);
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        for (const double cosine : {1.0, 0.5, 0.2})
            for (const double alpha : {2e-3, 1e-3, 5e-4, 2e-4, 1e-4}) {
                const double off = std::abs(share_in_disc(run, build, alpha, cosine) - 1);
                const auto describe = [&] { return fmt::format("alpha {}, cos {}", alpha, cosine); };
                energy[build].see(off, describe);
                if (alpha == 1e-4)
                    jump[build].see(off, describe);
            }
    }
}

void full_roughness(CaseRun& run) {
    Figure& error = run.figure("|albedo of one facet - quadrature|", 1e-4);
    ProbeSet probes(run.device, {"scattering/microfacet.h"}, {WEIGHT});
    const size_t side = run.count(512, 1024, 2048);
    for (const double cosine : {0.2, 0.4, 0.6, 0.8, 1.0}) {
        Columns inputs(6);
        const dvec3 wo = direction_at(cosine, 0);
        for (size_t i = 0; i < side; ++i)
            for (size_t j = 0; j < side; ++j)
                push(inputs, {wo.x, wo.y, wo.z, 1, (double(i) + 0.5) / double(side),
                              (double(j) + 0.5) / double(side)});
        const double expected = rough_reflection_albedo({1, 1, cosine, 0}, [](double) { return 1.0; });
        for (const Build build : run.builds()) {
            if (build == Build::NAIVE)
                continue;
            const std::vector<double> weights = probes.run(build, "weight", inputs)[0];
            double sum = 0;
            for (const double weight : weights)
                sum += weight;
            error[build].see(std::abs(sum / double(side * side) - expected),
                             [&] { return fmt::format("cos {}", cosine); });
        }
    }
}

void corner_numbers(CaseRun& run) {
    Figure& bad = run.figure("samples without density or not finite", 0);
    BsdfInputs inputs;
    const double corners[] = {0, FLOAT_U, 0.5, 1 - FLOAT_U};
    for (size_t set = 0; set < textbook_sets().size(); ++set)
        for (const double cosine : {1.0, 0.5, 1e-2, 1e-6, 1e-12, 0.0})
            for (const double lobe : corners)
                for (const double x : corners)
                    for (const double y : corners)
                        inputs.add(set, 0, direction_at(cosine, 0.3), {lobe, x, y});
    const std::vector<LobeSet> sets = textbook_sets();
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        const auto got = bsdf_probes(run.device).run(build, "sample", inputs.columns);
        for (size_t i = 0; i < inputs.size(); ++i) {
            const LobeSet& set = sets[size_t(inputs.columns[0][i])];
            const bool is_delta = got[SAMPLED_PDF][i] == 0 && (!is_smooth(set) || (set.lobes & LOBE_MIRROR));
            const bool ok = got[SAMPLED_ETA][i] == 0 ||
                            (std::isfinite(glm::length(output_vector(got, SAMPLED_WI, i))) &&
                             std::isfinite(glm::length(output_vector(got, SAMPLED_WEIGHT, i))) &&
                             std::isfinite(got[SAMPLED_PDF][i]) && (is_delta || got[SAMPLED_PDF][i] > 0));
            bad[build].count(!ok, [&] { return inputs.describe(i); });
        }
    }
}

void sample_is_eval(CaseRun& run) {
    Figure& density = run.figure("relative difference of densities", 1e-5);
    Figure& value = run.figure("relative difference of weight times density to value", 1e-5);
    BsdfInputs inputs;
    Random random(3);
    const std::vector<LobeSet> sets = textbook_sets();
    const size_t count = run.count(2e4, 2e5, 1e6);
    for (size_t set = 0; set < sets.size(); ++set)
        if (is_smooth(sets[set]) && !(sets[set].lobes & LOBE_MIRROR))
            for (size_t i = 0; i < count; ++i) {
                const double lobe = random.unit(), x = random.unit();
                const dvec3 wo =
                    i % 2 ? random.upper_direction()
                          : direction_at(std::abs(random.signed_log(1e-3, 1)), 2 * PI * random.unit());
                inputs.add(set, 0, wo, {lobe, x, random.unit()});
            }
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        const auto got = bsdf_probes(run.device).run(build, "sample", inputs.columns);
        for (size_t i = 0; i < inputs.size(); ++i) {
            if (got[SAMPLED_ETA][i] == 0)
                continue;
            const dvec3 eval = output_vector(got, SAMPLED_VALUE, i);
            density[build].see(std::abs(got[SAMPLED_EVAL_PDF][i] / got[SAMPLED_PDF][i] - 1),
                               [&] { return inputs.describe(i); });
            value[build].see(glm::length(output_vector(got, SAMPLED_WEIGHT, i) * got[SAMPLED_PDF][i] - eval) /
                                 glm::length(eval),
                             [&] { return inputs.describe(i); });
        }
    }
}

} // namespace

ProbeTime time_ggx_d(const ProbeDevice& device, int rounds) {
    Random random(1);
    Columns inputs(4);
    for (int i = 0; i < 1 << 20; ++i) {
        const dvec3 h = random.upper_direction();
        push(inputs, {h.x, h.y, h.z, random.between(0.01, 1)});
    }
    return ProbeSet(device, {"scattering/microfacet.h"}, {D}).time("ggx_d", inputs, rounds);
}

const std::vector<StabilityCase>& roughness_cases() {
    static const std::vector<StabilityCase> cases = {
        {"R01", "Distribution", "alpha from 1 to 1e-4, normals up to slopes of 8 alpha",
         "GGX by slopes in double", "ten roundings of well-conditioned factors", distribution},
        {"R02", "WeakFurnace", "G1 D (wo h) / cos_o over all normals, alpha 1 to 1e-4, three cosines",
         "1: no normal is seen twice (Heitz 2014)", "the quadrature's error and the roundings of R01",
         weak_furnace},
        {"R03", "VisibleNormalWeights", "alpha from 1e-4 to 1, eyes down to a millionth above the horizon",
         "G2 / G1 <= 1", "a law, but for the roundings of a quotient", visible_weights},
        {"R04", "TowardsTheMirror", "light in a disc of 0.2 rad around the mirrored direction", "the mirror",
         "the tail of D beyond the disc holds alpha^2 / (alpha^2 + 0.01); masking takes alpha tan of the "
         "angle",
         towards_mirror},
        {"R05", "FullRoughness", "alpha 1, five cosines, a lattice of random numbers",
         "directional albedo by quadrature over normals in double",
         "the lattice's error at the horizon of the reflected direction", full_roughness},
        {"R06", "CornerNumbers", "random numbers 0, 2^-24, 1/2, 1 - 2^-24 in all places, every BSDF",
         "a density above 0 or no sample", "a law", corner_numbers},
        {"R07", "SampleIsEval", "every BSDF that is no delta function, sampled and evaluated",
         "the same value and density", "the direction is rounded where it leaves the sampler",
         sample_is_eval},
    };
    return cases;
}

} // namespace clrt
