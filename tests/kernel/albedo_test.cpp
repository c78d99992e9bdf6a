// SPDX-License-Identifier: Apache-2.0
// scattering/albedo.h: the tables, between their nodes, against integrals in double precision. They stand on
// the side on which nothing made from them adds light.
#include "probes/bsdf_probe.h"
#include "probes/closed_forms.h"
#include "support/test_device.h"

#include <cmath>
#include <gtest/gtest.h>

using namespace clrt;
using glm::dvec3;

namespace {

/// How far a loss may be above the integral, and below it: tables of more dimensions have fewer nodes on each
/// axis.
constexpr double MOST_ABOVE = 1e-3;
constexpr double MOST_BELOW_ROUND = 2e-3, MOST_BELOW_GLASS = 2e-2, MOST_BELOW_STRETCHED = 4e-2;

BsdfProbe& probe() {
    static BsdfProbe instance(test_device());
    return instance;
}

double one(double) {
    return 1;
}

double grazing(double cosine) {
    return std::pow(1 - cosine, 5);
}

LobeSet glossy(double alpha_x, double alpha_y) {
    LobeSet set = lobe_set("glossy");
    set.alpha_x = alpha_x;
    set.alpha_y = alpha_y;
    return set;
}

/// Loss and Schlick's part of one direction, against the integrals.
void expect_albedo(const RoughSurface& surface, double most_below) {
    const dvec3 w = direction_at(surface.cos_o, surface.azimuth_o);
    const AlbedoSample got = probe().albedos(glossy(surface.alpha_x, surface.alpha_y), {w})[0];
    const double loss = 1 - rough_reflection_albedo(surface, one),
                 b = rough_reflection_albedo(surface, grazing);
    EXPECT_LE(got.loss, loss + MOST_ABOVE);
    EXPECT_GE(got.loss, loss - most_below);
    EXPECT_GE(got.schlick, b - MOST_ABOVE);
    EXPECT_LE(got.schlick, b + most_below);
}

/// Mean over the hemisphere, weighted by the cosine; rounds are means over azimuths.
template <class Value>
double hemispherical_mean(const Value& value) {
    constexpr int STEPS = 64;
    double sum = 0;
    for (int i = 0; i < STEPS; ++i)
        sum += value((i + 0.5) / STEPS) * 2 * (i + 0.5) / STEPS / STEPS;
    return sum;
}

double mean_of_kernel(const LobeSet& set, double side) {
    return hemispherical_mean([&](double cosine) {
        return probe().albedos(set, {direction_at(cosine, 0.3) * dvec3(1, 1, side)})[0].loss;
    });
}

} // namespace

TEST(Albedo, OfRoundLobesIsTheIntegral) {
    for (const double alpha : {0.06, 0.15, 0.33, 0.61, 1.0})
        for (const double cosine : {0.21, 0.4, 0.77, 1.0}) {
            SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", cos " << cosine);
            expect_albedo({alpha, alpha, cosine, 0}, MOST_BELOW_ROUND);
        }
}

TEST(Albedo, OfStretchedLobesFollowsTheAzimuth) {
    for (const double alpha : {0.15, 0.5})
        for (const double aniso : {0.4, 1.0})
            for (const double azimuth : {0.0, 0.7, PI / 2})
                for (const double cosine : {0.3, 0.8}) {
                    SCOPED_TRACE(testing::Message() << "alpha " << alpha << ", aniso " << aniso
                                                    << ", azimuth " << azimuth << ", cos " << cosine);
                    const double aspect = std::sqrt(1 - 0.9 * aniso);
                    expect_albedo({alpha / aspect, alpha * aspect, cosine, azimuth}, MOST_BELOW_STRETCHED);
                    expect_albedo({alpha * aspect, alpha / aspect, cosine, PI / 2 - azimuth},
                                  MOST_BELOW_STRETCHED);
                }
}

TEST(Albedo, OfGlassIsWhatIsNeitherReflectedNorRefracted) {
    for (const double alpha : {0.15, 0.5, 1.0})
        for (const double eta : {1 / 2.4, 1 / 1.5, 1 / 1.1, 1.1, 1.5, 2.4})
            for (const double cosine : {0.25, 0.6, 1.0}) {
                SCOPED_TRACE(testing::Message()
                             << "alpha " << alpha << ", eta " << eta << ", cos " << cosine);
                LobeSet set = lobe_set("rough glass from outside");
                set.alpha_x = set.alpha_y = alpha;
                set.eta = eta;
                const RoughSurface surface{alpha, alpha, cosine, 0};
                const double loss =
                    1 - rough_transmission_albedo(surface, eta) -
                    rough_reflection_albedo(surface, [&](double c) { return fresnel_reflectance(c, eta); });
                const double got = probe().albedos(set, {direction_at(cosine, 0.3)})[0].loss;
                EXPECT_LE(got, loss + MOST_ABOVE);
                EXPECT_GE(got, loss - MOST_BELOW_GLASS);
            }
}

TEST(Albedo, MeansAreThoseOfTheTables) {
    for (const double alpha : {1.2e-4, 1e-3, 0.01, 0.1, 0.33, 1.0}) {
        const LobeSet round = glossy(alpha, alpha);
        const AlbedoSample mean = probe().albedos(round, {{0, 0, 1}})[0];
        if (alpha >= 0.1) { // below, the sum misses the peak at the horizon
            EXPECT_NEAR(mean_of_kernel(round, 1) / mean.mean_loss, 1, 1e-2) << alpha;
        }
        EXPECT_NEAR(hemispherical_mean([&](double cosine) {
                        return probe().albedos(round, {direction_at(cosine, 0)})[0].schlick;
                    }),
                    mean.mean_schlick, 5e-4)
            << alpha;
    }
    for (const double alpha : {0.2, 1.0})
        for (const double eta : {1 / 1.5, 1.5}) {
            LobeSet set = lobe_set("rough glass from outside");
            set.alpha_x = set.alpha_y = alpha;
            set.eta = eta;
            for (const double side : {1.0, -1.0})
                EXPECT_NEAR(mean_of_kernel(set, side) / probe().albedos(set, {{0, 0, side}})[0].mean_loss, 1,
                            2e-2)
                    << alpha << " " << eta << " " << side;
        }
}
