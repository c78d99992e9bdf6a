// SPDX-License-Identifier: Apache-2.0
// The choice of an integrator: what decides, that a pilot's figures are those of the integrators, and that
// the picture is that of the one that is chosen.
#include "render/reuse_choice.h"
#include "support/adjoining_rooms.h"
#include "support/choice_box.h"
#include "support/sunlit_basin.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A lamp of this half side below a ceiling that it shines at, and a screen that is wider still below it.
void add_screened_lamp(Box& box, double side) {
    box.add_lamp(side);
    const double w = side + 0.3;
    box.build.use("matte").polygon({{-w, 2.7, -w}, {-w, 2.7, w}, {w, 2.7, w}, {w, 2.7, -w}});
    box.build.polygon({{-2, 3.3, -2}, {2, 3.3, -2}, {2, 3.3, 2}, {-2, 3.3, 2}});
}

} // namespace

TEST(IntegratorChoice, CausticsAreLeftToLightPaths) {
    Box box;
    box.add_caustic();
    const Chosen chosen = box.choose();
    EXPECT_EQ(chosen.choice.integrator, Integrator::PATH_LIGHT) << chosen.choice.reason;
    EXPECT_TRUE(chosen.parts.tree) << "the pilot's is the picture's";
    EXPECT_EQ(chosen.choice.prices.size(), 3u);
    const IntegratorPrice price = price_of(chosen.choice, Integrator::PATH_LIGHT);
    EXPECT_GT(price.efficiency, 3) << chosen.choice.reason;
    // Of the noise that path+light leaves, not of path's, a guide may make less.
    ASSERT_TRUE(chosen.choice.unguided);
    EXPECT_EQ(chosen.choice.unguided->errors, price.errors);
}

TEST(IntegratorChoice, APilotToldWhatSplatsWouldNotGain) {
    Box box;
    box.add_lamp(2.6); // which paths from the eye find through glass as well
    box.add_glass();
    const Chosen chosen = box.choose();
    EXPECT_EQ(chosen.choice.integrator, Integrator::PATH) << chosen.choice.reason;
    const IntegratorPrice price = price_of(chosen.choice, Integrator::PATH_LIGHT);
    EXPECT_LT(price.efficiency, 1) << chosen.choice.reason;
    ASSERT_TRUE(chosen.choice.unguided);
    EXPECT_EQ(chosen.choice.unguided->errors, price.path);
}

TEST(IntegratorChoice, SamplesAreEvenWhereLightPathsGainMoreThanAdaptiveOnes) {
    for (const ErrorMeasure measure : {ErrorMeasure::MSE, ErrorMeasure::RELATIVE}) {
        Box caustic;
        caustic.add_caustic();
        caustic.options.transport.choose = Toggle::AUTO;
        caustic.options.sampling.adaptive = measure;
        const Chosen chosen = caustic.choose();
        EXPECT_EQ(chosen.choice.integrator, Integrator::PATH_LIGHT) << chosen.choice.reason;
        EXPECT_FALSE(is_adaptive(chosen.planned->options));
        EXPECT_NE(chosen.choice.reason.find("in spite of --adaptive"), std::string::npos)
            << chosen.choice.reason;
        // They are judged by the measure that --adaptive names all the same.
        const Render even = render_loaded(chosen.planned->scene, chosen.planned->options);
        EXPECT_FALSE(is_adaptive(even.film));
        EXPECT_EQ(even.round.measure, measure);
    }
    Box mild;
    mild.add_lamp(2.6);
    mild.add_glass();
    mild.options.sampling.adaptive = ErrorMeasure::RELATIVE;
    const Chosen chosen = mild.choose();
    EXPECT_EQ(chosen.choice.integrator, Integrator::PATH) << chosen.choice.reason;
    EXPECT_TRUE(is_adaptive(chosen.planned->options));
}

TEST(IntegratorChoice, APilotsErrorsAreThoseOfTheIntegrators) {
    // Of the smallest lamp paths from the eye find next to nothing in so few samples, and what path+light is
    // left with are paths as rare.
    for (const double side : {0.05, 0.4, 1.2}) {
        Box box;
        box.add_lamp(side);
        box.add_glass();
        box.options.sampling.spp = 16384; // a pilot of all pixels
        // Without the noise of its outline the larger lamp leaves paths as rare, too.
        box.options.transport.emission_rays = 1;
        const IntegratorChoice choice = box.choose().choice;
        const double path = squared_error(box, Integrator::PATH);
        for (const Integrator integrator : {Integrator::PATH_LIGHT, Integrator::BDPT}) {
            const IntegratorPrice price = price_of(choice, integrator);
            const size_t measure = size_t(ErrorMeasure::RELATIVE);
            const double of_path = price.path[measure] / path;
            EXPECT_GT(of_path, 0.5) << name_of(integrator) << ", lamp " << side;
            EXPECT_LT(of_path, 2.2) << name_of(integrator) << ", lamp " << side;
            if (side < 0.1)
                continue;
            const double of_own = price.errors[measure] / squared_error(box, integrator);
            EXPECT_GT(of_own, 0.5) << name_of(integrator) << ", lamp " << side;
            EXPECT_LT(of_own, 2.2) << name_of(integrator) << ", lamp " << side;
        }
    }
}

TEST(IntegratorChoice, LightBehindAScreenIsLeftToPathsFromBothEnds) {
    Box box;
    box.options.sampling.spp = 1024;
    box.add_lamp(0.05);
    // Below the lamp: all that is seen has been reflected by the ceiling or the wall.
    box.build.use("matte").polygon({{-0.4, 2.7, -0.4}, {-0.4, 2.7, 0.4}, {0.4, 2.7, 0.4}, {0.4, 2.7, -0.4}});
    box.build.polygon({{-2, 3.3, -2}, {2, 3.3, -2}, {2, 3.3, 2}, {-2, 3.3, 2}});
    const Chosen chosen = box.choose();
    EXPECT_EQ(chosen.choice.integrator, Integrator::BDPT) << chosen.choice.reason;
    EXPECT_EQ(chosen.planned->options.transport.max_depth, USUAL_PATH_DEPTH) << "bdpt's own is shorter";
    const double told = price_of(chosen.choice, Integrator::BDPT).path[size_t(ErrorMeasure::RELATIVE)] /
                        price_of(chosen.choice, Integrator::BDPT).errors[size_t(ErrorMeasure::RELATIVE)];
    const double measured = squared_error(box, Integrator::PATH) / squared_error(box, Integrator::BDPT);
    EXPECT_GT(told, 0.6 * measured);
    EXPECT_LT(told, 1.7 * measured);
    box.options.transport.max_depth = 8;
    EXPECT_EQ(box.choose().planned->options.transport.max_depth, 8);
}

TEST(IntegratorChoice, WhereNoneIsNamedOthersAreTriedWherePathMayNotSuffice) {
    struct Case {
        const char* light;
        Integrator expected;
        size_t prices; // path's among them
    };
    for (const Case& c : {Case{"lamp", Integrator::PATH, 0}, Case{"caustic", Integrator::PATH_LIGHT, 2},
                          Case{"screened", Integrator::BDPT, 3}}) {
        Box box;
        box.options.transport.choose = Toggle::AUTO;
        if (c.light == std::string("screened"))
            add_screened_lamp(box, 0.2);
        else
            box.add_lamp(c.prices == 0 ? 1.2 : 0.05);
        if (c.prices > 0)
            box.add_glass(); // whose caustics so short a pilot of path would hardly find
        const Chosen chosen = box.choose();
        EXPECT_EQ(chosen.choice.integrator, c.expected) << c.light;
        EXPECT_EQ(chosen.choice.is_told, c.prices > 0) << chosen.choice.reason;
        EXPECT_EQ(chosen.choice.prices.size(), c.prices) << chosen.choice.reason;
        EXPECT_TRUE(chosen.parts.tree) << "path's pilot has one";
        const std::uint32_t spp = *box.options.sampling.spp;
        box.options.run.given["--first-sample"] = ""; // a part, which is to be as the others
        EXPECT_FALSE(box.choose().choice.is_told || box.choose().parts.tree);
        box.options.run.given.clear();
        box.options.sampling.spp = spp / 8; // too short for pilots
        EXPECT_FALSE(box.choose().choice.is_told || box.choose().parts.tree);
    }
}

// Its program takes seconds to compile.
TEST(IntegratorChoice, WherePathFindsTheLightBdptIsNotTriedUnasked) {
    Box box;
    box.add_lamp(2.6);
    box.add_glass();
    for (const Toggle choose : {Toggle::AUTO, Toggle::ON}) {
        box.options.transport.choose = choose;
        const IntegratorChoice choice = box.choose().choice;
        EXPECT_EQ(choice.integrator, Integrator::PATH);
        EXPECT_EQ(choice.prices.size(), choose == Toggle::AUTO ? 2u : 3u) << choice.reason;
    }
}

TEST(IntegratorChoice, InnerConnectionsTellWhatPathsFromTheEyeSeldomMeet) {
    // A lamp in a tube: nearly all that is seen comes off a small spot of the ceiling, and what paths from
    // the eye would scatter by is told by connections to it.
    Box box;
    box.options.sampling.spp = 2048;
    box.add_lamp(0.2);
    box.build.use("matte").box({-0.25, 2.6, -0.25}, {0.25, 2.65, 0.25});
    for (const double side : {-1.0, 1.0}) {
        box.build.box({side * 0.25 - 0.02, 2.6, -0.25}, {side * 0.25 + 0.02, 3.2, 0.25});
        box.build.box({-0.25, 2.6, side * 0.25 - 0.02}, {0.25, 3.2, side * 0.25 + 0.02});
    }
    box.build.polygon({{-2, 3.4, -2}, {2, 3.4, -2}, {2, 3.4, 2}, {-2, 3.4, 2}});
    const Chosen chosen = box.choose();
    EXPECT_EQ(chosen.choice.integrator, Integrator::BDPT) << chosen.choice.reason;
    const size_t measure = size_t(ErrorMeasure::RELATIVE);
    const double told = price_of(chosen.choice, Integrator::BDPT).path[measure];
    const double share = told / squared_error(box, Integrator::PATH);
    EXPECT_GT(share, 0.8); // .98; less than this without the excess of what inner connections find,
    EXPECT_LT(share, 1.1); // and 1.15 or 1.7 if the roulette that ends light paths early were path's
}

// Light that comes round a wide screen: the wider, the less paths from both ends gain, and a guide is to be
// had as well if there is time for it.
TEST(IntegratorChoice, WherePathMayBeGuidedBdptMustGainMore) {
    struct Case {
        double side;
        Toggle guide;
        std::uint64_t spp;
        Integrator expected;
    };
    for (const Case& c :
         {Case{0.8, Toggle::AUTO, 8192, Integrator::BDPT}, Case{1.35, Toggle::OFF, 8192, Integrator::BDPT},
          Case{1.35, Toggle::AUTO, 8192, Integrator::PATH},
          Case{1.35, Toggle::AUTO, 512, Integrator::BDPT}}) {
        Box box;
        box.options.sampling.spp = c.spp;
        box.options.transport.guide = c.guide;
        box.options.transport.path_reuse = Toggle::OFF;
        add_screened_lamp(box, c.side);
        const IntegratorChoice choice = box.choose().choice;
        EXPECT_EQ(choice.integrator, c.expected) << c.side << ": " << choice.reason; // told 3.9, 1.7, ...
    }
}

// Pilots meet no such sun by way of water: path+light looks as good as bdpt, for less work.
TEST(IntegratorChoice, BdptIsTakenForTheSakeOfItsGuide) {
    TestScene basin;
    add_sunlit_basin(basin, 0.5);
    basin.options.film.size = {64, 48};
    basin.options.sampling.spp = 2048;
    basin.options.transport.choose = Toggle::ON;
    for (const Toggle guide : {Toggle::AUTO, Toggle::OFF}) {
        basin.options.transport.guide = guide;
        const Chosen chosen = choose(basin);
        EXPECT_EQ(chosen.choice.integrator == Integrator::BDPT, guide == Toggle::AUTO);
        EXPECT_EQ(chosen.parts.guide != nullptr, guide == Toggle::AUTO);
    }
}

// A tree chooses path's lights, and tables those of bdpt, whose pilot cannot tell what a tree gains.
TEST(IntegratorChoice, WhereATreeChoosesLightsAPilotOfPathsOwnTellsOfPath) {
    for (const bool has_several_lamps : {false, true}) {
        TestScene scene;
        add_adjoining_rooms(scene);
        if (has_several_lamps)
            scene.build.use("lamp").polygon(
                {{-2, 0.2, -1.2}, {-1.9, 0.2, -1.2}, {-1.9, 0.2, -1.1}, {-2, 0.2, -1.1}});
        scene.options.film.size = {64, 48};
        scene.options.sampling.spp = 2048;
        const auto planned = plan_loaded(test_device(), scene.load(), scene.options);
        planned->options.transport.choose = Toggle::AUTO;
        PreparedParts parts;
        Progress silent(Toggle::OFF, true);
        const IntegratorChoice choice = choose_integrator(test_device(), planned, parts, silent);
        const IntegratorPrice price = price_of(choice, Integrator::BDPT);
        take_integrator(Integrator::PATH, *planned);
        PreparedParts own;
        const PathPilot path = run_path_pilot(prepare_path_pilot(test_device(), planned, own), choice.pilot);
        EXPECT_EQ(price.path == path.errors, has_several_lamps) << choice.reason;
        const size_t measure = size_t(ErrorMeasure::RELATIVE);
        const double rays = has_several_lamps ? path.rays : choice.prices[0].work;
        EXPECT_NEAR(price.efficiency, price.path[measure] * rays / (price.errors[measure] * price.work),
                    1e-9);
    }
}

// Nor can so small a pilot of path's own tell of caustics, which it hardly meets: splats do.
TEST(IntegratorChoice, WhereATreeChoosesLightsSplatsTellOfCaustics) {
    Box box;
    box.add_caustic();
    box.build.use("lamp").polygon({{1.5, 2.9, 1.5}, {1.6, 2.9, 1.5}, {1.6, 2.9, 1.6}, {1.5, 2.9, 1.6}});
    const Chosen chosen = box.choose();
    ASSERT_FALSE(chosen.planned->scene.light_tree.nodes.empty());
    EXPECT_EQ(chosen.choice.integrator, Integrator::PATH_LIGHT) << chosen.choice.reason;
    const size_t measure = size_t(ErrorMeasure::RELATIVE);
    const double told = price_of(chosen.choice, Integrator::PATH_LIGHT).path[measure];
    const double path = squared_error(box, Integrator::PATH);
    EXPECT_GT(told, 0.5 * path);
    EXPECT_LT(told, 2.2 * path);
    take_integrator(Integrator::PATH, *chosen.planned);
    PreparedParts own;
    const PreparedScene prepared = prepare_path_pilot(test_device(), chosen.planned, own);
    EXPECT_LT(run_path_pilot(prepared, chosen.choice.pilot).errors[measure], 0.5 * path);
}

TEST(IntegratorChoice, ThePictureIsThatOfTheChosenOne) {
    for (const bool has_small_lamp : {false, true}) {
        Box box;
        box.add_lamp(has_small_lamp ? 0.05 : 1.2);
        box.add_glass();
        const Chosen chosen = box.choose();
        const Render render =
            render_silently(prepare_render(test_device(), chosen.planned, {chosen.parts.tree, nullptr}));
        box.options.transport.choose = Toggle::OFF;
        box.options.transport.integrator = chosen.choice.integrator;
        EXPECT_TRUE(render.film.sums == box.render().film.sums) << name_of(chosen.choice.integrator);
    }
}

TEST(IntegratorChoice, SeedAndRangeOfSamplesChangeNothing) {
    Box box;
    box.add_caustic();
    const std::vector<IntegratorPrice> expected = box.choose().choice.prices;
    box.options.sampling.seed = 7;
    box.options.sampling.first_sample = 256;
    const std::vector<IntegratorPrice> found = box.choose().choice.prices;
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found[i].errors, expected[i].errors);
        EXPECT_EQ(found[i].work, expected[i].work);
    }
}

TEST(IntegratorChoice, WithoutCausticsSplatsAloneAreNotTried) {
    Box box;
    box.add_lamp(0.05);
    const Chosen chosen = box.choose();
    EXPECT_EQ(chosen.choice.integrator, Integrator::PATH) << chosen.choice.reason;
    ASSERT_EQ(chosen.choice.prices.size(), 2u);
    EXPECT_EQ(chosen.choice.prices[1].integrator, Integrator::BDPT);
    EXPECT_FALSE(chosen.planned->options.transport.max_depth);
}

TEST(IntegratorChoice, WhatOptionsNeedComesFirst) {
    Box box;
    box.add_caustic();
    const Options usual = box.options;
    const auto reason = [&](const auto& change) {
        box.options = usual;
        change(box.options);
        const IntegratorChoice choice = box.choose().choice;
        EXPECT_EQ(choice.integrator, Integrator::PATH) << choice.reason;
        EXPECT_TRUE(choice.prices.empty());
        return choice.reason.substr(0, choice.reason.find(' '));
    };
    EXPECT_EQ(reason([](Options& o) { o.transport.paths = "LD*E"; }), "--paths");
    EXPECT_EQ(reason([](Options& o) { o.output.path_layers = {{"direct", "LDE"}}; }), "--aov");
    EXPECT_EQ(reason([](Options& o) { o.transport.guide = Toggle::ON; }), "--guide");
    EXPECT_EQ(reason([](Options& o) { o.transport.path_reuse = Toggle::ON; }), "--path-reuse");
    EXPECT_EQ(reason([](Options& o) { o.scene.texture_filter = TextureFilter::FOOTPRINT; }),
              "--texture-filter");
    EXPECT_EQ(reason([](Options& o) { o.sampling.spp = 8; }), "too");
}

TEST(IntegratorChoice, LightThatPathCannotFindIsReasonEnough) {
    Box box;
    box.add_glass();
    box.options.light.points = {{{0, 2.9, 0}, {5, 5, 5}}};
    const IntegratorChoice choice = box.choose().choice;
    EXPECT_EQ(choice.integrator, Integrator::PATH_LIGHT) << choice.reason;
    EXPECT_NE(choice.reason.find("path does not see"), std::string::npos) << choice.reason;
    EXPECT_TRUE(choice.prices.empty());
}

TEST(IntegratorChoice, WhereAPilotSeesNoLightItIsPath) {
    Box box;
    box.add_caustic();
    box.look({0, 20, 4}, {0, 40, 0}, 50); // away from everything
    const IntegratorChoice choice = box.choose().choice;
    EXPECT_EQ(choice.integrator, Integrator::PATH);
    EXPECT_EQ(choice.reason, "a pilot finds no light");
}

TEST(IntegratorChoice, PilotsAreAShareOfTheRender) {
    Box box;
    box.add_caustic();
    box.options.film.size = {640, 480};
    const auto size = [&] { return pilot_size(*plan_loaded(test_device(), box.load(), box.options)); };
    const auto share = [&](double samples) { // 2.6 to 3.3 samples of path each, of either
        const std::optional<PilotSize> pilot = size();
        return pilot ? 2 * 3.3 * double(pilot->samples()) / samples : -1.0;
    };
    for (const std::uint32_t spp : {8u, 16u, 64u, 1024u}) {
        box.options.sampling.spp = spp;
        EXPECT_LT(share(640. * 480 * spp), 0.055) << spp;
        EXPECT_GT(share(640. * 480 * spp), 0) << spp;
    }
    box.options.film.crop = Crop{320, 240, 352, 272}; // a light path for every pixel of the picture
    EXPECT_FALSE(size());
    box.options.film.crop.reset();
    box.options.sampling.spp.reset();
    box.options.sampling.time_seconds = 1;
    EXPECT_FALSE(size());
    box.options.sampling.time_seconds = 60;
    EXPECT_TRUE(size());
    box.options.film.size = {7, 1};
    EXPECT_TRUE(size()->width <= 7 && size()->height == 1);
}

// Light round a screen: paths from both ends find more of it, and those that serve other pixels, too.
TEST(IntegratorChoice, PathThatReusesPathsIsTakenWhereItGainsMore) {
    Box box;
    box.options.sampling.spp = 1024;
    box.options.transport.choose = Toggle::AUTO;
    box.options.transport.guide = Toggle::OFF;
    add_screened_lamp(box, 1.35);
    const Chosen with = box.choose();
    EXPECT_EQ(with.choice.integrator, Integrator::PATH) << with.choice.reason;
    EXPECT_EQ(with.planned->options.transport.path_reuse, Toggle::ON) << with.choice.reason;
    box.options.transport.path_reuse = Toggle::OFF;
    const Chosen without = box.choose();
    EXPECT_EQ(without.choice.integrator, Integrator::BDPT) << without.choice.reason;
    EXPECT_EQ(without.planned->options.transport.path_reuse, Toggle::OFF);
    box.options.transport.path_reuse = Toggle::AUTO;
    box.options.run.pixel = glm::ivec2(10, 10);
    const Chosen replayed = box.choose();
    EXPECT_EQ(replayed.choice.integrator, Integrator::PATH) << "a replay is of the picture's integrator";
    EXPECT_EQ(replayed.planned->options.transport.path_reuse, Toggle::AUTO);
}

} // namespace clrt
