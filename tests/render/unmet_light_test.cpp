// SPDX-License-Identifier: Apache-2.0
// Light that a picture may lack because none of its samples has met it: how much at most, and that the
// verdict says so.
#include "render/unmet_light.h"

#include "film/error_pixels.h"
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
        EXPECT_GT(few.unmet->relative_bound, 2 * *more.unmet->relative_bound);
        const ErrorReport large = Basin(integrator, 60).report(1024);
        EXPECT_FALSE(large.unmet) << "a sun of a tenth of the sky is met often enough: "
                                  << large.unmet->light_bound;
    }
}

TEST(UnmetLight, HoldsWhatAPictureLacks) {
    Basin guided(Integrator::BDPT);
    guided.options.transport.guide = Toggle::ON;
    guided.options.sampling.spp = 1024;
    const double whole = mean_of(guided.render());
    for (const auto& [integrator, spp] :
         {std::pair{Integrator::PATH_LIGHT, 16u}, std::pair{Integrator::MLT, 256u}}) {
        Basin unguided(integrator);
        unguided.options.sampling.spp = spp;
        const Scene scene = unguided.load();
        const Render part = unguided.render();
        const double lacked = whole / mean_of(part) - 1;
        EXPECT_GT(lacked, 0.1) << name_of(integrator) << ": a picture that lacks nothing tests nothing";
        const std::optional<UnmetLight> unmet =
            unmet_light(part, hit_light(scene, plan_paths(scene, unguided.options), integrator, part));
        ASSERT_TRUE(unmet) << name_of(integrator);
        EXPECT_GT(unmet->relative_bound, lacked) << name_of(integrator);
    }
}

TEST(UnmetLight, IsThatOfTheScene) {
    Basin basin(Integrator::PATH_LIGHT);
    basin.options.sampling.spp = 16;
    basin.look({0, 2.5, 1}, {0, 0, 0}, 60); // around the floor, too
    Render render = basin.render();
    const std::optional<HitLight> hits = HitLight{"LSDSE", 1e4};
    const double dark = *unmet_light(render, hits)->relative_bound;
    ASSERT_TRUE(has_backdrop(render.film));
    for (size_t i = 0; i < render.film.sums.size(); ++i)
        if (const size_t pixel = i % film_plane(render.film) / 3; !render.film.shown[pixel])
            render.film.sums[i] += std::int64_t(1) << 30;
    EXPECT_EQ(*unmet_light(render, hits)->relative_bound, dark) << "whatever is behind it";
    for (std::int64_t& sum : render.film.sums)
        sum = 0;
    ASSERT_TRUE(unmet_light(render, hits));
    EXPECT_FALSE(unmet_light(render, hits)->relative_bound) << "of a black picture";
    EXPECT_GT(unmet_light(render, hits)->light_bound, 0);
}

TEST(UnmetLight, IsLessWhereAGuideLeadsToIt) {
    const Basin basin(Integrator::BDPT);
    const Scene scene = basin.load();
    const PathPlan plan = plan_paths(scene, basin.options);
    RenderProgress render;
    render.film.ranges = {{0, 100}};
    GuideProgress& guide = render.guide;
    const auto largest_sample = [&](Integrator integrator) {
        return hit_light(scene, plan, integrator, render)->radiance;
    };
    const double unguided = largest_sample(Integrator::BDPT);
    guide.stage = GuideStage::ON;
    guide.guided_from = 0;
    EXPECT_EQ(largest_sample(Integrator::BDPT), unguided) << "nobody knows yet what the guide is worth";
    guide.error = 0.05;
    EXPECT_NEAR(largest_sample(Integrator::BDPT) / unguided, 0.05, 1e-9);
    EXPECT_EQ(largest_sample(Integrator::PATH), unguided) << "that of path learns from hits alone";
    guide.guided_from = 50;
    EXPECT_NEAR(largest_sample(Integrator::BDPT) / unguided, 100 / (50 + 50 / 0.05), 1e-9);
    guide.error = 1.2;
    EXPECT_EQ(largest_sample(Integrator::BDPT), unguided);
}

} // namespace clrt
