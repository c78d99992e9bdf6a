// SPDX-License-Identifier: Apache-2.0
// Mattes of a picture: the share of each pixel's samples that see an object or material first.
#include "clrt_command.h"

#include "output/cryptomatte.h"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <map>

namespace clrt {

namespace {

/// Of so many strips side by side a pixel sees about 24, more than have a slot.
constexpr int THIN_STRIPS = 3000;

class CryptomatteCommand : public ClrtCommand {
protected:
    /// A lamp before a wall of another object and material, which fills the left half of the picture.
    CryptomatteCommand() {
        folder.write("scene.mtl", "newmtl glow\nKd 0 0 0\nKe 1 1 1\nnewmtl stone\nKd 0.5 0.5 0.5\n");
        folder.write(
            "scene.obj",
            "mtllib scene.mtl\no lamp\nusemtl glow\nv -1 -0.8 0\nv 0.9 -0.3 0.2\nv 0.1 1 -0.1\nf 1 2 3\n"
            "o wall\nusemtl stone\nv -9 -9 -1\nv 0 -9 -1\nv 0 9 -1\nv -9 9 -1\nf 4 5 6 7\n");
    }

    /// Renders 24 x 20 pixels with both kinds of mattes.
    ReadPicture render(const std::string& name, std::vector<std::string> further) const {
        for (const char* word : {"scene.obj", "-r", "24x20", "--eye", "0,0,4", "--at", "0,0,0", "--aov",
                                 "alpha,cryptoObject,cryptoMaterial", "-i", "raycast", "-o"})
            further.emplace_back(word);
        further.push_back(name);
        const CommandResult result = clrt(further);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return ReadPicture(folder.file(name));
    }
};

/// Coverage by id of a kind's ranks in a pixel; falls from rank to rank.
std::map<float, float> shares(const ReadPicture& picture, int x, int y, const std::string& kind) {
    std::map<float, float> found;
    float last = 1;
    for (int layer = 0; layer < 3; ++layer)
        for (const auto& [id, coverage] : {std::pair("R", "G"), std::pair("B", "A")}) {
            const std::string name = fmt::format("{}{:02}.", kind, layer);
            const float share = picture.at(x, y, name + coverage);
            EXPECT_LE(share, last) << name << " at " << x << "," << y;
            last = share;
            if (share > 0)
                found[picture.at(x, y, name + id)] += share;
        }
    return found;
}

void expect_same(const ReadPicture& a, const ReadPicture& b) {
    ASSERT_EQ(a.spec.channelnames, b.spec.channelnames);
    for (const std::string& channel : a.spec.channelnames)
        for (int y = 0; y < a.spec.height && channel.rfind("Crypto", 0) == 0; ++y)
            for (int x = 0; x < a.spec.width; ++x)
                ASSERT_EQ(a.at(x, y, channel), b.at(x, y, channel)) << channel << " at " << x << "," << y;
}

} // namespace

TEST_F(CryptomatteCommand, CoverageIsThatOfTheSamples) {
    const ReadPicture picture = render("a.exr", {"-s", "64"});
    const float lamp = matte_id("lamp"), wall = matte_id("wall"), glow = matte_id("glow"),
                stone = matte_id("stone");
    int edges = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x) {
            std::map<float, float> objects = shares(picture, x, y, "CryptoObject"),
                                   materials = shares(picture, x, y, "CryptoMaterial");
            EXPECT_FLOAT_EQ(objects[lamp] + objects[wall], picture.at(x, y, "A")) << x << "," << y;
            EXPECT_EQ(objects.size(), 2u) << "no other ids";
            EXPECT_EQ(objects[lamp], materials[glow]);
            EXPECT_EQ(objects[wall], materials[stone]);
            edges += objects[lamp] > 0 && objects[wall] > 0;
        }
    EXPECT_GT(edges, 10);
    EXPECT_EQ(picture.spec.channelformat(picture.spec.channelindex("CryptoObject00.R")), OIIO::TypeFloat);
    const std::string key =
        "cryptomatte/" + fmt::format("{:08x}", murmur_hash_3("CryptoMaterial")).substr(0, 7) + "/";
    EXPECT_EQ(picture.spec.get_string_attribute(key + "name"), "CryptoMaterial");
    EXPECT_TRUE(holds(picture.spec.get_string_attribute(key + "manifest"), {"\"stone\":\"", "\"glow\":\""}));
}

TEST_F(CryptomatteCommand, HoweverTheRenderGrowsTheMattesAreTheSame) {
    const ReadPicture whole = render("whole.exr", {"-s", "40", "--checkpoint", "a.film"});
    expect_same(render("resumed.exr", {"-s", "40", "--resume", "a.film"}), whole);
    expect_same(render("one.exr", {"-s", "40", "--threads", "1"}), whole);
    const ReadPicture part = render("part.exr", {"-s", "40", "--crop", "5,3,20,17"});
    for (int y = 3; y < 17; ++y)
        for (int x = 5; x < 20; ++x)
            for (const char* channel : {"CryptoObject00.R", "CryptoObject00.G", "CryptoMaterial00.A"})
                ASSERT_EQ(part.at(x - 5, y - 3, channel), whole.at(x, y, channel)) << channel;
}

TEST_F(CryptomatteCommand, AdaptiveTilesCountTheSamplesOfThePicture) {
    const ReadPicture picture = render("a.exr", {"-s", "96", "--adaptive"});
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x) {
            float sum = 0;
            for (const auto& [id, share] : shares(picture, x, y, "CryptoObject"))
                sum += share;
            EXPECT_NEAR(sum, picture.at(x, y, "A"), 1e-6) << x << "," << y;
        }
}

TEST_F(CryptomatteCommand, WhatFindsNoSlotIsLeftOut) {
    std::string obj = "mtllib scene.mtl\nusemtl glow\n";
    for (int i = 0; i < THIN_STRIPS; ++i)
        obj += fmt::format("o strip{0}\nv {1} -9 0\nv {2} -9 0\nv {2} 9 0\nv {1} 9 0\nf {3} {4} {5} {6}\n", i,
                           -9 + 18.0 * i / THIN_STRIPS, -9 + 18.0 * (i + 1) / THIN_STRIPS, 4 * i + 1,
                           4 * i + 2, 4 * i + 3, 4 * i + 4);
    folder.write("scene.obj", obj);
    const ReadPicture picture = render("a.exr", {"-s", "240"});
    const std::map<float, float> objects = shares(picture, 12, 10, "CryptoObject");
    EXPECT_EQ(objects.size(), MATTE_RANKS);
    float sum = 0;
    for (const auto& [id, share] : objects)
        sum += share;
    EXPECT_LT(sum, 1);
    EXPECT_GT(sum, 0.2);
    const std::map<float, float> materials = shares(picture, 12, 10, "CryptoMaterial");
    EXPECT_EQ(materials.size(), 1u);
    EXPECT_EQ(materials.begin()->second, picture.at(12, 10, "A")) << "one material has all";
}

} // namespace clrt
