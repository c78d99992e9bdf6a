// SPDX-License-Identifier: Apache-2.0
// clrt-stability as a user runs it: its table, JSON and page, its errors, and that it finds kernels that are
// wrong.
#include "clrt_command.h"

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

TEST_F(StabilityCommand, TwoForWrongUsage) {
    expect_usage_error({"--case", "Q99"}, {"--case", "'Q99'", "--list"});
    expect_usage_error({"--tier", "daily"}, {"--tier", "'daily'"});
    expect_usage_error({"--no-such-option"}, {"--no-such-option", "--help"});
    expect_usage_error({"scene.obj"}, {"scene.obj"});
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
