// SPDX-License-Identifier: Apache-2.0
// Dielectrics: the critical angle, Snell's law, equal indices.
#include "stability/cases/shading_expressions.h"
#include "stability/catalogue.h"
#include "stability/choices.h"

#include "probes/random_inputs.h"
#include "probes/reference.h"
#include "probes/sphere_cells.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/vec2.hpp>

namespace clrt {

namespace {

const ProbedExpression FRESNEL = {
    "fresnel", 2, 1, "real t; out[0] = fresnel_dielectric(a, b, &t);",
    "const real k = REAL(1.0) - b * b * (REAL(1.0) - a * a); const real t = sqrt(fmax(k, REAL(0.0)));"
    "const real s = (b * a - t) / (b * a + t), p = (a - b * t) / (a + b * t);"
    "out[0] = k <= REAL(0.0) ? REAL(1.0) : REAL(0.5) * (s * s + p * p);"};

/// a, b, c: direction to the eye over the normal z; d: index ratio. The refracted direction, and the cosine
/// of the incident angle where all is reflected.
const ProbedExpression REFRACT = {
    "refract", 4, 4,
    "real t; const real f = fresnel_dielectric(c, d, &t); const real3 n = vector_make(REAL(0.0), REAL(0.0), "
    "REAL(1.0));"
    "const real3 w = fresnel_refract(vector_make(a, b, c), n, c, t, d); out[0] = w.x; out[1] = w.y; out[2] = "
    "w.z; out[3] = f;",
    "const real k = REAL(1.0) - d * d * (REAL(1.0) - c * c); const real t = sqrt(fmax(k, REAL(0.0)));"
    "out[0] = -d * a; out[1] = -d * b; out[2] = d * c - t - d * c; out[3] = k <= REAL(0.0) ? REAL(1.0) : "
    "REAL(0.0);"};

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

void snell(CaseRun& run) {
    ProbeSet probes(run.device, {"scattering/fresnel.h"}, {REFRACT});
    Figure& residual = run.figure("|sin_t - eta sin_i| / max(1, eta^2)", 4 * FLOAT_U);
    Figure& length = run.figure("| |wi| - 1 |", 4 * FLOAT_U);
    Random random(2);
    Columns inputs(4);
    const size_t count = run.count(2e5, 2e6, 8e6);
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 wo = random.upper_direction();
        const double etas[] = {1.5, 1 / 1.5, 2.417, 1.333, 1.0001, 1 / 2.417};
        const double row[] = {wo.x, wo.y, wo.z, etas[i % 6]};
        for (size_t k = 0; k < 4; ++k)
            inputs[k].push_back(float(row[k]));
    }
    for (const Build build : run.builds()) {
        const std::vector<std::vector<double>> got = probes.run(build, "refract", inputs);
        for (size_t i = 0; i < count; ++i) {
            if (got[3][i] == 1)
                continue;
            const glm::dvec3 wi(got[0][i], got[1][i], got[2][i]),
                wo(inputs[0][i], inputs[1][i], inputs[2][i]);
            const double eta = inputs[3][i];
            const auto describe = [&] {
                return fmt::format("wo {:a} {:a} {:a}, index ratio {}", inputs[0][i], inputs[1][i],
                                   inputs[2][i], eta);
            };
            const glm::dvec2 along = glm::dvec2(wi) + eta * glm::dvec2(wo) / glm::length(wo);
            residual[build].see(glm::length(along) / std::max(1.0, eta * eta), describe);
            length[build].see(std::abs(glm::length(wi) - 1), describe);
        }
    }
}

/// The mean of F over the hemisphere, weighted by the cosine: Gauss-Legendre on either side of the critical
/// cosine, where the integrand is made smooth by c = c0 + (1 - c0) s^2.
double hemispherical(ProbeSet& probes, Build build, double eta) {
    const std::vector<QuadraturePoint> rule = gauss_legendre(128);
    const double c0 = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
    std::vector<float> cosines;
    std::vector<double> weights;
    for (const QuadraturePoint& q : rule) {
        cosines.push_back(float(c0 + (1 - c0) * q.at * q.at));
        weights.push_back(q.weight * 2 * (1 - c0) * q.at * 2 * cosines.back());
        cosines.push_back(float(c0 * q.at));
        weights.push_back(q.weight * c0 * 2 * cosines.back());
    }
    const std::vector<double> f =
        probes.run(build, "fresnel", {cosines, std::vector<float>(cosines.size(), float(eta))})[0];
    double sum = 0;
    for (size_t i = 0; i < f.size(); ++i)
        sum += weights[i] * f[i];
    return sum;
}

void hemispherical_reflectance(CaseRun& run) {
    ProbeSet probes(run.device, {"scattering/fresnel.h"}, {FRESNEL});
    Figure& mean = run.figure("|mean of F - closed form|", 1e-6);
    for (const Build build : run.builds()) {
        mean[build].see(std::abs(hemispherical(probes, build, 1 / 1.5) - 0.0917779594),
                        [] { return "from outside"; });
        mean[build].see(std::abs(hemispherical(probes, build, 1.5) - 0.5963457597),
                        [] { return "from inside"; });
    }
}

} // namespace

const ProbedExpression& fresnel_expression() {
    return FRESNEL;
}

ProbeTime time_fresnel(const ProbeDevice& device, int rounds) {
    Random random(1);
    Columns inputs(2);
    for (int i = 0; i < 1 << 20; ++i) {
        inputs[0].push_back(float(random.unit()));
        inputs[1].push_back(float(random.between(0.5, 2)));
    }
    return ProbeSet(device, {"scattering/fresnel.h"}, {FRESNEL}).time("fresnel", inputs, rounds);
}

const std::vector<StabilityCase>& dielectric_cases() {
    static const std::vector<StabilityCase> cases = {
        {"T01", "CriticalAngle", "4096 neighbouring cosines around the critical angle of five indices",
         "Fresnel's formulas in long double",
         "seven roundings of values up to 1; the float at the critical cosine itself may fall to either side",
         critical_angle},
        {"T02", "SnellsLaw", "random directions, six index ratios",
         "the part along the surface of the refracted direction is eta times the incident one",
         "the incident direction's length is off by u, which refraction magnifies by eta^2; three roundings "
         "more",
         snell},
        {"T03", "IndexOfOne", "a ball of index 1 in front of a gradient, and F at all angles",
         "the same without the ball; F = 0",
         "two directions are made unit again: 4 ULP of a radiance whose slope is about 1", index_one_ball},
        {"T04", "GlassSlab", "a slab of index 1.5 seen head-on, all internal reflections",
         "(1 - R) / (1 + R)", "thirty roundings of terms that fall by 600 each; noise for path tracing",
         glass_slab},
        {"T05", "SlabShift", "a ray through a slab at 10 to 80 degrees", "t sin(a - b) / cos b",
         "8 u of the scene's size, and the two offsets by which the ray leaves the faces", slab_shift},
        {"T06", "ThinSlab",
         "slabs of size 1: 1e-5 thick at the origin, 4 ULP of a coordinate thick 1000 away",
         "every ray meets both faces and nothing else", "a law", thin_slab},
        {"T08", "StartInside", "the eye inside glass below a bright sky",
         "F and (1 - F) eta^2 by Fresnel and Snell",
         "4e-7 of F times eta^2, and a rounding of the cosine where F is steep", start_inside},
        {"T09", "TrappedLight", "a cube of glass whose faces glow, total reflection over 1000 segments",
         "1000 times the glow", "one rounding of throughput and sum a segment", trapped_light},
        {"T10", "GlassBallFurnace", "a ball of index 2.417 under a white sky",
         "1 for every path that gets out",
         "8 ULP for factors eta^2 and their reciprocals; R^depth for the rest", glass_ball},
        {"T11", "HemisphericalReflectance", "the device's F by quadrature, index 1.5 from both sides",
         "0.0917779594 and 0.5963457597", "the cosines' rounding times the slope of F",
         hemispherical_reflectance},
    };
    return cases;
}

} // namespace clrt
