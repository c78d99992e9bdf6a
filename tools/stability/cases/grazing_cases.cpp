// SPDX-License-Identifier: Apache-2.0
// Grazing incidence: scattering where cosines vanish, reflectances up to the horizon.
#include "stability/bsdf_set.h"
#include "stability/cases/grazing_plane_case.h"
#include "stability/cases/shading_expressions.h"
#include "stability/catalogue.h"

#include "probes/random_inputs.h"
#include "probes/reference.h"

#include <fmt/format.h>

namespace clrt {

namespace {

/// a: F0, b: cosine.
const ProbedExpression SCHLICK = {"schlick", 2, 1, "out[0] = fresnel_schlick((real3)(a), b).x;",
                                  "out[0] = a + (REAL(1.0) - a) * pow(REAL(1.0) - b, REAL(5.0));"};

/// What a sample's weight may reach: |a| + |b| for lobes chosen by their sizes, 1 for one lobe, eta^2 where
/// radiance is compressed. Light that leaves after several facets is sampled uniformly: its weight is cos
/// L(cos) over the mean of that, at most 2, where the loss L is flat; beside the first facet's reflection it
/// is one lobe more, of at most the same size.
double weight_bound(const LobeSet& set) {
    const double peak = set.alpha_x > 0 ? 2 : 1;
    if (set.lobes & LOBE_DIELECTRIC)
        return peak * std::max(1.0, set.eta * set.eta);
    const bool is_rough = (set.lobes & LOBE_GLOSSY) != 0;
    if ((set.lobes & LOBE_MATTE) && set.lobes != LOBE_MATTE)
        return is_rough ? peak * (glm::length(set.matte) + 2 * std::sqrt(3.0))
                        : glm::length(set.matte) + std::sqrt(3.0);
    return is_rough ? 2 * peak : 1;
}

void grazing_bsdfs(CaseRun& run) {
    Figure& bad = run.figure("values, densities, weights that are no finite number >= 0", 0);
    Figure& excess = run.figure("weight over its bound", 1 + 8 * FLOAT_U);
    const std::vector<LobeSet> sets = all_lobe_sets();
    const double cosines[] = {1e-1, 1e-2,  1e-3,  1e-4,  1e-5,  1e-6,  1e-7, 1e-8,
                              1e-9, 1e-10, 1e-11, 1e-12, 1e-20, 1e-30, 0};
    BsdfInputs eval, sample;
    Random random(1);
    const size_t rounds = run.count(60, 600, 4000);
    for (size_t set = 0; set < sets.size(); ++set)
        for (const double cosine : cosines)
            for (size_t k = 0; k < rounds; ++k) {
                const glm::dvec3 wo = direction_at(cosine, 2 * PI * random.unit());
                const double z =
                    k % 2 ? random.between(-1, 1) : cosines[random.word() % 15] * (k % 4 ? 1 : -1);
                eval.add(set, 0, wo, direction_at(z, 2 * PI * random.unit()));
                const double lobe = random.unit(), x = random.unit();
                sample.add(set, 0, wo, {lobe, x, random.unit()});
            }
    const auto is_bad = [](double x) { return !(x >= 0 && std::isfinite(x)); };
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        const auto values = bsdf_probes(run.device).run(build, "eval", eval.columns);
        for (size_t i = 0; i < eval.size(); ++i)
            bad[build].count(is_bad(values[0][i]) || is_bad(values[1][i]) || is_bad(values[2][i]) ||
                                 is_bad(values[3][i]),
                             [&] { return "eval: " + eval.describe(i); });
        const auto samples = bsdf_probes(run.device).run(build, "sample", sample.columns);
        for (size_t i = 0; i < sample.size(); ++i) {
            if (samples[SAMPLED_ETA][i] == 0)
                continue;
            double largest = 0;
            bool is_wrong = is_bad(samples[SAMPLED_PDF][i]) ||
                            !std::isfinite(glm::length(output_vector(samples, SAMPLED_WI, i)));
            for (size_t c = SAMPLED_WEIGHT; c < SAMPLED_WEIGHT + 3; ++c) {
                is_wrong = is_wrong || is_bad(samples[c][i]);
                largest = std::max(largest, samples[c][i]);
            }
            bad[build].count(is_wrong, [&] { return "sample: " + sample.describe(i); });
            const LobeSet& set = sets[size_t(sample.columns[0][i])];
            if (set.has_textbook)
                excess[build].see(largest / weight_bound(set), [&] { return sample.describe(i); });
        }
    }
}

void fresnel_grid(CaseRun& run) {
    ProbeSet probes(run.device, {"scattering/fresnel.h"}, {fresnel_expression()});
    Figure& error = run.figure("|dF|", 4e-7);
    Columns inputs(2);
    for (const float eta : {1 / 2.417f, 1 / 1.5f, 1 / 1.333f, 0.9999f, 1.0001f, 1.333f, 1.5f, 2.417f})
        for (int i = 0; i <= 4096; ++i) {
            inputs[0].push_back(float(i) / 4096);
            inputs[1].push_back(eta);
        }
    for (const Build build : run.builds()) {
        const std::vector<double> got = probes.run(build, "fresnel", inputs)[0];
        for (size_t i = 0; i < got.size(); ++i)
            error[build].see(
                std::abs(got[i] - reference::fresnel_dielectric(inputs[0][i], inputs[1][i])),
                [&] { return fmt::format("cos {:a}, index ratio {}", inputs[0][i], inputs[1][i]); });
    }
}

void schlick(CaseRun& run) {
    ProbeSet probes(run.device, {"scattering/fresnel.h"}, {SCHLICK});
    Figure& outside = run.figure("values outside [F0, 1]", 0);
    Columns inputs(2);
    for (const float f0 : {0.0f, 0.04f, 0.5f, 0.999f, 1.0f})
        for (int i = -4; i <= 4; ++i)
            for (const float cosine : {float(i) * float(FLOAT_U), 1 + float(i) * 2 * float(FLOAT_U),
                                       0.5f + float(i) * float(FLOAT_U)}) {
                inputs[0].push_back(f0);
                inputs[1].push_back(cosine);
            }
    for (const Build build : run.builds()) {
        const std::vector<double> got = probes.run(build, "schlick", inputs)[0];
        for (size_t i = 0; i < got.size(); ++i)
            outside[build].count(!(got[i] >= inputs[0][i] && got[i] <= 1), [&] {
                return fmt::format("F0 {}, cos {:a}: {}", inputs[0][i], inputs[1][i], got[i]);
            });
    }
}

} // namespace

const std::vector<StabilityCase>& grazing_cases() {
    static const std::vector<StabilityCase> cases = {
        {"G01", "GrazedPlane", "a plane seen at 1e-1 to 1e-6 rad", "x = h / tan in double",
         "four roundings across the ray, over the angle along it", grazed_plane},
        {"G02", "GrazingBsdfs", "every BSDF at cosines from 0.1 to 1e-30 and 0, evaluated and sampled",
         "numbers that are finite and not negative",
         "a law; weights: one lobe returns at most its colour, two that are chosen by size at most the sum "
         "of their sizes",
         grazing_bsdfs},
        {"G03", "FresnelGrid", "4097 cosines from 0 to 1, eight index ratios of dielectrics",
         "Fresnel's formulas in long double", "seven roundings of values up to 1", fresnel_grid},
        {"G04", "Schlick", "cosines a few roundings beyond 0 and 1", "F0 <= F <= 1", "a law", schlick},
    };
    return cases;
}

} // namespace clrt
