// SPDX-License-Identifier: Apache-2.0
// clrt-stability as a user runs it: its table, JSON and page, its errors, and that it finds kernels that are
// wrong.
#include "clrt_command.h"
#include "stability/catalogue.h"

#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// CLRT_EXECUTABLE is clrt-stability in this program.
class StabilityCommand : public ClrtCommand {
protected:
    void expect_usage_error(const std::vector<std::string>& arguments,
                            const std::vector<std::string>& message) const {
        const CommandResult result = clrt(arguments);
        EXPECT_EQ(result.exit_code, 2) << result.err;
        EXPECT_TRUE(holds(result.err, {"clrt-stability: error: "}));
        EXPECT_TRUE(holds(result.err, message));
        EXPECT_EQ(result.out, "");
    }
};

std::string last_line(const std::string& text) {
    const size_t end = text.find_last_not_of('\n');
    return text.substr(text.rfind('\n', end) + 1, end - text.rfind('\n', end));
}

} // namespace

TEST_F(StabilityCommand, RunsTheCasesAskedForAndEndsWithTheSummary) {
    const CommandResult result =
        clrt({"--case", "T01", "--case", "X04", "--no-costs", "--stats", "s.json", "-o", "page.html"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"T01 ", "|dF|", "X04 ", "holds"}));
    EXPECT_TRUE(holds(last_line(result.out), {"2 of 2 cases hold, quick tier, "})) << result.out;
    EXPECT_EQ(result.out.find('%'), std::string::npos) << "progress goes to stderr";

    const auto json = nlohmann::json::parse(folder.read("s.json"));
    EXPECT_EQ(json.at("holds"), true);
    EXPECT_EQ(json.at("tier"), "quick");
    ASSERT_EQ(json.at("cases").size(), 2u);
    EXPECT_EQ(json.at("cases")[0].at("id"), "T01");
    EXPECT_LE(json.at("cases")[0].at("figures")[0].at("single").at("worst"),
              json.at("cases")[0].at("figures")[0].at("limit"));
    EXPECT_GT(json.at("cases")[0].at("figures")[0].at("single").at("tried"), 1000);
    EXPECT_GT(json.at("waiting").size(), 5u);
}

TEST_F(StabilityCommand, ItsPageNeedsNothingElse) {
    ASSERT_EQ(clrt({"--case", "X04", "--no-costs", "-o", "page.html"}).exit_code, 0);
    EXPECT_EQ(listing(), std::vector<std::string>{"page.html"});
    const std::string page = folder.read("page.html");
    EXPECT_TRUE(holds(page, {"<!doctype html>", "<meta charset=\"utf-8\">", "X04 PictureRange", "waits for",
                             "--case X04", "</html>"}));
    for (const char* outside : {"http:", "https:", "src=", "url(", "@import", "<link", "<script"})
        EXPECT_EQ(page.find(outside), std::string::npos) << outside;
}

TEST_F(StabilityCommand, FourForWrongKernels) {
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    std::string text = folder.read("kernels/scattering/fresnel.h");
    const size_t half = text.find("REAL(0.5)");
    ASSERT_NE(half, std::string::npos);
    folder.write("kernels/scattering/fresnel.h", text.replace(half, 9, "REAL(0.51)"));
    const CommandResult result =
        clrt({"--case", "T01", "--no-costs", "--kernels", "kernels", "--stats", "s.json"});
    EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"FAILS", "worst in single: cos 0x"}));
    EXPECT_TRUE(holds(last_line(result.out), {"0 of 1 cases hold, 1 FAIL"}));
    EXPECT_EQ(nlohmann::json::parse(folder.read("s.json")).at("holds"), false);
}

TEST_F(StabilityCommand, FourForKernelsThatDoNotCompile) {
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    folder.write("kernels/scattering/fresnel.h", "this is no kernel");
    const CommandResult result = clrt({"--case", "T01", "--no-costs", "--kernels", "kernels"});
    EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"T01 ", "FAILS: The compiler"}));
}

TEST_F(StabilityCommand, TimesTheChoicesOfTheCases) {
    const CommandResult result = clrt({"--case", "T01", "--stats", "s.json"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"what robustness costs", "Fresnel reflectance"}));
    const auto json = nlohmann::json::parse(folder.read("s.json"));
    const auto& costs = json.at("costs");
    ASSERT_GE(costs.size(), 1u);
    EXPECT_GT(costs[0].at("ratio"), 0);
}

TEST_F(StabilityCommand, TakesEveryTiming) {
    const CommandResult result =
        clrt({"--only-costs", "--rounds", "1", "--stats", "s.json", "-o", "page.html"});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
    EXPECT_TRUE(holds(last_line(result.out), {"no case ran, quick tier, "})) << result.out;
    const auto json = nlohmann::json::parse(folder.read("s.json"));
    EXPECT_FALSE(json.contains("cases"));
    ASSERT_EQ(json.at("costs").size(), robust_choices().size());
    EXPECT_GE(json.at("render_costs").size(), 4u) << "two scenes by two ways of building, on any device";
    const std::string page = folder.read("page.html");
    for (const char* table : {"costs", "render_costs"})
        for (const auto& row : json.at(table)) {
            EXPECT_GT(row.at("ratio"), 0) << row;
            EXPECT_NE(page.find(row.at("choice")), std::string::npos) << row;
        }
    EXPECT_EQ(page.find("fails"), std::string::npos);
}

TEST_F(StabilityCommand, FourForATimingThatFailsAndTheOthersAreTaken) {
    std::filesystem::copy(CLRT_KERNELS_FOLDER, folder.file("kernels"),
                          std::filesystem::copy_options::recursive);
    folder.write("kernels/lights/spherical_triangle.h", "this is no kernel");
    const CommandResult result = clrt({"--only-costs", "--case", "L06", "--case", "L09", "--rounds", "1",
                                       "--kernels", "kernels", "--stats", "s.json", "-o", "page.html"});
    EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
    EXPECT_TRUE(holds(result.out, {"Point of a near lamp: by area", "FAILS: The compiler"}));
    EXPECT_TRUE(holds(last_line(result.out), {"no case ran, 1 of 2 timings FAIL"})) << result.out;
    const auto costs = nlohmann::json::parse(folder.read("s.json")).at("costs");
    ASSERT_EQ(costs.size(), 2u);
    EXPECT_NE(costs[0].at("error").get<std::string>().find("spherical_triangle"), std::string::npos);
    EXPECT_FALSE(costs[0].contains("ratio"));
    EXPECT_GT(costs[1].at("ratio"), 0);
    EXPECT_TRUE(holds(folder.read("page.html"), {"fails</b>: The compiler", "MIS weight"}));
}

TEST_F(StabilityCommand, TwoForWrongUsage) {
    expect_usage_error({"--case", "Q99"}, {"--case", "'Q99'", "--list"});
    expect_usage_error({"--tier", "daily"}, {"--tier", "'daily'"});
    expect_usage_error({"--no-such-option"}, {"--no-such-option", "--help"});
    expect_usage_error({"scene.obj"}, {"scene.obj"});
    expect_usage_error({"--rounds", "0"}, {"--rounds", "from 1", "found 0"});
    expect_usage_error({"--no-costs", "--only-costs"}, {"--no-costs", "--only-costs"});
}

TEST_F(StabilityCommand, OneAndThreeAsClrt) {
    EXPECT_EQ(clrt({"--case", "X04", "--stats", "no/folder/s.json"}).exit_code, 1);
    EXPECT_EQ(clrt({"--case", "X04", "--device", "no such device"}).exit_code, 3);
}

TEST_F(StabilityCommand, SaysWhatItIs) {
    EXPECT_TRUE(holds(clrt({"--help"}).out, {"Usage: clrt-stability", "--stats FILE", "Exit codes:"}));
    EXPECT_TRUE(holds(clrt({"--version"}).out, {"clrt-stability "}));
    EXPECT_TRUE(holds(clrt({"--list"}).out, {"Dielectrics", "T01 CriticalAngle", "waits for", "against "}));
}

} // namespace clrt
