// SPDX-License-Identifier: Apache-2.0
// The alias table by exact enumeration of its integers; a million weights are case L07 of the catalogue.
#include "scene/alias_table.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

using namespace clrt;

namespace {

constexpr double WORDS = 4294967296.0;

/// What the documented procedure chooses: word below threshold keeps i, else alias.
std::vector<double> enumerate(const AliasTable& table) {
    std::vector<double> p(table.entries.size(), 0);
    for (size_t i = 0; i < p.size(); ++i) {
        const double kept = table.entries[i].threshold / WORDS;
        p[i] += kept / double(p.size());
        p[table.entries[i].alias] += (1 - kept) / double(p.size());
    }
    return p;
}

} // namespace

TEST(AliasTable, WeightsOfZeroAreNeverChosen) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int round = 0; round < 200; ++round) {
        std::vector<double> weights(1 + random() % 50);
        for (double& weight : weights)
            weight = uniform(random) < 0.5 ? 0 : uniform(random);
        weights[random() % weights.size()] = 1;
        const AliasTable table = build_alias_table(weights);
        const std::vector<double> p = enumerate(table);
        for (size_t i = 0; i < weights.size(); ++i) {
            EXPECT_EQ(weights[i] == 0, table.probability[i] == 0);
            if (weights[i] == 0) {
                EXPECT_EQ(p[i], 0);
            }
        }
    }
}

TEST(AliasTable, TinyWeightsStayReachable) {
    const AliasTable table = build_alias_table({1e-300, 1, 1e-20, 3});
    EXPECT_GE(table.entries[0].threshold, 1u);
    EXPECT_GT(table.probability[0], 0);
    EXPECT_GT(table.probability[2], 0);
    EXPECT_NEAR(table.probability[3], 0.75, 1e-9);
}

TEST(AliasTable, FullEntriesAreTheirOwnAlias) {
    const AliasTable table = build_alias_table({2, 2, 2});
    for (u32 i = 0; i < 3; ++i) {
        EXPECT_EQ(table.entries[i].alias, i);
        EXPECT_DOUBLE_EQ(table.probability[i], 1.0 / 3);
    }
    EXPECT_DOUBLE_EQ(build_alias_table({5}).probability[0], 1);
}

TEST(AliasTable, HugeWeightsDoNotOverflow) {
    const AliasTable table = build_alias_table({1e308, 1e308, 1e308, 0});
    EXPECT_NEAR(table.probability[0], 1.0 / 3, 1e-9);
    EXPECT_EQ(table.probability[3], 0);
}

TEST(AliasTable, NoWeightsGiveAnEmptyTable) {
    EXPECT_TRUE(build_alias_table({}).entries.empty());
}
