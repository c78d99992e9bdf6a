// SPDX-License-Identifier: Apache-2.0
// What pilots tell of lamps behind panes (kernels/path/slab_bend.h), to which path alone is connected.
#include "support/choice_box.h"

#include <gtest/gtest.h>

namespace clrt {

// Of what only hits find without it (kernels/path/slab_bend.h) the candidates' samples tell nothing.
TEST(SlabPilot, LampsBehindPanesAreLeftToPath) {
    Box box;
    box.add_lamp(0.2);
    box.build.use("glass").box({-1, 2.6, -1}, {1, 2.65, 1});
    for (const Toggle choose : {Toggle::AUTO, Toggle::ON}) {
        box.options.transport.choose = choose;
        const IntegratorChoice choice = box.choose().choice;
        EXPECT_EQ(choice.integrator, Integrator::PATH) << choice.reason;
    }
    box.build.icosphere({0, 0.8, 0}, 0.5, 3, Facing::OUTWARD, Shading::SMOOTH);
    EXPECT_NE(box.integrator(), Integrator::PATH) << "a ball of the same glass makes caustics";
}

// Nor does a mirror that hardly matters make path look as noisy as if it were not connected through slabs:
// light paths that came straight through them tell of path with its connections, and so do paths from the eye
// that hit lamps behind them, of which the larger one is often hit. That what a path gathers at several
// vertices is correlated they do not tell.
TEST(SlabPilot, BesideOtherCastersPilotsTellOfPathWithItsConnectionsThroughPanes) {
    for (const double side : {0.2, 0.9}) {
        Box box;
        box.add_lamp(side);
        box.build.use("glass").box({-1, 2.6, -1}, {1, 2.65, 1});
        box.build.material("mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3").use("mirror");
        box.build.icosphere({1.2, 0.1, 0.5}, 0.1, 3, Facing::OUTWARD, Shading::SMOOTH);
        box.options.sampling.spp = 4096;
        const Chosen chosen = box.choose();
        EXPECT_EQ(chosen.choice.integrator, Integrator::PATH) << chosen.choice.reason;
        const double path = squared_error(box, Integrator::PATH);
        for (const Integrator integrator : {Integrator::PATH_LIGHT, Integrator::BDPT}) {
            take_integrator(integrator, *chosen.planned);
            const PreparedScene prepared = prepare_scene(test_device(), chosen.planned, {});
            const PilotResult pilot = run_pilot(prepared, chosen.choice.pilot);
            EXPECT_GT(chosen.choice.prices[0].work, 1.2 * pilot.eye_rays) << "path alone spends on slabs";
            const double told = pilot.path[size_t(ErrorMeasure::RELATIVE)];
            EXPECT_GT(told, 0.33 * path) << name_of(integrator) << ", lamp " << side;
            EXPECT_LT(told, 1.5 * path) << name_of(integrator) << ", lamp " << side;
        }
    }
}

// What is seen behind a pane itself, in the light of a small lamp that shines through it, the candidates find
// by hits alone, which their pilots hardly make; connections through the pane tell how noisy those are.
TEST(SlabPilot, ConnectionsThroughPanesTellWhatCandidatesHitTooSeldom) {
    Box box;
    box.add_lamp(0.1);
    box.build.use("glass").box({-1.8, 0.3, -1.9}, {1.8, 2.6, -1.85});
    box.build.material("mirror", "Kd 0 0 0\nKs 0.9 0.9 0.9\nillum 3").use("mirror");
    box.build.icosphere({1.2, 0.2, 0.5}, 0.2, 3, Facing::OUTWARD, Shading::SMOOTH);
    const Chosen chosen = box.choose();
    EXPECT_EQ(chosen.choice.integrator, Integrator::PATH) << chosen.choice.reason;
    for (const Integrator integrator : {Integrator::PATH_LIGHT, Integrator::BDPT}) {
        const double told = price_of(chosen.choice, integrator).errors[size_t(ErrorMeasure::RELATIVE)];
        const double share = told / squared_error(box, integrator);
        EXPECT_GT(share, 0.33) << name_of(integrator); // 1.2; without them a 400th
        EXPECT_LT(share, 1.5) << name_of(integrator);
    }
}

} // namespace clrt
