// SPDX-License-Identifier: Apache-2.0
// --paths and --aov NAME=EXPR on the command line: messages, files, and what is said about them.
#include "cli/clrt_command.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// A white square under a white sky, seen from the front.
class PathsCommand : public ClrtCommand {
protected:
    void SetUp() override { write_square("scene"); }
    static std::vector<std::string> small(std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"scene.obj", "-s", "8", "-r", "16x12", "--env", "1,1,1"});
        return arguments;
    }
    nlohmann::json statistics(const std::string& name) const {
        std::ifstream file(folder.file(name));
        return nlohmann::json::parse(file);
    }
};

} // namespace

TEST_F(PathsCommand, AWrongExpressionIsShownWithACaret) {
    const auto result = clrt(small({"--paths", "L(D|X)*E"}));
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_TRUE(holds(result.err, {"option --paths: expected a letter of the path notation", "found 'X'",
                                   "\n  L(D|X)*E\n      ^\n"}));
    const auto layer = clrt(small({"--aov", "a=LDE,b=LD", "-o", "a.exr"}));
    EXPECT_EQ(layer.exit_code, 2);
    EXPECT_TRUE(
        holds(layer.err, {"option --aov: expected every path to end with the eye", "\n  LD\n   ^\n"}));
    EXPECT_FALSE(exists("a.exr"));
}

TEST_F(PathsCommand, NoPathIsABlackPictureWithoutALaunch) {
    const auto result = clrt(small({"--paths", "LS+DE", "-o", "a.exr", "-o", "a.png", "--stats", "a.json",
                                    "--aov", "samples,caustics=LS+DE", "--dump-kernels", "kernels"}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.err, {"'LS+DE': no path of this scene matches (surfaces: D; lights: Le)"}));
    EXPECT_FALSE(exists("kernels")) << "something was compiled";
    const ReadPicture picture(folder.file("a.exr"));
    EXPECT_TRUE(std::all_of(picture.values.begin(), picture.values.end(), [](float v) { return v == 0; }));
    EXPECT_EQ(picture.spec.width, 16);
    EXPECT_GE(picture.spec.channelindex("caustics.B"), 0);
    EXPECT_TRUE(exists("a.png"));
    const auto json = statistics("a.json");
    EXPECT_EQ(json["paths"]["empty"], true);
    EXPECT_EQ(json["rays"]["primary"], 0);
    EXPECT_EQ(json["seconds"]["compile"], 0.0);
}

TEST_F(PathsCommand, LayersAndExpressionsAreInTheFiles) {
    const auto result = clrt(small(
        {"-o", "a.exr", "--stats", "a.json", "--aov", "albedo, direct=LDE", "--aov", "sky=LE,more=LDDD*E"}));
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ReadPicture picture(folder.file("a.exr"));
    for (const char* channel : {"R", "albedo.R", "direct.R", "direct.G", "direct.B", "sky.R", "more.R"})
        EXPECT_GE(picture.spec.channelindex(channel), 0) << channel;
    EXPECT_LT(picture.spec.channelindex("N.X"), 0) << "a list holds what it names";
    EXPECT_EQ(picture.spec.get_string_attribute("clrt.paths.direct"), "LDE");
    bool sees_square = false, sees_sky = false;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) {
            const float direct = picture.at(x, y, "direct.R"), sky = picture.at(x, y, "sky.R");
            EXPECT_NEAR(direct + sky, picture.at(x, y, "R"), 1e-5f);
            EXPECT_EQ(picture.at(x, y, "more.R"), 0);
            sees_square = sees_square || direct > 0;
            sees_sky = sees_sky || sky > 0;
        }
    EXPECT_TRUE(sees_square && sees_sky);
    const auto json = statistics("a.json");
    EXPECT_TRUE(json["paths"]["expression"].is_null());
    EXPECT_EQ(json["paths"]["layers"][0]["name"], "direct");

    ASSERT_EQ(clrt(small({"-o", "b.exr", "--paths", "E D L", "--aov", "none"})).exit_code, 0);
    const ReadPicture filtered(folder.file("b.exr"));
    EXPECT_EQ(filtered.spec.nchannels, 3);
    EXPECT_EQ(filtered.spec.get_string_attribute("clrt.paths"), "E D L");
    EXPECT_NEAR(filtered.at(8, 6, "R"), picture.at(8, 6, "direct.R"), 1e-5f);
}

TEST_F(PathsCommand, WhatCannotBeDoneIsRefused) {
    const std::pair<std::vector<std::string>, const char*> cases[] = {
        {{"--paths", "LDE", "-i", "whitted"},
         "option --paths: expected --integrator distribution or path, found whitted"},
        {{"--paths", "LDE", "-i", "raycast"}, "'LD?E' alone"},
        {{"--aov", "a=LDE", "-i", "whitted", "-o", "a.exr"}, "expected --integrator distribution or path"},
        {{"--aov", "a=LDE"}, "an output that ends in .exr for the layer 'a', found none; add -o FILE.exr"},
        {{"--aov", "albedo=LDE", "-o", "a.exr"}, "a new name of letters"},
        {{"--aov", "a=LDE,a=LE", "-o", "a.exr"}, "a new name of letters"},
        {{"--aov", "Combined=LDE", "-o", "a.exr"}, "a new name of letters"},
        {{"--aov", "9=LDE", "-o", "a.exr"}, "a new name of letters"},
        {{"--aov", "a.b=LDE", "-o", "a.exr"}, "a new name of letters"},
        {{"--aov", "=LDE", "-o", "a.exr"}, "a new name of letters"},
        {{"--aov", "a=LE,b=LE,c=LE,d=LE,e=LE,f=LE,g=LE,h=LE,i=LE", "-o", "a.exr"}, "at most 8 layers"},
        {{"--paths", "L" + std::string(300, 'D') + "E"}, "at most 255 states, found 301"},
        {{"--paths", ""}, "expected a letter"},
    };
    for (const auto& [arguments, message] : cases) {
        const auto result = clrt(small(arguments));
        EXPECT_EQ(result.exit_code, 2) << message;
        EXPECT_TRUE(holds(result.err, {message}));
    }
    EXPECT_FALSE(exists("scene.png"));
}

TEST_F(PathsCommand, TheAutomatonIsExplained) {
    const auto result = clrt(small({"--paths", "L(D|S)*E", "--explain"}));
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_TRUE(holds(result.out, {"that is every path of this scene"}));
    const auto filter = clrt(small({"--paths", "LDE", "--explain", "--aov", "a=LE"}));
    EXPECT_TRUE(holds(filter.out, {"Paths:", "2 states, at most 2 segments", "absent  T", "layer a: LE"}));
    const auto json = nlohmann::json::parse(clrt(small({"--paths", "LDE", "--explain=json"})).out);
    EXPECT_EQ(json["paths"]["states"], 2);
}

} // namespace clrt
