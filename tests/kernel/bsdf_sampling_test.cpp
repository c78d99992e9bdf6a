// SPDX-License-Identifier: Apache-2.0
// scattering/bsdf.h: sampled directions against their density, over a drawn half of all sets of lobes that
// have one.
#include "probes/bsdf_probe.h"
#include "probes/sphere_cells.h"
#include "probes/statistics.h"
#include "support/drawn.h"

#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

constexpr size_t SAMPLES = 1000000;

/// Error of the quadrature of a whole density: rough glass has an edge at the critical angle.
constexpr double MASS_ERROR = 1.5e-3;

BsdfProbe& probe() {
    static BsdfProbe instance(test_device());
    return instance;
}

/// Directions to the eye: head-on, oblique, grazing.
std::vector<dvec3> eyes() {
    return {direction_at(1, 0), direction_at(0.7, 0.9), direction_at(0.3, 3.6), direction_at(0.05, -1.2)};
}

void expect_directions_follow_pdf(const LobeSet& set, const dvec3& wo, const SphereCells& cells,
                                  const std::vector<dvec3>& nodes, const std::vector<dvec3>& u) {
    const BsdfValues density = probe().eval(set, repeated(wo, nodes.size()), nodes);
    std::vector<double> expected = cells.integrals(density.pdf_w);
    const double mass = total(expected);
    const std::vector<dvec3> found = probe().sample(set, repeated(wo, u.size()), u).found();
    for (double& cell : expected)
        cell *= double(u.size());
    EXPECT_GT(chi_squared_test(cells.histogram(found), expected).p_value, SMALLEST_P)
        << set.name << ", cos " << wo.z;

    // What the density lacks to 1 is the share of samples without a direction.
    const double share = double(found.size()) / double(u.size());
    EXPECT_NEAR(share, mass, MASS_ERROR + 6 * std::sqrt(share * (1 - share) / double(u.size())))
        << set.name << ", cos " << wo.z;
}

} // namespace

TEST(BsdfSampling, SampledDirectionsFollowPdf) {
    const SphereCells cells(64, 64, 12);
    const std::vector<dvec3> nodes = cells.nodes(), u = random_triples(SAMPLES, 1);
    for (const LobeSet& set : drawn(all_lobe_sets(), 2))
        if (probe().has_smooth_lobe(set) && !(set.lobes & LOBE_MIRROR))
            for (const dvec3& wo : eyes())
                expect_directions_follow_pdf(set, wo, cells, nodes, u);
}

TEST(BsdfSampling, TheMatteLobeBesideAMirrorFollowsItsShareOfThePdf) {
    const SphereCells cells(32, 32, 4);
    const std::vector<dvec3> nodes = cells.nodes(), u = random_triples(SAMPLES, 2);
    for (const char* name : {"matte and mirror", "matte and mirror, Schlick"}) {
        const LobeSet set = lobe_set(name);
        for (const dvec3& wo : eyes()) {
            std::vector<double> expected =
                cells.integrals(probe().eval(set, repeated(wo, nodes.size()), nodes).pdf_w);
            const BsdfSamples samples = probe().sample(set, repeated(wo, SAMPLES), u);
            std::vector<dvec3> spread;
            for (size_t i = 0; i < SAMPLES; ++i)
                if (samples.pdf_w[i] > 0)
                    spread.push_back(samples.wi[i]);
            std::vector<double> counts = cells.histogram(spread);
            // The mirror takes the rest.
            counts.push_back(double(SAMPLES - spread.size()));
            expected.push_back(1 - total(expected));
            for (double& cell : expected)
                cell *= double(SAMPLES);
            EXPECT_GT(chi_squared_test(counts, expected).p_value, SMALLEST_P) << name << ", cos " << wo.z;
        }
    }
}
