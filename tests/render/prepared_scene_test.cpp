// SPDX-License-Identifier: Apache-2.0
// Prepared scenes know of no other: any number of them, on several devices and in several threads, render
// what each renders alone. Parts are taken over where they fit.
#include "render/prepared_scene.h"

#include "console/progress.h"
#include "probes/effect_masks.h"
#include "render/ledger.h"
#include "support/render_scene.h"

#include <functional>
#include <gtest/gtest.h>
#include <thread>

namespace clrt {

namespace {

using Plan = std::shared_ptr<PlannedScene>;

/// A room that every kind of path runs through, under these options.
Plan plan_every_effect(const std::function<void(Options&)>& change) {
    SceneOfEffects small(EVERY_EFFECT);
    small.options.sampling.spp = 4;
    small.options.sampling.replicates = 4;
    change(small.options);
    if (small.options.transport.integrator != Integrator::PATH)
        small.options.transport.paths.clear();
    return plan_loaded(test_device(), small.load(), small.options);
}

/// A matte floor under a lamp, by the program of what it needs, from another camera and on another film.
Plan plan_matte() {
    TestScene scene;
    scene.build.material("white", "Kd 0.7 0.6 0.5").use("white").floor(3);
    scene.build.material("lamp", "Kd 0 0 0\nKe 5 5 5").use("lamp");
    scene.build.polygon({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    scene.look({0, 1, 4}, {0, 0, 0}, 40);
    scene.options.effects.all = false;
    scene.options.film.size = {33, 21};
    scene.options.sampling.spp = 9;
    scene.options.sampling.replicates = 3;
    scene.options.sampling.seed = 5;
    return plan_loaded(test_device(), scene.load(), scene.options);
}

/// Plans that differ in scene, integrator, effects, layout, precision, paths and film.
std::vector<Plan> different_plans(const DeviceInfo& device) {
    std::vector<Plan> plans{plan_every_effect([](Options&) {}), plan_matte(),
                            plan_every_effect([](Options& options) {
                                options.transport.integrator = Integrator::WHITTED;
                                options.bvh.layout = BvhLayout::CWBVH;
                                options.effects.off = EFFECT_SMOOTH_NORMALS;
                            })};
    if (device.fp64)
        plans.push_back(plan_every_effect([](Options& options) {
            options.transport.integrator = Integrator::RAYCAST;
            options.device.precision = Precision::DOUBLE;
            options.sampling.sampler = SamplerChoice::INDEPENDENT;
        }));
    return plans;
}

std::vector<std::int64_t> sums(const PreparedScene& prepared) {
    return render_silently(prepared).film.sums;
}

/// Long thin triangles, which are worth cutting.
Plan plan_needles() {
    TestScene scene;
    scene.build.material("white", "Kd 0.7 0.6 0.5").use("white");
    for (int i = 0; i < 4000; ++i) {
        const double x = (i % 63) / 63.0, y = (i / 63) / 63.0;
        scene.build.polygon({{x, y, 0}, {y, 1 - x, 1}, {x + 1e-3, y, 0}});
    }
    scene.look({0.5, 0.5, 4}, {0.5, 0.5, 0}, 30);
    scene.options.effects.all = false;
    scene.options.transport.integrator = Integrator::RAYCAST;
    scene.options.sampling.spp.reset();
    scene.options.sampling.time_seconds = 0.5;
    return plan_loaded(test_device(), scene.load(), scene.options);
}

} // namespace

TEST(PreparedScene, ManyAtOnceInTwoThreadsRenderWhatEachRendersAlone) {
    const Device second_device = open_device(test_device().info);
    const Device* const devices[] = {&test_device(), &second_device};
    const std::vector<Plan> plans = different_plans(test_device().info);
    std::vector<std::vector<std::int64_t>> alone;
    for (const Plan& plan : plans) {
        alone.push_back(sums(prepare_render(test_device(), plan)));
        EXPECT_NE(alone.back(), std::vector<std::int64_t>(alone.back().size(), 0));
    }

    // Each thread prepares all of them, those of the other thread in turn with its own, on a device of its
    // own, and keeps them alive; plans are shared. Then it renders them in turns, twice.
    constexpr int ROUNDS = 2;
    std::vector<std::vector<std::int64_t>> together[2];
    const auto work = [&](size_t thread) {
        std::vector<PreparedScene> prepared;
        for (size_t i = 0; i < plans.size(); ++i)
            prepared.push_back(prepare_render(*devices[thread], plans[(i + thread) % plans.size()]));
        for (int round = 0; round < ROUNDS; ++round)
            for (const PreparedScene& scene : prepared)
                together[thread].push_back(sums(scene));
    };
    std::thread first(work, 0), second(work, 1);
    first.join();
    second.join();
    for (size_t thread = 0; thread < 2; ++thread) {
        ASSERT_EQ(together[thread].size(), ROUNDS * plans.size());
        for (size_t i = 0; i < together[thread].size(); ++i)
            EXPECT_TRUE(together[thread][i] == alone[(i + thread) % plans.size()])
                << "thread " << thread << ", render " << i;
    }
}

TEST(PreparedScene, TwoThreadsRenderOneAtOnce) {
    const PreparedScene prepared = prepare_render(test_device(), plan_matte());
    const std::vector<std::int64_t> alone = sums(prepared);
    std::vector<std::int64_t> together[2];
    std::thread first([&] { together[0] = sums(prepared); }), second([&] { together[1] = sums(prepared); });
    first.join();
    second.join();
    EXPECT_TRUE(together[0] == alone && together[1] == alone);
}

TEST(PreparedScene, AnotherCameraAndSeedNeedNothingMadeAnew) {
    const Plan plan = plan_matte();
    const PreparedScene prepared = prepare_render(test_device(), plan);
    const std::vector<std::int64_t> before = sums(prepared);
    plan->scene.camera.eye += glm::dvec3(0.5, 0.25, 0);
    const std::vector<std::int64_t> from_elsewhere = sums(prepared);
    EXPECT_FALSE(from_elsewhere == before);
    plan->options.sampling.seed += 1;
    const std::vector<std::int64_t> by_other_numbers = sums(prepared);
    EXPECT_FALSE(by_other_numbers == from_elsewhere);
    EXPECT_TRUE(by_other_numbers == sums(prepare_render(test_device(), plan)));
}

TEST(PreparedScene, PartsAreTakenOverWhereTheyFit) {
    const Plan plan = plan_matte();
    const PreparedScene first = prepare_render(test_device(), plan);
    const PreparedScene same = prepare_render(test_device(), plan, {first.tree, first.programs});
    EXPECT_EQ(same.tree, first.tree);
    EXPECT_EQ(same.programs, first.programs);
    EXPECT_EQ(prepare_scene(test_device(), plan).programs, nullptr) << "nothing is compiled";

    const Plan other = plan_matte();
    other->options.bvh.layout = first.tree->bvh.layout == BvhLayout::BVH2 ? BvhLayout::BVH8 : BvhLayout::BVH2;
    const PreparedScene in_other_layout = prepare_render(test_device(), other, {first.tree, nullptr});
    EXPECT_NE(in_other_layout.tree->bvh.layout, first.tree->bvh.layout);
    EXPECT_TRUE(sums(in_other_layout) == sums(first));
}

TEST(PreparedScene, TheLedgerMeasuresWithTheTreeOfThePicture) {
    const Plan plan = plan_needles();
    const PreparedScene picture = prepare_scene(test_device(), plan);
    ASSERT_EQ(picture.tree->bvh.quality, BvhQuality::HIGH) << picture.tree->reason;
    Progress silent(Toggle::OFF, true);
    const Ledger ledger = make_ledger(test_device(), plan->scene, plan->options, silent);
    EXPECT_EQ(ledger.bvh_quality, BvhQuality::HIGH);
    EXPECT_EQ(ledger.bvh_reason, picture.tree->reason);
    EXPECT_GE(ledger.full_pairs, FEWEST_PAIRS);
    EXPECT_GT(ledger.specialised.seconds.low, 0);
    EXPECT_EQ(ledger.clock, LedgerClock::PROCESSOR);
}

} // namespace clrt
