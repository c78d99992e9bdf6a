// SPDX-License-Identifier: Apache-2.0
// Reciprocity and probability: densities against samples, and the numbers and frames that all of it is made
// from.
#include "stability/bsdf_set.h"
#include "stability/cases/shading_expressions.h"
#include "stability/catalogue.h"

#include "probes/random_inputs.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"

#include <fmt/format.h>

namespace clrt {

namespace {

using glm::dvec3;

/// Index of a set by its name.
size_t set_index(const std::string& name) {
    const std::vector<LobeSet> sets = textbook_sets();
    for (size_t i = 0; i < sets.size(); ++i)
        if (sets[i].name == name)
            return i;
    throw std::logic_error("no lobe set " + name);
}

/// True where float directions fix the reflectance of the microfacet to 1e-5: neither is it seen edge-on nor
/// near the critical angle.
bool is_well_conditioned(const LobeSet& set, const dvec3& wo, const dvec3& wi) {
    if (!(set.lobes & LOBE_DIELECTRIC))
        return true;
    const dvec3 h = glm::normalize(wi.z > 0 ? wo + wi : set.eta * wo + wi);
    const double cosine = glm::dot(wo, h), left = 1 - set.eta * set.eta * (1 - cosine * cosine);
    return std::abs(cosine) > 0.2 && std::abs(glm::dot(wi, h)) > 0.2 && std::abs(left) > 0.04;
}

/// Pairs of directions for one set there, and turned round for another back.
struct Reciprocal {
    BsdfInputs there, back;
    std::vector<double> scale; ///< of the way back
    std::vector<char> is_conditioned;

    void add(size_t set, const dvec3& a, size_t other, const dvec3& b, double way_back) {
        // The same floats both ways.
        const dvec3 x = to_dvec3(to_vec4(a)), y = to_dvec3(to_vec4(b)), flip(1, 1, b.z < 0 ? -1 : 1);
        there.add(set, 0, x, y);
        back.add(other, 0, y * flip, x * flip);
        scale.push_back(way_back);
        is_conditioned.push_back(is_well_conditioned(textbook_sets()[set], x, y));
    }
};

void reciprocity(CaseRun& run) {
    Figure& reflection = run.figure("relative difference, reflection", 1e-5);
    Figure& transmission = run.figure("relative difference, transmission over eta^2", 1e-5);
    Reciprocal pairs;
    Random random(1);
    const std::vector<LobeSet> sets = textbook_sets();
    const size_t count = run.count(2e4, 2e5, 5e5);
    const size_t outside = set_index("rough glass from outside"),
                 inside = set_index("rough glass from inside");
    for (size_t i = 0; i < count; ++i) {
        const dvec3 a = direction_at(random.between(0.02, 1), 2 * PI * random.unit()),
                    b = direction_at(random.between(0.02, 1), 2 * PI * random.unit());
        // Lobes that are chosen by the eye's cosine have a reciprocal value all the same.
        for (size_t set = 0; set < sets.size(); ++set)
            if (is_smooth(sets[set]))
                pairs.add(set, a, set, b, 1);
        pairs.add(outside, a, inside, {b.x, b.y, -b.z}, 1 / (1.5 * 1.5));
    }
    for (const Build build : run.builds()) {
        if (build == Build::NAIVE)
            continue;
        const auto there = bsdf_probes(run.device).run(build, "eval", pairs.there.columns);
        const auto back = bsdf_probes(run.device).run(build, "eval", pairs.back.columns);
        for (size_t i = 0; i < pairs.there.size(); ++i) {
            const double cos_b = pairs.there.columns[7][i], cos_a = pairs.there.columns[4][i];
            const double f = there[0][i] / std::abs(cos_b), g = back[0][i] / std::abs(cos_a) * pairs.scale[i];
            if (std::max(f, g) == 0 || !pairs.is_conditioned[i])
                continue;
            (cos_b < 0 ? transmission : reflection)[build].see(std::abs(f - g) / std::max(f, g),
                                                               [&] { return pairs.there.describe(i); });
        }
    }
}

/// Sets that have a density, and directions to the eye.
template <class Visit>
void for_each_density(const Visit& visit) {
    const std::vector<LobeSet> sets = textbook_sets();
    for (size_t set = 0; set < sets.size(); ++set)
        if (is_smooth(sets[set]) && !(sets[set].lobes & LOBE_MIRROR))
            for (const dvec3& wo : {direction_at(1, 0), direction_at(0.7, 0.9), direction_at(0.3, 3.6),
                                    direction_at(0.05, -1.2)})
                visit(set, wo);
}

/// The density of a set at directions, by the double build where there is one.
std::vector<double> densities(const CaseRun& run, size_t set, const dvec3& wo,
                              const std::vector<dvec3>& directions) {
    BsdfInputs inputs;
    for (const dvec3& wi : directions)
        inputs.add(set, 0, wo, wi);
    const Build build = run.device.info.fp64 ? Build::DOUBLE : Build::SINGLE;
    return bsdf_probes(run.device).run(build, "eval", inputs.columns)[EVAL_PDF];
}

struct Sampled {
    std::vector<dvec3> found;
    size_t tried = 0;
};

Sampled sampled(const CaseRun& run, size_t set, const dvec3& wo, size_t count, u32 seed) {
    BsdfInputs inputs;
    Random random(seed);
    for (size_t i = 0; i < count; ++i) {
        const double lobe = random.unit(), x = random.unit();
        inputs.add(set, 0, wo, {lobe, x, random.unit()});
    }
    const auto got = bsdf_probes(run.device).run(Build::SINGLE, "sample", inputs.columns);
    Sampled result;
    result.tried = count;
    for (size_t i = 0; i < count; ++i)
        if (got[SAMPLED_ETA][i] != 0)
            result.found.push_back(output_vector(got, SAMPLED_WI, i));
    return result;
}

void chi_squared(CaseRun& run) {
    Figure& fit = run.figure("-log10 of p", -std::log10(2e-9));
    Figure& stray = run.figure("samples where the density is 0", 0);
    const SphereCells cells(64, 64, 8);
    const std::vector<dvec3> nodes = cells.nodes();
    const size_t count = run.count(1e5, 1e6, 1e7);
    for_each_density([&](size_t set, const dvec3& wo) {
        std::vector<double> expected = cells.integrals(densities(run, set, wo, nodes));
        const Sampled samples = sampled(run, set, wo, count, u32(set + 2));
        const std::vector<double> counts = cells.histogram(samples.found);
        const auto describe = [&] { return fmt::format("{}, cos {}", textbook_sets()[set].name, wo.z); };
        for (size_t i = 0; i < expected.size(); ++i) {
            expected[i] *= double(samples.tried);
            stray[Build::SINGLE].count(counts[i] > 0 && expected[i] == 0, describe);
        }
        const double p = chi_squared_test(counts, expected).p_value;
        fit[Build::SINGLE].see(p > 0 ? std::max(0.0, -std::log10(p)) : 1e3, describe);
    });
}

void pdf_mass(CaseRun& run) {
    Figure& mass = run.figure("|mass of the density + share without a sample - 1|", 5e-4);
    Figure& narrow = run.figure("the same of rough glass, and seen at a cosine of 0.05", 1e-3);
    const SphereCells cells(64, 64, 12);
    const std::vector<dvec3> nodes = cells.nodes();
    const size_t count = run.count(1u << 19, 1u << 20, 1u << 22);
    for_each_density([&](size_t set, const dvec3& wo) {
        BsdfInputs inputs; // Roberts' lattice
        for (size_t i = 0; i < count; ++i) {
            const auto part = [&](double ratio) { return std::fmod((double(i) + 0.5) * ratio, 1.0); };
            inputs.add(set, 0, wo, {part(0.8191725134), part(0.6710436067), part(0.5497004779)});
        }
        const auto got = bsdf_probes(run.device).run(Build::SINGLE, "sample", inputs.columns);
        double failed = 0;
        for (size_t i = 0; i < inputs.size(); ++i)
            failed += got[SAMPLED_ETA][i] == 0;
        const double whole = total(cells.integrals(densities(run, set, wo, nodes)));
        const bool is_narrow = (textbook_sets()[set].lobes & LOBE_DIELECTRIC) || wo.z < 0.1;
        (is_narrow ? narrow : mass)[Build::SINGLE].see(
            std::abs(whole + failed / double(inputs.size()) - 1),
            [&] { return fmt::format("{}, cos {}", textbook_sets()[set].name, wo.z); });
    });
}

} // namespace

const std::vector<StabilityCase>& distribution_cases() {
    static const std::vector<StabilityCase> cases = {
        {"P01", "Reciprocity",
         "every BSDF that is no delta function, both ways, off critical angles and edge-on microfacets",
         "Helmholtz: f(a, b) = f(b, a), transmission over the squared index",
         "two half vectors of float directions, magnified by the slope of D", reciprocity},
        {"P02", "SamplesFollowDensity", "every BSDF with a density, four eyes, 64 x 64 cells",
         "chi-squared against the density integrated over cells", "one false alarm in 5e8 a test",
         chi_squared},
        {"P03", "DensityMass", "the same densities over the sphere",
         "1 less the share of samples without a direction",
         "quadrature of 64 x 64 cells of 12 x 12 points and a lattice, for which the choice of a lobe is a "
         "jump; it converges "
         "slowly over the edge at the critical angle and the peaks "
         "of grazing reflection",
         pdf_mass},
        {"P04", "Bases", "random normals, axes, -0, z = -1 + k ulp", "orthonormal, right-handed",
         "products of unit vectors of float", bases},
        {"P05", "Uniforms", "all 2^24 numbers that words give",
         "0 < u < 1, 1 - u exact; the words of the host", "a law", uniforms},
        {"P06", "Streams", "the first four words of every pixel", "no two alike",
         "a law: keys are a bijection of pixels", streams},
        {"P07", "Nets", "pairs of 2^m samples at several addresses", "one point in each elementary interval",
         "a law", nets},
    };
    return cases;
}

} // namespace clrt
