// SPDX-License-Identifier: Apache-2.0
// The ledger's statistics, table and JSON.
#include "render/ledger.h"
#include "render/ledger_plan.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

Ledger example() {
    Ledger ledger;
    ledger.width = 40, ledger.height = 30, ledger.samples = 4;
    ledger.bvh_quality = BvhQuality::HIGH, ledger.bvh_reason = "as chosen";
    ledger.specialised = {0.8, {0.1, 0.09, 0.11}};
    ledger.compile_scatter = 0.35;
    ledger.full = {1.2, {0.12, 0.11, 0.13}};
    ledger.full_extra_share = {0.2, 0.1, 0.3}, ledger.full_pairs = 12;
    ledger.full_compile_extra = 0.4;
    ledger.break_even = 40, ledger.break_even_low = 20;
    ledger.rows.push_back({"refraction",
                           {0.5, {0.06, 0.05, 0.07}},
                           -0.3,
                           {0.04, 0.03, 0.05},
                           {0.4, 0.3, 0.5},
                           {0.25, 0.2, 0.3},
                           18});
    return ledger;
}

/// Of a picture that does not show these.
Ledger absent_example() {
    Ledger ledger = example();
    ledger.of = LedgerOf::ABSENT;
    ledger.rows.clear();
    const std::pair<const char*, LedgerValue> shares[] = {{"mirror", {0.03, 0.02, 0.04}},
                                                          {"textures", {0.001, -0.004, 0.006}},
                                                          {"cut-outs", {0.01, 0.006, 0.014}},
                                                          {"glossy", {-0.02, -0.025, -0.015}}};
    for (const auto& [effect, share] : shares)
        ledger.rows.push_back({effect, {}, 0.05, {}, share, {}, 27});
    return ledger;
}

} // namespace

TEST(Ledger, CostsAreSaidWithTheirInterval) {
    EXPECT_EQ(describe_cost({0.03, 0.01, 0.05}), "costs 3.0 % (1.0 - 5.0)");
    EXPECT_EQ(describe_cost({-0.02, -0.03, -0.01}), "saves 2.0 % (1.0 - 3.0)");
    EXPECT_EQ(describe_cost({0.004, -0.002, 0.01}), "no cost seen (at most 1.0 %)");
    EXPECT_EQ(describe_cost({0, 0, 0}), "no cost seen (at most 0.0 %)");
}

TEST(Ledger, OnlyAnIntervalBesideOnePerCentDecides) {
    EXPECT_EQ(rule_side({0.02, 0.011, 0.03}), RuleSide::ABOVE);
    EXPECT_EQ(rule_side({0.004, -0.001, 0.009}), RuleSide::BELOW);
    EXPECT_EQ(rule_side({-0.02, -0.03, -0.01}), RuleSide::BELOW);
    EXPECT_EQ(rule_side({0.02, 0.009, 0.03}), RuleSide::UNDECIDED);
    EXPECT_EQ(rule_side({0.004, -0.002, 0.011}), RuleSide::UNDECIDED);
}

TEST(Ledger, TheTableHoldsEveryFigure) {
    const std::string text = format_ledger(example(), {}, {});
    for (const char* expected :
         {"40 x 30, path", "Pairs of 4 spp", "95 % intervals", "refraction", "costs 40.0 % (30.0 - 50.0)",
          "25.0 (20.0 - 30.0)", "not seen        18\n", "40 (30 - 50)", "100 (90 - 110)",
          "costs 20.0 % (10.0 - 30.0)", "+0.40", "0.80 (+-0.35)", "after 40 samples a pixel (20 - never)",
          "at once where neither"})
        EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
    Ledger slower = example();
    slower.break_even.reset();
    EXPECT_NE(format_ledger(slower, {}, {}).find("does not pay here"), std::string::npos);
}

TEST(Ledger, TheJsonHoldsTheSame) {
    const auto json = nlohmann::json::parse(ledger_json(example(), {}, {}));
    EXPECT_EQ(json["confidence"], 0.95);
    EXPECT_EQ(json["clock"], "processor");
    EXPECT_EQ(json["picture"]["compile_scatter_seconds"], 0.35);
    EXPECT_EQ(json["effects"][0]["pairs"], 18);
    EXPECT_EQ(json["effects"][0]["cost"], "costs 40.0 % (30.0 - 50.0)");
    EXPECT_EQ(json["effects"][0]["compile_extra_seconds"], -0.3);
    EXPECT_FALSE(json.contains("absent_effects"));
    EXPECT_EQ(json["full_program"]["compile_extra_seconds"], 0.4);
    EXPECT_EQ(json["full_program"]["pairs"], 12);
    EXPECT_EQ(json["bvh"]["quality"], "high");
    EXPECT_EQ(json["bvh"]["reason"], "as chosen");
    EXPECT_EQ(json["effects"][0]["name"], "refraction");
    EXPECT_EQ(json["effects"][0]["light_share"]["high"], 0.3);
    EXPECT_EQ(json["effects"][0]["without"]["compile_seconds"], 0.5);
    EXPECT_EQ(json["break_even_spp"]["median"], 40);
    EXPECT_TRUE(json["break_even_spp"]["high"].is_null());
    EXPECT_EQ(json["full_program"]["extra_share"]["low"], 0.1);
}

TEST(Ledger, CodeOfAbsentEffectsIsHeldAgainstTheRule) {
    const std::string text = format_ledger(absent_example(), {}, {});
    for (const char* expected :
         {"Ledger of what is not in ", "code of", "no cost seen (at most 0.6 %)", "saves 2.0 % (1.5 - 2.5)",
          "Above 1 %: mirror.\n", "Below 1 %: textures, glossy.\n", "Not told from 1 %: cut-outs.\n"})
        EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
    EXPECT_EQ(text.find("light"), std::string::npos);
    const auto json = nlohmann::json::parse(ledger_json(absent_example(), {}, {}));
    EXPECT_FALSE(json.contains("effects"));
    EXPECT_EQ(json["absent_effects"][0]["rule"], "above");
    EXPECT_EQ(json["absent_effects"][1]["rule"], "below");
    EXPECT_EQ(json["absent_effects"][2]["rule"], "undecided");
    EXPECT_FALSE(json["absent_effects"][0].contains("light_share"));
    EXPECT_EQ(format_ledger(example(), {}, {}).find("Above 1 %"), std::string::npos);
}

TEST(LedgerPlan, WhatDoesNotFitTheTimeIsLeftOut) {
    LedgerPlan plan(30, 1);
    plan.add({2.5, 0.05, 0.15});
    plan.add({3.5, 0.05, 0.05});
    // By now 7 s; another variant compiles for 3.15 s, and eight pairs of runs of 0.15 s take 2.4 s.
    EXPECT_NEAR(plan.needed(17, 7), 7 + 15 * 3.15 + 17 * 2.4, 1e-9);
    EXPECT_EQ(plan.fitting(17, 7), 5u) << "7 + 3 * 3.15 + 5 * 2.4 are 28.45 s, one more makes 34 s";
    EXPECT_EQ(plan.fitting(4, 7), 4u);
    EXPECT_EQ(plan.fitting(17, 100), 2u) << "what is compiled is rendered";
    EXPECT_EQ(LedgerPlan({}, {}).fitting(17, 1000), 17u) << "no limit";
    plan.add_pairs(2.4);
    EXPECT_NEAR(plan.needed(17, 10), 10 + 15 * 3.15 + 16 * 2.4, 1e-9);
    LedgerPlan with_samples(30, 8);
    with_samples.add({3, 0.05, 0.1});
    EXPECT_NEAR(with_samples.needed(2, 0), 3.15 + 2 * 16 * 0.85, 1e-9);
}

TEST(LedgerPlan, PairsShareTheTimeThatIsLeft) {
    LedgerPlan plan(30, 1);
    plan.add({3, 0.05, 0.1});
    EXPECT_NEAR(plan.pair_seconds(4, 10), 0.9 * (20 - 3 * 3.15) / 4, 1e-9) << "three are to be compiled";
    plan.add_pairs(1);
    EXPECT_NEAR(plan.pair_seconds(4, 11), 0.9 * (19 - 3 * 3.15) / 3, 1e-9) << "what one saved the others get";
    EXPECT_EQ(plan.pair_seconds(4, 100), 0);
    LedgerPlan free({}, 1);
    free.add({3, 0.05, 0.1});
    EXPECT_NEAR(free.pair_seconds(10, 500), 6, 1e-9) << "a minute of pairs, however long compiling takes";
    free.add_pairs(60);
    EXPECT_EQ(free.pair_seconds(10, 600), 0);
}

TEST(LedgerPlan, RunsAreLikeThoseOfAPictureAndLongEnoughToBeTimed) {
    const auto samples = [](double run, double pass) {
        LedgerPlan plan({}, {});
        plan.add({3, run, pass});
        return plan.samples();
    };
    EXPECT_EQ(samples(0.01, 0.01), 32u) << "as many as a launch of a picture has";
    EXPECT_EQ(samples(0.01, 0.05), 10u) << "in half a second";
    EXPECT_EQ(samples(0.01, 3), 1u);
    EXPECT_EQ(samples(0.01, 0.001), 50u) << "a twentieth of a second";
    EXPECT_EQ(samples(2, 0.1), 20u) << "a large scene's way to the device";
    EXPECT_EQ(samples(0.01, 0), 4096u);
    LedgerPlan as_asked(1, 7);
    as_asked.add({3, 0.05, 0.1});
    EXPECT_EQ(as_asked.samples(), 7u);
}

TEST(Ledger, WhatWasNotMeasuredIsNamed) {
    EXPECT_EQ(format_ledger(example(), {}, {}).find("Not measured"), std::string::npos);
    Ledger cut = example();
    cut.not_measured = {"textures", "dispersion"};
    cut.seconds = 29.5, cut.compile_seconds = 20;
    const std::string text = format_ledger(cut, {}, {});
    EXPECT_NE(text.find("The ledger took 29.5 s, 20.0 s of it compiling."), std::string::npos) << text;
    EXPECT_NE(text.find("Not measured, for want of time: textures, dispersion."), std::string::npos) << text;
    const auto json = nlohmann::json::parse(ledger_json(cut, {}, {}));
    EXPECT_EQ(json["not_measured"].size(), 2u);
    EXPECT_EQ(json["seconds"], 29.5);
}

} // namespace clrt
