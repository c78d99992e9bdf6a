// SPDX-License-Identifier: Apache-2.0
// The names of enums against the enums, the parser and --help.
#include "app/option_table.h"
#include "host/command_line_support.h"
#include "options/options.h"

#include <gtest/gtest.h>
#include <iterator>
#include <set>

namespace clrt {

namespace {

/// Expects `count` values in their order, each by one name that --help shows and the option takes.
template <typename T>
void expect_names(const char* option, size_t count) {
    SCOPED_TRACE(option);
    std::set<std::string> names;
    for (const auto& row : NAMES<T>) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_STREQ(name_of(row.value), row.name);
        EXPECT_EQ(find_named<T>(row.name), row.value);
        EXPECT_NE(find_option(option)->help.find(row.name), std::string::npos) << row.name;
        EXPECT_EQ(refusal({option, row.name, "s.obj"}), "accepted") << row.name;
    }
    EXPECT_EQ(names.size(), count);
    EXPECT_FALSE(find_named<T>("nothing"));
}

/// The same of an enum that counts from 0.
template <typename T>
void expect_counted_names(const char* option, T last) {
    expect_names<T>(option, size_t(last) + 1);
    int expected = 0;
    for (const auto& row : NAMES<T>)
        EXPECT_EQ(int(row.value), expected++) << option << ' ' << row.name;
}

} // namespace

TEST(Names, EveryValueHasOneThatItsOptionTakes) {
    expect_counted_names("--integrator", std::rbegin(INTEGRATOR_ROWS)->value);
    expect_counted_names("--sampler", SamplerChoice::INDEPENDENT);
    expect_counted_names("--light-sampler", LightSampler::TREE);
    expect_counted_names("--precision", Precision::FAST);
    expect_counted_names("--mtl", MtlReading::PLAIN);
    expect_counted_names("--gltf-lights", GltfLights::RAW);
    expect_counted_names("--material", MaterialOverride::CLAY);
    expect_counted_names("--texture-filter", TextureFilter::FOOTPRINT);
    expect_counted_names("--filter", Filter::GAUSSIAN);
    expect_counted_names("--tonemap", Tonemap::AGX);
    expect_counted_names("--view", View::ISO);
    expect_counted_names("--check", Check::STRICT);
    expect_counted_names("--cache", Toggle::OFF);
    expect_counted_names("--progress", Toggle::OFF);
    expect_counted_names("--bvh", BvhQuality::HIGH);
    expect_names<BvhLayout>("--bvh", 3);
}

TEST(Names, AWrongOneIsAnsweredWithAllOfThem) {
    EXPECT_EQ(refusal({"--view", "up", "s.obj"}),
              "option --view: expected front, back, left, right, top, bottom or iso, found 'up'");
    EXPECT_EQ(refusal({"--bvh", "bvh9", "s.obj"}),
              "option --bvh: expected auto, bvh8, bvh2, cwbvh, fast, high, or a layout and a quality as in "
              "bvh8,high, found 'bvh9'");
}

} // namespace clrt
