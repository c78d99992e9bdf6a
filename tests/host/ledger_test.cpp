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
    ledger.full = {1.2, {0.12, 0.11, 0.13}};
    ledger.full_extra_share = {0.2, 0.1, 0.3};
    ledger.break_even = 40, ledger.break_even_low = 20;
    ledger.rows.push_back(
        {"refraction", {0.5, {0.06, 0.05, 0.07}}, {0.04, 0.03, 0.05}, {0.4, 0.3, 0.5}, {0.25, 0.2, 0.3}});
    return ledger;
}

} // namespace

TEST(Ledger, TheMedianHasTheSecondAndTheLastButOneAsItsInterval) {
    const LedgerValue value = ledger_value({9, 1, 5, 3, 100, 2, 7, 4, -50});
    EXPECT_EQ(value.median, 4);
    EXPECT_EQ(value.low, 1);
    EXPECT_EQ(value.high, 9);
}

TEST(Ledger, TheTableHoldsEveryFigure) {
    const std::string text = format_ledger(example(), {}, {});
    for (const char* expected :
         {"40 x 30, path", "9 rounds of 4 spp", "refraction", "40.0 (30.0 - 50.0)", "25.0 (20.0 - 30.0)",
          "20.0 (10.0 - 30.0) more", "after 40 samples a pixel (20 - never)", "at once where neither"})
        EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
    Ledger slower = example();
    slower.break_even.reset();
    EXPECT_NE(format_ledger(slower, {}, {}).find("does not pay here"), std::string::npos);
}

TEST(Ledger, TheJsonHoldsTheSame) {
    const auto json = nlohmann::json::parse(ledger_json(example(), {}, {}));
    EXPECT_EQ(json["rounds"], LEDGER_ROUNDS);
    EXPECT_EQ(json["bvh"]["quality"], "high");
    EXPECT_EQ(json["bvh"]["reason"], "as chosen");
    EXPECT_EQ(json["effects"][0]["name"], "refraction");
    EXPECT_EQ(json["effects"][0]["light_share"]["high"], 0.3);
    EXPECT_EQ(json["effects"][0]["without"]["compile_seconds"], 0.5);
    EXPECT_EQ(json["break_even_spp"]["median"], 40);
    EXPECT_TRUE(json["break_even_spp"]["high"].is_null());
    EXPECT_EQ(json["full_program"]["extra_share"]["low"], 0.1);
}

TEST(LedgerPlan, WhatDoesNotFitTheTimeIsLeftOut) {
    LedgerPlan plan(30, {});
    plan.add({2.5, 0.05, 0.15});
    plan.add({3.5, 0.05, 0.05});
    // By now 7 s; another variant compiles for 3.15 s, and nine runs of it take 1.35 s.
    EXPECT_NEAR(plan.needed(17, 7), 7 + 15 * 3.15 + 17 * 1.35, 1e-9);
    EXPECT_EQ(plan.fitting(17, 7), 6u) << "7 + 4 * 3.15 + 6 * 1.35 are 27.7 s, one more makes 32.2 s";
    EXPECT_EQ(plan.fitting(5, 7), 5u);
    EXPECT_EQ(plan.fitting(17, 100), 2u) << "what is compiled is rendered";
    EXPECT_EQ(LedgerPlan({}, {}).fitting(17, 1000), 17u) << "no limit";
    LedgerPlan with_samples(30, 8);
    with_samples.add({3, 0.05, 0.1});
    EXPECT_NEAR(with_samples.needed(2, 0), 3.15 + 18 * 0.85, 1e-9);
}

TEST(LedgerPlan, RoundsShareTheTimeThatIsLeft) {
    LedgerPlan plan(30, {});
    plan.add({3, 0.05, 0.1});
    // 0.9 * 20 s for 9 rounds of 4 variants: 0.5 s each, of which 0.45 s for samples.
    EXPECT_EQ(plan.samples(4, 9, 10), 4u);
    EXPECT_EQ(plan.samples(4, 1, 29.9), 1u) << "late: one sample at least";
    EXPECT_EQ(plan.samples(1, 1, 0), 64u) << "more are no use";
    LedgerPlan free({}, {});
    free.add({3, 0.05, 0.1});
    EXPECT_EQ(free.samples(10, 9, 500), 5u) << "a minute from when the rounds begin: 0.6 s each";
    EXPECT_EQ(free.samples(10, 3, 540), 5u);
    EXPECT_EQ(LedgerPlan(1, 7).samples(4, 9, 0), 7u) << "as asked";
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
