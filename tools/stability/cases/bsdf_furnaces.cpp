// SPDX-License-Identifier: Apache-2.0
// What a BSDF returns of white light from everywhere, and what one sample of two lobes may weigh.
#include "stability/bsdf_set.h"
#include "stability/cases/shading_expressions.h"

#include "probes/random_inputs.h"
#include "probes/reference.h"

#include <fmt/format.h>

namespace clrt {

using glm::dvec3;

namespace {

/// What one facet of a lossless mirror does not send on, and the mean of it over a hemisphere of equal
/// radiance.
double loss(const LobeSet& set, double cosine, double azimuth) {
    return 1 -
           rough_reflection_albedo({set.alpha_x, set.alpha_y, cosine, azimuth}, [](double) { return 1.0; });
}

double mean_loss(const LobeSet& set) {
    constexpr int COSINES = 12, AZIMUTHS = 3;
    double sum = 0;
    for (int i = 0; i < COSINES; ++i)
        for (int k = 0; k < AZIMUTHS; ++k) {
            const double cosine = (i + 0.5) / COSINES;
            sum += loss(set, cosine, (k + 0.5) / AZIMUTHS * PI / 2) * 2 * cosine;
        }
    return sum / (COSINES * AZIMUTHS);
}

/// Mean of a function of the cosine over a hemisphere of equal radiance.
template <class Function>
double hemispherical_mean(const Function& function) {
    constexpr int STEPS = 512;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i)
        sum += function(std::sqrt((i + 0.5) / STEPS)) / STEPS;
    return sum;
}

/// What white light from everywhere becomes, red channel; radiance behind glass freed of its eta^2. More than
/// one facet: Kulla and Conty 2017; the matte lobe gets what Fresnel's reflection leaves.
double expected_albedo(const LobeSet& set, double cosine, double azimuth) {
    const RoughSurface surface{set.alpha_x, set.alpha_y, cosine, azimuth};
    if (set.lobes & LOBE_DIELECTRIC) {
        const double reflected =
            rough_reflection_albedo(surface, [&](double c) { return fresnel_reflectance(c, set.eta); });
        const double refracted = rough_transmission_albedo(surface, set.eta);
        const double more = 1 - reflected - refracted; // crosses as often as it likes: red is not tinted
        return reflected + refracted + more;
    }
    const bool schlick = set.fresnel == FRESNEL_SCHLICK;
    const auto fresnel = [&](double c) {
        return set.fresnel == FRESNEL_CONDUCTOR
                   ? reference::fresnel_conductor(c, set.transmission.x, set.specular.x)
               : schlick ? set.specular.x + (1 - set.specular.x) * std::pow(1 - c, 5)
                         : set.specular.x;
    };
    const double f = set.fresnel == FRESNEL_CONDUCTOR ? hemispherical_mean(fresnel)
                     : schlick                        ? set.specular.x + (1 - set.specular.x) / 21
                                                      : set.specular.x;
    const double lost = mean_loss(set), colour = f * f * (1 - lost) / (1 - f * lost);
    const double above = rough_reflection_albedo(surface, fresnel) + colour * loss(set, cosine, azimuth);
    return above + set.matte.x * (schlick ? 1 - above : 1);
}

/// The weight of a sample, red, without the squared index ratio.
double energy(const std::vector<std::vector<double>>& got, size_t i) {
    const double eta = got[SAMPLED_ETA][i];
    return eta == 0 ? 0 : got[SAMPLED_WEIGHT][i] / (eta * eta);
}

} // namespace

void bsdf_furnace(CaseRun& run) {
    Figure& lossless = run.figure("|weight - colour| of matte, mirror, smooth glass", 8 * FLOAT_U);
    Figure& albedo = run.figure("|mean weight - albedo| of rough reflection", 5e-3);
    Figure& others = run.figure("the same of stretched lobes and rough glass", 2e-2);
    const std::vector<LobeSet> sets = textbook_sets();
    const size_t count = run.count(1u << 16, 1u << 20, 1u << 22);
    for (size_t set = 0; set < sets.size(); ++set)
        for (const double cosine : {0.3, 0.6, 1.0}) {
            if (sets[set].lobes == LOBE_MIRROR && sets[set].fresnel != FRESNEL_NONE)
                continue;
            if ((sets[set].lobes & LOBE_MATTE) && (sets[set].lobes & LOBE_MIRROR))
                continue;
            const bool is_rough = is_smooth(sets[set]) && sets[set].lobes != LOBE_MATTE;
            BsdfInputs inputs; // a lattice (Roberts' generalised golden ratio)
            for (size_t i = 0; i < (is_rough ? count : 1024); ++i) {
                const double n = double(i) + 0.5;
                const auto part = [&](double ratio) {
                    return std::min(n * ratio - std::floor(n * ratio), 1 - FLOAT_U) + FLOAT_U / 2;
                };
                inputs.add(set, 0, direction_at(cosine, 0.5),
                           dvec3(part(0.8191725134), part(0.6710436067), part(0.5497004779)));
            }
            const double expected = is_rough                        ? expected_albedo(sets[set], cosine, 0.5)
                                    : sets[set].lobes == LOBE_MATTE ? sets[set].matte.x
                                                                    : sets[set].specular.x;
            for (const Build build : run.builds()) {
                if (build == Build::NAIVE)
                    continue;
                const auto got = bsdf_probes(run.device).run(build, "sample", inputs.columns);
                double sum = 0;
                for (size_t i = 0; i < inputs.size(); ++i) {
                    sum += energy(got, i);
                    if (!is_rough)
                        lossless[build].see(std::abs(energy(got, i) - expected),
                                            [&] { return inputs.describe(i); });
                }
                if (is_rough)
                    (sets[set].lobes != LOBE_DIELECTRIC && sets[set].alpha_x == sets[set].alpha_y
                         ? albedo
                         : others)[build]
                        .see(std::abs(sum / double(inputs.size()) - expected),
                             [&] { return inputs.describe(0); });
            }
        }
}

void coloured_lobes(CaseRun& run) {
    Figure& excess = run.figure("weight of a sample over the sum of both lobes' sizes", 1 + 8 * FLOAT_U);
    ProbeSet probes(
        run.device, {"scattering/bsdf.h"},
        {{"coloured", 7, 1,
          "Bsdf bsdf; bsdf.normal_g = vector_make(REAL(0.0), REAL(0.0), REAL(1.0)); bsdf.frame = "
          "frame_make(bsdf.normal_g);"
          "bsdf.wo = vector_make(REAL(0.6), REAL(0.0), REAL(0.8)); bsdf.is_curved = false; "
          "bsdf.flags = 0u; bsdf.fresnel = "
          "FRESNEL_NONE;"
          "bsdf.lobes = LOBE_MATTE | LOBE_MIRROR; bsdf.alpha_x = bsdf.alpha_y = REAL(0.0); "
          "bsdf.eta = REAL(1.0); bsdf.exponent "
          "= REAL(0.0);"
          "bsdf.matte = vector_make(a, b, c); bsdf.specular = vector_make(d, e, f); "
          "bsdf.transmission = bsdf.matte;"
          "bsdf_energy_set(&bsdf); bsdf_choose_lobes(&bsdf); const BsdfSample s = bsdf_sample(&bsdf, g, "
          "(real2)(REAL(0.3), REAL(0.4)));"
          "out[0] = vector_max_component(s.weight) / (vector_length(bsdf.matte) + "
          "vector_length(bsdf.specular));",
          "const real m = vector_luminance(vector_make(a, b, c)), r = "
          "vector_luminance(vector_make(d, e, f)), p = m / (m + r);"
          "out[0] = (g < p ? vector_max_component(vector_make(a, b, c)) / p : "
          "vector_max_component(vector_make(d, e, f)) / "
          "(REAL(1.0) - p)) /"
          "(vector_length(vector_make(a, b, c)) + vector_length(vector_make(d, e, f)));"}});
    Columns inputs(7);
    for (int matte = 1; matte < 8; ++matte)
        for (int mirror = 1; mirror < 8; ++mirror)
            for (int k = 0; k < 64; ++k) {
                const double row[] = {double(matte & 1),  double(matte >> 1 & 1),  double(matte >> 2),
                                      double(mirror & 1), double(mirror >> 1 & 1), double(mirror >> 2),
                                      (k + 0.5) / 64};
                for (size_t c = 0; c < 7; ++c)
                    inputs[c].push_back(float(row[c]));
            }
    for (const Build build : run.builds()) {
        const std::vector<double> got = probes.run(build, "coloured", inputs)[0];
        for (size_t i = 0; i < got.size(); ++i)
            excess[build].see(got[i], [&] {
                return fmt::format("Kd {} {} {}, Ks {} {} {}", inputs[0][i], inputs[1][i], inputs[2][i],
                                   inputs[3][i], inputs[4][i], inputs[5][i]);
            });
    }
}

} // namespace clrt
