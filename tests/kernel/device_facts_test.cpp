// SPDX-License-Identifier: Apache-2.0
// How the device under test computes, and what is made of a device that computes otherwise.
#include "device/device_facts.h"
#include "probes/kernel_probe.h"
#include "probes/scratch_folder.h"
#include "support/test_device.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// The facts of the device under test, asked once.
const DeviceFacts& facts() {
    static const DeviceFacts asked = measure_device_facts(test_device());
    return asked;
}

bool holds(const DeviceFacts& of, const std::string& rule) {
    for (const auto& [name, value] : of.rules)
        if (name == rule)
            return value;
    ADD_FAILURE() << "no rule \"" << rule << "\"";
    return false;
}

std::vector<std::filesystem::path> files_of(const std::string& folder) {
    return {std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()};
}

} // namespace

TEST(DeviceFacts, TheDeviceUnderTestKeepsEveryRuleThatTheSameBitsNeed) {
    EXPECT_EQ(broken_rules(facts()), std::vector<std::string>{}) << describe_facts(facts());
    EXPECT_TRUE(promises_bits(facts()));
    EXPECT_TRUE(holds(facts(), "functions of fixed bits"));
    for (const auto& [name, ulp] : facts().errors_ulp) {
        EXPECT_LT(ulp, 2) << name;
        if (name == "division" || name == "square root") {
            EXPECT_LE(ulp, 0.5) << name;
            EXPECT_GT(ulp, 0.49) << name << ": the operands have to be hard";
        }
    }
}

TEST(DeviceFacts, ABrokenRuleIsNamedButTheOrderOfSumsDoesNotMatter) {
    DeviceFacts other = facts();
    for (auto& [name, value] : other.rules)
        value = name != "sums in order" && name != "fma rounded once";
    EXPECT_FALSE(promises_bits(other));
    EXPECT_EQ(broken_rules(other), std::vector<std::string>{"fma rounded once"});
    EXPECT_NE(describe_facts(other).find("not kept: fma rounded once, sums in order"), std::string::npos);
    EXPECT_FALSE(promises_bits(DeviceFacts()));
}

TEST(DeviceFacts, JsonHoldsThemAll) {
    DeviceFacts other = facts();
    other.rules.front().second = false;
    other.errors_ulp.front().second = INFINITY;
    const DeviceFacts read = facts_from_json(nlohmann::ordered_json::parse(facts_json(other).dump()));
    EXPECT_EQ(read.rules, other.rules);
    EXPECT_EQ(read.errors_ulp, other.errors_ulp);
}

TEST(DeviceFacts, AreKeptInTheCacheUnlessItIsOff) {
    const ScratchFolder scratch;
    const std::string folder = scratch.file("cache");
    EXPECT_EQ(device_facts(test_device(), {Toggle::OFF, folder}).rules, facts().rules);
    EXPECT_FALSE(std::filesystem::exists(folder));
    EXPECT_EQ(device_facts(test_device(), {Toggle::AUTO, folder}).rules, facts().rules);
    const std::vector<std::filesystem::path> files = files_of(folder);
    ASSERT_EQ(files.size(), 1u);

    // What is kept is read: change it.
    DeviceFacts changed = facts();
    changed.rules.front().second = false;
    std::ofstream(files[0]) << facts_json(changed).dump();
    EXPECT_EQ(device_facts(test_device(), {Toggle::AUTO, folder}).rules, changed.rules);
    // A damaged file is asked again and replaced.
    std::ofstream(files[0]) << "{\"rules\": 3";
    EXPECT_EQ(device_facts(test_device(), {Toggle::AUTO, folder}).rules, facts().rules);
    EXPECT_EQ(facts_from_json(nlohmann::ordered_json::parse(std::ifstream(files[0]))).rules, facts().rules);
    EXPECT_EQ(files_of(folder).size(), 1u);
}

} // namespace clrt
