// SPDX-License-Identifier: Apache-2.0
// Light that a picture may lack because none of its samples has met it: how much at most, and that the
// verdict says so.
#include "render/unmet_light.h"

#include "render/cut_paths.h"
#include "render/error_report.h"
#include "support/sunlit_basin.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

constexpr double SUN_DEGREES = 0.53;

/// A basin whose floor is lit by a sun that only hits find.
class Basin : public TestScene {
public:
    explicit Basin(Integrator integrator, double sun_degrees = SUN_DEGREES) {
        add_sunlit_basin(*this, sun_degrees);
        options.transport.integrator = integrator;
        options.transport.guide = Toggle::OFF;
    }
    /// What is said about a picture of so many samples a pixel.
    ErrorReport report(std::uint32_t spp) {
        options.sampling.spp = spp;
        const Scene scene = load();
        const Render done = render();
        return make_error_report(
            done, bias_sources(scene, plan_paths(scene, options), done, options.transport.integrator), 0, 0);
    }
};

double mean_of(const Render& render) {
    double sum = 0;
    const std::vector<float> picture = film_mean(render.film);
    for (const float value : picture)
        sum += value;
    return sum / double(picture.size());
}

} // namespace

TEST(UnmetLight, MakesThePictureIncompleteUntilThereAreEnoughSamples) {
    for (const Integrator integrator : {Integrator::PATH_LIGHT, Integrator::MLT}) {
        const ErrorReport few = Basin(integrator).report(64), more = Basin(integrator).report(256);
        ASSERT_TRUE(few.unmet && more.unmet) << name_of(integrator);
        EXPECT_FALSE(is_complete(few));
        EXPECT_NE(verdict_on(few), Verdict::TRUSTED);
        EXPECT_GT(few.unmet->relative_bound, 2 * more.unmet->relative_bound);
        const ErrorReport large = Basin(integrator, 60).report(64);
        EXPECT_FALSE(large.unmet) << "a sun of a tenth of the sky is met often enough: "
                                  << large.unmet->relative_bound;
    }
}

TEST(UnmetLight, HoldsWhatAPictureLacks) {
    Basin guided(Integrator::BDPT);
    guided.options.transport.guide = Toggle::ON;
    guided.options.sampling.spp = 1024;
    const Scene scene = guided.load();
    const PathPlan plan = plan_paths(scene, guided.options);
    const Render whole = guided.render();
    ASSERT_TRUE(whole.guide.guided_from);
    EXPECT_FALSE(hit_light(scene, plan, Integrator::BDPT, whole.guide)) << "the guide looks for it";
    EXPECT_TRUE(hit_light(scene, plan, Integrator::PATH, whole.guide)) << "that of path does not";

    Basin few(Integrator::PATH_LIGHT);
    few.options.sampling.spp = 16;
    const Render part = few.render();
    const double lacked = mean_of(whole) / mean_of(part) - 1;
    EXPECT_GT(lacked, 0.1) << "a picture that lacks nothing tests nothing";
    const std::optional<UnmetLight> unmet =
        unmet_light(part, hit_light(scene, plan, Integrator::PATH_LIGHT, part.guide));
    ASSERT_TRUE(unmet);
    EXPECT_GT(unmet->relative_bound, lacked);
}

TEST(UnmetLight, OfChainsOneStepInTenCanMeet) {
    const Basin basin(Integrator::MLT);
    const Scene scene = basin.load();
    const PathPlan plan = plan_paths(scene, basin.options);
    const double by_chains = hit_light(scene, plan, Integrator::MLT, {})->radiance,
                 by_paths = hit_light(scene, plan, Integrator::PATH_LIGHT, {})->radiance;
    EXPECT_NEAR(by_chains / by_paths, 10, 1e-9);
}

} // namespace clrt
