// SPDX-License-Identifier: Apache-2.0
// Hashes, ids and ranks of mattes.
#include "output/cryptomatte.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

float as_float(std::uint32_t bits) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

} // namespace

TEST(Cryptomatte, HashesAreThoseOfTheReference) {
    // Of Appleby's MurmurHash3_x86_32, one for each length of the last block.
    EXPECT_EQ(murmur_hash_3(""), 0u);
    EXPECT_EQ(murmur_hash_3("hello"), 0x248bfa47u);
    EXPECT_EQ(murmur_hash_3("hello, world"), 0x149bbb7fu);
    EXPECT_EQ(murmur_hash_3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
    // As Blender writes them.
    EXPECT_EQ(murmur_hash_3("Cube"), 0xa8fce865u);
    EXPECT_EQ(murmur_hash_3("Material"), 0x3913209du);
    EXPECT_EQ(murmur_hash_3("\xcf\x80\xcf\x80\xcf\x80\xcf\x80"), 0x2f05b8aau) << "bytes are unsigned";
}

TEST(Cryptomatte, IdsAreHashesThatAreNormalFloats) {
    EXPECT_FLOAT_EQ(matte_id("hello"), 6.0705627e-17f);
    EXPECT_EQ(matte_id("Cube"), as_float(0xa8fce865u));
    EXPECT_EQ(matte_id(""), as_float(0x00800000u));
    int turned = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::string name = "object " + std::to_string(i);
        ASSERT_TRUE(std::isnormal(matte_id(name))) << name;
        turned +=
            matte_id(name) != as_float(murmur_hash_3(name)) || std::isnan(as_float(murmur_hash_3(name)));
    }
    EXPECT_GT(turned, 0) << "about one in 128";
}

TEST(Cryptomatte, RanksFallAndEachIdComesOnce) {
    std::vector<float> values{-1};
    append_mattes(values, {{3, 0.125}, {5, 0.25}, {3, 0.25}, {4, 0.25}});
    EXPECT_EQ(values, (std::vector<float>{-1, 3, 0.375f, 4, 0.25f, 5, 0.25f, 0, 0, 0, 0, 0, 0}));
    values.clear();
    append_mattes(values, {{1, 0.1}, {2, 0.2}, {3, 0.05}, {4, 0.15}, {5, 0.3}, {6, 0.12}, {7, 0.08}});
    EXPECT_EQ(values, (std::vector<float>{5, 0.3f, 2, 0.2f, 4, 0.15f, 6, 0.12f, 1, 0.1f, 7, 0.08f}));
}

TEST(Cryptomatte, ChannelsAndMetadataAreThoseOfTheStandard) {
    const std::vector<std::string> channels = matte_channels("CryptoObject");
    ASSERT_EQ(channels.size(), 2 * MATTE_RANKS);
    EXPECT_EQ(channels.front(), "CryptoObject00.R");
    EXPECT_EQ(channels[7], "CryptoObject01.A");
    EXPECT_EQ(channels.back(), "CryptoObject02.A");
    const Metadata attributes = matte_attributes("ViewLayer.CryptoObject", {"Cube", "\"a\"\\b"});
    // The key that Blender writes for this name.
    EXPECT_EQ(attributes[0],
              (std::pair<std::string, std::string>("cryptomatte/542cafa/name", "ViewLayer.CryptoObject")));
    EXPECT_EQ(attributes[1].second, "MurmurHash3_32");
    EXPECT_EQ(attributes[2].second, "uint32_to_float32");
    EXPECT_EQ(attributes[3].first, "cryptomatte/542cafa/manifest");
    const nlohmann::json manifest = nlohmann::json::parse(attributes[3].second);
    EXPECT_EQ(manifest["Cube"], "a8fce865");
    EXPECT_EQ(manifest.size(), 2u);
}

} // namespace clrt
