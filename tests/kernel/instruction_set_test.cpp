// SPDX-License-Identifier: Apache-2.0
// Kernels do on every instruction set that PoCL compiles for what they do on this processor's widest one:
// tests of what is most likely to differ (wide vectors, how numbers are rounded) run once more in each.
#include "support/instruction_sets.h"
#include "support/run_command.h"

#include <gtest/gtest.h>

namespace clrt {

namespace {

/// A test program with the tests of it to run.
struct TestProgram {
    const char* path;
    const char* filter;
};

const TestProgram PROGRAMS[] = {
    {TRAVERSE_TEST, "*InDouble*:*LayoutsGiveTheSameBits"}, // double8, float8
    {DEVICE_FACTS_TEST, "*"},                              // division, fma, NaN, subnormal numbers
    {REAL_FUNCTIONS_TEST, "*InDouble*:*GiveTheSameBits*"}, // elementary functions
};

} // namespace

TEST(InstructionSet, EveryOneThatPoclCompilesForPassesTheSameTests) {
    for (const InstructionSet& set : instruction_sets())
        for (const TestProgram& program : PROGRAMS) {
            CommandSettings settings;
            settings.environment[InstructionSet::VARIABLE] = set.name;
            const CommandResult result =
                run_command({program.path, std::string("--gtest_filter=") + program.filter}, settings);
            EXPECT_EQ(result.exit_code, 0) << set.name << ":\n" << result.out << result.err;
            EXPECT_NE(result.out.find("[  PASSED  ]"), std::string::npos) << set.name << ", " << program.path;
            EXPECT_EQ(result.out.find("[  PASSED  ] 0 tests"), std::string::npos)
                << program.path << " has no test " << program.filter;
        }
}

} // namespace clrt
