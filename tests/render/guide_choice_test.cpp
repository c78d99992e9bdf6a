// SPDX-License-Identifier: Apache-2.0
// Whether pictures are guided from their first samples on: by a pilot that teaches and judges where the
// render is long, by one that only teaches where light is very hard to find, by the picture's own samples, or
// not.
#include "probes/film_estimate.h"
#include "render/guide_choice.h"
#include "render/guiding.h"
#include "support/adjoining_rooms.h"
#include "support/saved_render.h"
#include "support/sunlit_basin.h"

#include <cmath>
#include <gtest/gtest.h>

namespace clrt {

namespace {

/// What choose_guide makes of a scene.
struct Choice {
    std::shared_ptr<PlannedScene> planned;
    PreparedParts parts;

    explicit Choice(const TestScene& scene, std::optional<PathPilot> path = std::nullopt)
        : planned(plan_loaded(test_device(), scene.load(), scene.options)) {
        Progress silent(Toggle::OFF, true);
        choose_guide(test_device(), planned, parts, path, silent);
    }
    Render render(u32 spp, const RenderHooks& hooks = {}) const {
        planned->options.sampling.spp = spp;
        Progress silent(Toggle::OFF, true);
        return clrt::render(prepare_render(test_device(), planned, parts), silent, hooks);
    }
};

/// Samples of all pixels of a picture of 32 x 24 in which a pilot teaches and judges, and in which one only
/// teaches.
constexpr u32 LONG_SPP = 24000, SHORT_SPP = 3000;

/// What a pilot tells where light is very hard to find.
constexpr PathPilot HARD{{80, 80}, 20, 80};

Estimate mean_of(const Film& film) {
    return film_estimate(film, 1, {0, 0, film.width, film.height});
}

} // namespace

TEST(GuideChoice, APilotTeachesAndJudgesForLongRenders) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.options.sampling.spp = LONG_SPP;
    const Choice choice(scene);
    ASSERT_TRUE(choice.parts.guide);
    const GuideProgress& guide = *choice.parts.guide;
    EXPECT_EQ(guide.stage, GuideStage::ON);
    EXPECT_EQ(guide.guided_from, 0u);
    EXPECT_EQ(guide.judgements, 1u);
    EXPECT_GT(*guide.pilot_error, WORTHWHILE_GUIDE_ERROR);
    EXPECT_LT(*guide.error * *guide.work, 1);
    EXPECT_LT(*guide.work, 2);
    ASSERT_TRUE(guide.guide);
    EXPECT_GT(guide.guide->lore().size(), 100u);
}

// The first four samples are guided, with less noise than four unguided ones and the same light; and they
// are worth as much as the pilot said.
TEST(GuideChoice, ThePictureIsGuidedFromItsFirstSampleOn) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.options.sampling.spp = LONG_SPP;
    scene.options.sampling.replicates = 64;
    const Choice choice(scene);
    const Film guided = choice.render(64).film;
    scene.options.transport.guide = Toggle::OFF;
    const Film plain = Choice(scene).render(64).film;
    const Estimate with = mean_of(guided), without = mean_of(plain);
    EXPECT_LT(std::abs(with.mean - without.mean), 4 * std::hypot(with.error, without.error));
    const double gain =
        sample_error(guided, ErrorMeasure::RELATIVE) / sample_error(plain, ErrorMeasure::RELATIVE);
    EXPECT_LT(gain, 0.5);
}

TEST(GuideChoice, APilotOnlyTeachesWhereLightIsVeryHardToFind) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.options.sampling.spp = SHORT_SPP;
    const Choice hard(scene, HARD);
    ASSERT_TRUE(hard.parts.guide && hard.parts.guide->guide);
    EXPECT_EQ(hard.parts.guide->guided_from, 0u);
    EXPECT_EQ(hard.parts.guide->judgements, 0u);
    const Choice noisy(scene, PathPilot{{20, 20}, 20, 20}); // the picture's own samples teach
    ASSERT_TRUE(noisy.parts.guide);
    EXPECT_EQ(noisy.parts.guide->stage, GuideStage::ON);
    EXPECT_FALSE(noisy.parts.guide->guided_from);
    EXPECT_FALSE(noisy.parts.guide->guide);
}

// A picture that begins with a taught guide keeps its bits in pieces: where its first epoch ends, and where
// the first that is judged does.
TEST(GuideChoice, KeepsItsBitsInPieces) {
    TestScene scene;
    add_adjoining_rooms(scene);
    scene.options.sampling.spp = SHORT_SPP;
    scene.options.sampling.replicates = 4;
    const Choice choice(scene, HARD);
    choice.planned->options.transport.guide_after_rays = 1;
    const Render whole = choice.render(24);
    EXPECT_EQ(whole.guide.judgements, 2u);
    for (const u32 spp : {4u, 6u, 8u, 13u}) {
        const RenderProgress progress = through_a_file(choice.render(spp), scene);
        RenderHooks hooks;
        hooks.resume = &progress;
        EXPECT_EQ(choice.render(24, hooks).film.sums, whole.film.sums) << spp;
    }
}

// Lamps that are smaller than pixels: noise of the film, which no guide lowers.
TEST(GuideChoice, APilotTurnsAUselessGuideOff) {
    TestScene scene;
    scene.build.material("white", "Kd 0.7 0.7 0.7").material("lamp", "Kd 0 0 0\nKe 4000 4000 4000");
    scene.build.use("white").floor(2);
    scene.build.use("lamp");
    for (int i = 0; i < 12; ++i) {
        const double x = 0.25 * (i % 4) - 0.4, z = 0.3 * (i / 4) - 0.3;
        scene.build.polygon({{x, 0.01, z}, {x, 0.01, z + 0.01}, {x + 0.01, 0.01, z + 0.01}});
    }
    scene.look({0, 2, 0.5}, {0, 0, 0}, 40);
    scene.options.film.size = {32, 24};
    scene.options.effects.all = false;
    scene.options.sampling.spp = LONG_SPP;
    scene.options.transport.guide_after_rays = 3e5; // paths are short
    const Choice choice(scene, HARD);
    ASSERT_TRUE(choice.parts.guide);
    EXPECT_EQ(choice.parts.guide->stage, GuideStage::OFF);
    EXPECT_GT(*choice.parts.guide->error * *choice.parts.guide->work, 1.1);
    const Render render = choice.render(16);
    scene.options.transport.guide = Toggle::OFF;
    EXPECT_EQ(render.film.sums, Choice(scene).render(16).film.sums);
}

// Pilots of bdpt hardly ever hit a sun by way of water, so its brightness tells, where there is water.
TEST(GuideChoice, BdptIsGuidedWhereHitsAreRareAndBright) {
    TestScene scene;
    add_sunlit_basin(scene, 0.5);
    scene.options.sampling.spp = LONG_SPP;
    const PathPilot clean{{1, 1}, 20, 1, 0.7};
    const Choice choice(scene, clean);
    ASSERT_TRUE(choice.parts.guide && choice.parts.guide->guide);
    EXPECT_EQ(choice.parts.guide->stage, GuideStage::ON);
    EXPECT_LT(*choice.parts.guide->error, 0.5);
    EXPECT_FALSE(Choice(scene, PathPilot{{1, 1}, 20, 1, 700}).parts.guide) << "the sun is no brighter";
    scene.options.light.suns[0].diameter_degrees = 60;
    EXPECT_FALSE(Choice(scene, clean).parts.guide) << "the sun is large";
}

TEST(GuideChoice, ElsewhereThePictureFindsOut) {
    TestScene scene;
    add_adjoining_rooms(scene);
    EXPECT_FALSE(Choice(scene).parts.guide) << "a short render";
    scene.options.sampling.spp = LONG_SPP;
    EXPECT_FALSE(Choice(scene, PathPilot{{1, 1}, 20, 1}).parts.guide) << "light is found";
    EXPECT_FALSE(Choice(scene, PathPilot{{80, 80}, 20, 0.2}).parts.guide) << "but for few pixels";
    EXPECT_FALSE(Choice(scene, PathPilot{{HUGE_VAL, HUGE_VAL}, 20}).parts.guide) << "there is none";
    for (const Toggle guide : {Toggle::ON, Toggle::OFF}) {
        scene.options.transport.guide = guide;
        EXPECT_FALSE(Choice(scene, HARD).parts.guide);
    }
    scene.options.transport.guide = Toggle::AUTO;
    scene.options.film_file.resume_path = "some.film";
    EXPECT_FALSE(Choice(scene, HARD).parts.guide) << "a film says how it goes on";
}

} // namespace clrt
