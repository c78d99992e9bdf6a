// SPDX-License-Identifier: Apache-2.0
// Dielectrics: the critical angle, Snell's law, equal indices.
#include "stability/catalogue.h"
#include "stability/choices.h"

#include "support/random_inputs.h"
#include "support/reference.h"

#include <cmath>
#include <fmt/format.h>

namespace clrt {

namespace {

const ProbedExpression FRESNEL = {
    "fresnel", 2, 1, "real t; out[0] = fresnel_dielectric(a, b, &t);",
    "const real k = REAL(1.0) - b * b * (REAL(1.0) - a * a); const real t = sqrt(fmax(k, REAL(0.0)));"
    "const real s = (b * a - t) / (b * a + t), p = (a - b * t) / (a + b * t);"
    "out[0] = k <= REAL(0.0) ? REAL(1.0) : REAL(0.5) * (s * s + p * p);"};

/// 4096 neighbouring floats around the critical cosine.
std::vector<float> cosines_around_critical(float eta) {
    float cosine = float(std::sqrt(1 - 1 / (double(eta) * double(eta))));
    for (int i = 0; i < 2048; ++i)
        cosine = std::nextafter(cosine, 0.0f);
    std::vector<float> cosines;
    for (int i = 0; i < 4096; ++i, cosine = std::nextafter(cosine, 1.0f))
        cosines.push_back(cosine);
    return cosines;
}

void critical_angle(CaseRun& run) {
    ProbeSet probes(run.device, {"scattering/fresnel.h"}, {FRESNEL});
    Figure& reflectance = run.figure("|dF|", 4e-7);
    Figure& side = run.figure("wrong total reflections of an index", 1);
    for (const Build build : run.builds())
        for (const float eta : {2.4f, 2.417f, 1.333f, 1.5f, 1.0001f}) {
            const std::vector<float> cosines = cosines_around_critical(eta);
            const std::vector<double> got =
                probes.run(build, "fresnel", {cosines, std::vector<float>(cosines.size(), eta)})[0];
            double wrong = 0;
            for (size_t i = 0; i < cosines.size(); ++i) {
                const double expected = reference::fresnel_dielectric(cosines[i], eta);
                reflectance[build].see(std::abs(got[i] - expected),
                                       [&] { return fmt::format("cos {:a}, index {}", cosines[i], eta); });
                wrong += (got[i] == 1) != (expected == 1);
            }
            side[build].see(wrong, [&] { return fmt::format("index {}", eta); });
        }
}

} // namespace

ProbeTime time_fresnel(const Device& device) {
    Random random(1);
    Columns inputs(2);
    for (int i = 0; i < 1 << 20; ++i) {
        inputs[0].push_back(float(random.unit()));
        inputs[1].push_back(float(random.between(0.5, 2)));
    }
    return ProbeSet(device, {"scattering/fresnel.h"}, {FRESNEL}).time("fresnel", inputs);
}

const std::vector<StabilityCase>& dielectric_cases() {
    static const std::vector<StabilityCase> cases = {
        {"T01", "CriticalAngle", "4096 neighbouring cosines around the critical angle of five indices",
         "Fresnel's formulas in long double",
         "seven roundings of values up to 1; the float at the critical cosine itself may fall to either side", critical_angle},
    };
    return cases;
}

} // namespace clrt
