// SPDX-License-Identifier: Apache-2.0
// Reports of clrt-stability from made-up results.
#include "stability/report.h"

#include <cmath>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// A report of one case: a figure whose single is off by `deviation`, at an input that is no HTML.
StabilityReport report_of(double deviation) {
    StabilityReport report;
    report.device.name = "A & B <device>";
    report.command = {"clrt-stability", "--device", "\"<b>\""};
    CaseResult result;
    result.subject = chosen_cases().front();
    Figure figure{"|a < b|", 1, {}};
    figure[Build::NAIVE].see(1e3, [] { return "naive"; });
    figure[Build::SINGLE].see(deviation, [] { return "x\" onmouseover=\"alert(1)<&>"; });
    result.figures.push_back(figure);
    report.cases.push_back(result);
    return report;
}

} // namespace

TEST(StabilityReport, ThePageEscapesWhatItWasGiven) {
    const std::string page = report_page(report_of(0.5));
    for (const char* raw : {"<device>", "\"<b>\"", "\" onmouseover", "<&>", "a < b"})
        EXPECT_EQ(page.find(raw), std::string::npos) << raw;
    for (const char* kept :
         {"A &amp; B &lt;device&gt;", "x&quot; onmouseover=&quot;alert(1)&lt;&amp;&gt;", "|a &lt; b|"})
        EXPECT_NE(page.find(kept), std::string::npos) << kept;
}

TEST(StabilityReport, ThePageShowsNaiveBesideSingleAndWhatFails) {
    const std::string page = report_page(report_of(5));
    EXPECT_NE(page.find("1e+03</span> &rarr; <b>"), std::string::npos);
    EXPECT_NE(page.find("fails</b>"), std::string::npos);
    EXPECT_NE(page.find(": 0 of 1</li>"), std::string::npos);
    EXPECT_EQ(report_page(report_of(0.5)).find("fails</b>"), std::string::npos);
}

TEST(StabilityReport, WhatIsNotFiniteIsNullInJson) {
    const auto json = nlohmann::json::parse(report_json(report_of(std::nan(""))));
    EXPECT_TRUE(json.at("cases")[0].at("figures")[0].at("single").at("worst").is_null());
    EXPECT_EQ(json.at("holds"), false);
}

TEST(StabilityReport, EveryChoiceShowsAFigureOfACaseThatRuns) {
    for (const RobustChoice& choice : robust_choices())
        EXPECT_EQ(chosen_cases({choice.case_id}).size(), 1u) << choice.choice << ": " << choice.case_id;
}

} // namespace clrt
