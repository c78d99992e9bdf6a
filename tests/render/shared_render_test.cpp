// SPDX-License-Identifier: Apache-2.0
// Several devices render the film of one, to the last bit: whatever each of them takes, resumed or new, for
// integrators that gather and that splat.
#include "render/shared_render.h"

#include "console/progress.h"
#include "support/render_scene.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A floor under a lamp and beside a mirror, in 8 replicates.
class LitFloor : public TestScene {
public:
    explicit LitFloor(Integrator integrator);
};

LitFloor::LitFloor(Integrator integrator) {
    TestScene& scene = *this;
    scene.build.material("white", "Kd 0.7 0.6 0.5").use("white").floor(3);
    scene.build.material("lamp", "Kd 0 0 0\nKe 5 5 5").use("lamp");
    scene.build.polygon({{-1, 2, -1}, {1, 2, -1}, {1, 2, 1}, {-1, 2, 1}});
    scene.look({0, 1, 4}, {0, 0, 0}, 40);
    scene.options.transport.integrator = integrator;
    scene.options.transport.guide = Toggle::OFF;
    scene.options.output.files = {"a.exr"};
    scene.options.sampling.replicates = 8;
    scene.options.sampling.spp = 41;
}

/// A scene that one device and two are prepared for.
struct Both {
    explicit Both(const TestScene& scene)
        : other(open_device(test_device().info)),
          planned(plan_loaded(test_device(), scene.load(), scene.options)),
          first(prepare_render(test_device(), planned)),
          second(prepare_render(other, planned, {first.tree, nullptr})) {}

    Render shared(const RenderHooks& hooks = {}) const {
        Progress progress(Toggle::OFF, true);
        return render_shared({&first, &second}, progress, hooks);
    }

    Device other;
    std::shared_ptr<PlannedScene> planned;
    PreparedScene first, second;
};

void expect_same(const Render& one, const Render& two) {
    EXPECT_TRUE(one.film.sums == two.film.sums);
    EXPECT_EQ(one.film.ranges, two.film.ranges);
    EXPECT_EQ(one.film.shown, two.film.shown);
    EXPECT_EQ(one.counts.rays(), two.counts.rays());
    EXPECT_TRUE(one.hits.values == two.hits.values);
    ASSERT_TRUE(one.error && two.error);
    EXPECT_EQ(one.error->relative_rmse, two.error->relative_rmse);
}

} // namespace

TEST(SharedRender, TwoDevicesMakeTheFilmOfOne) {
    for (const Integrator integrator : {Integrator::PATH, Integrator::PATH_LIGHT}) {
        SCOPED_TRACE(name_of(integrator));
        const Both both{LitFloor(integrator)};
        const Render one = render_silently(both.first), two = both.shared();
        expect_same(one, two);
        EXPECT_FALSE(two.hits.empty());
        EXPECT_EQ(two.passes, 41u);
        ASSERT_EQ(two.shares.size(), 2u);
        EXPECT_EQ(two.shares[0].work.samples + two.shares[1].work.samples, 41u);
        EXPECT_GT(two.shares[0].work.samples, 0u);
        EXPECT_GT(two.shares[1].work.samples, 0u);
        EXPECT_GT(two.shares[0].work.seconds, 0);
        EXPECT_TRUE(one.shares.empty());
    }
}

TEST(SharedRender, AResumedFilmIsThatOfOneRun) {
    const Both both{LitFloor(Integrator::PATH)};
    const Render whole = render_silently(both.first);
    both.planned->options.sampling.spp = 16;
    const Render begun = both.shared();
    both.planned->options.sampling.spp = 41;
    RenderHooks hooks;
    hooks.resume = &begun;
    const Render resumed = both.shared(hooks);
    expect_same(whole, resumed);
    EXPECT_EQ(resumed.passes, 25u);
    EXPECT_EQ(resumed.history.size(), whole.history.size());
}

TEST(SharedRender, AnErrorThatIsAskedForEndsItWhereOneDeviceEnds) {
    LitFloor scene(Integrator::PATH);
    scene.options.sampling.spp.reset();
    scene.options.sampling.error = 0.03;
    const Both both(scene);
    const Render one = render_silently(both.first), two = both.shared();
    expect_same(one, two);
    EXPECT_EQ(two.stop, StopRule::ERROR);
}

TEST(SharedRender, TimeEndsIt) {
    LitFloor scene(Integrator::PATH);
    scene.options.sampling.spp.reset();
    scene.options.sampling.time_seconds = 0.4;
    const Both both(scene);
    const Render two = both.shared();
    EXPECT_EQ(two.stop, StopRule::TIME);
    EXPECT_GT(two.passes, 0u);
    EXPECT_EQ(two.film.ranges.front().first, 0u);
    // A device that is late drops the range it works on, behind which the other may have finished one.
    EXPECT_LE(two.film.ranges.size(), 2u);
    EXPECT_EQ(film_samples(two.film), two.passes);
    EXPECT_EQ(two.shares[0].work.samples + two.shares[1].work.samples, two.passes);
}

} // namespace clrt
