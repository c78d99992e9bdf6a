// SPDX-License-Identifier: Apache-2.0
// The ledger's statistics, table and JSON.
#include "render/ledger.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

Ledger example() {
    Ledger ledger;
    ledger.width = 40, ledger.height = 30, ledger.samples = 4;
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
    EXPECT_EQ(json["effects"][0]["name"], "refraction");
    EXPECT_EQ(json["effects"][0]["light_share"]["high"], 0.3);
    EXPECT_EQ(json["effects"][0]["without"]["compile_seconds"], 0.5);
    EXPECT_EQ(json["break_even_spp"]["median"], 40);
    EXPECT_TRUE(json["break_even_spp"]["high"].is_null());
    EXPECT_EQ(json["full_program"]["extra_share"]["low"], 0.1);
}

} // namespace clrt
