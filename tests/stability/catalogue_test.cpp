// SPDX-License-Identifier: Apache-2.0
// Every case of the catalogue (tools/stability/cases) holds, in its quick tier. The texts of a case say what
// its figures mean.
#include "stability/report.h"
#include "support/test_device.h"

#include <cmath>
#include <gtest/gtest.h>
#include <set>
#include <string>

namespace clrt {
namespace {

class Catalogue : public testing::TestWithParam<const StabilityCase*> {};

TEST_P(Catalogue, Holds) {
    const CaseResult result = run_case(*GetParam(), test_device(), Tier::QUICK);
    EXPECT_TRUE(result.holds()) << format_case_head() << format_case(result);
    RecordProperty("figures", format_case(result));
}

INSTANTIATE_TEST_SUITE_P(Case, Catalogue, testing::ValuesIn(chosen_cases()),
                         [](const auto& of) { return std::string(of.param->id) + "_" + of.param->name; });

TEST(CatalogueTable, EveryIdStandsOnceAndUnderItsGroup) {
    std::set<std::string> ids;
    std::string letters;
    for (const CaseGroup& group : catalogue()) {
        letters += group.letter;
        for (const StabilityCase& subject : group.cases) {
            EXPECT_TRUE(ids.insert(subject.id).second) << subject.id << " is there twice";
            EXPECT_EQ(subject.id[0], group.letter) << subject.id;
            EXPECT_NE(subject.run, nullptr) << subject.id;
        }
    }
    for (const WaitingCase& waiting : waiting_cases()) {
        EXPECT_TRUE(ids.insert(waiting.id).second) << waiting.id << " is there twice";
        EXPECT_NE(letters.find(waiting.id[0]), std::string::npos) << waiting.id << " has no group";
    }
}

TEST(CatalogueTable, ACheckWithoutInputsOrBeyondItsLimitFails) {
    Figure figure{"figure", 1, {}};
    EXPECT_FALSE(figure.holds());
    figure[Build::SINGLE].see(1, [] { return "one"; });
    EXPECT_TRUE(figure.holds());
    figure[Build::FAST].see(5, [] { return "fast may"; });
    EXPECT_TRUE(figure.holds());
    figure[Build::DOUBLE].see(std::nan(""), [] { return "NaN"; });
    EXPECT_FALSE(figure.holds());
    EXPECT_EQ(figure[Build::DOUBLE].input, "NaN");
}

} // namespace
} // namespace clrt
