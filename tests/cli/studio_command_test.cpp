// SPDX-License-Identifier: Apache-2.0
// The studio and backgrounds at the command line: the flags that a run prints give its bits again, and
// transparent pictures have the alpha that their format has room for.
#include "clrt_command.h"

#include <cmath>
#include <sstream>

namespace clrt {

namespace {

class StudioCommand : public ClrtCommand {
protected:
    StudioCommand() { write_square("square"); }

    /// Renders 16 x 12 pixels; the middle 6 x 6 see nothing but the square, of the outer ones nothing.
    CommandResult render(std::vector<std::string> further) const {
        for (const char* word : {"square.obj", "-r", "16x12", "-s", "16", "--eye", "0,0,5", "--at", "0,0,0"})
            further.emplace_back(word);
        const CommandResult result = clrt(further);
        EXPECT_EQ(result.exit_code, 0) << result.err;
        return result;
    }
    ReadPicture picture(const std::string& name) const { return ReadPicture(folder.file(name)); }

    /// An alpha of 0 at the corners, 1 in the middle, in between at the edges.
    void expect_coverage(const ReadPicture& picture, const std::string& what) const {
        EXPECT_EQ(picture.at(0, 0, "A"), 0) << what;
        EXPECT_EQ(picture.at(15, 11, "A"), 0) << what;
        EXPECT_EQ(picture.at(8, 6, "A"), 1) << what;
        int edges = 0;
        for (int y = 0; y < 12; ++y)
            for (int x = 0; x < 16; ++x)
                edges += picture.at(x, y, "A") > 0 && picture.at(x, y, "A") < 1;
        EXPECT_GT(edges, 8) << what;
    }
};

/// The words of a log line from its first flag on.
std::vector<std::string> flags_of(const std::string& log, const std::string& start) {
    const size_t line = log.find(start), first = log.find(" --", line);
    std::istringstream words(log.substr(first, log.find('\n', first) - first));
    std::vector<std::string> flags;
    for (std::string word; words >> word;)
        flags.push_back(word);
    return flags;
}

} // namespace

TEST_F(StudioCommand, ItsFlagsGiveTheSameFile) {
    const CommandResult first = render({"-o", "studio.exr", "-o", "studio.png", "--aov", "albedo,Z,P,alpha"});
    ASSERT_TRUE(holds(first.err,
                      {"no light in the scene: a studio", "--sun ", "--env ", "--ground ", "--background "}));
    std::vector<std::string> flags = flags_of(first.err, "no light in the scene");
    for (const char* word : {"-o", "given.exr", "-o", "given.png", "--aov", "albedo,Z,P,alpha"})
        flags.emplace_back(word);
    const CommandResult second = render(flags);
    EXPECT_EQ(second.err.find("studio of"), std::string::npos) << second.err;
    EXPECT_EQ(folder.read("studio.png"), folder.read("given.png"));
    EXPECT_EQ(picture("studio.exr").values.size(), picture("given.exr").values.size());
    const ReadPicture a = picture("studio.exr"), b = picture("given.exr");
    for (size_t i = 0; i < a.values.size(); ++i)
        ASSERT_TRUE(a.values[i] == b.values[i] || (std::isnan(a.values[i]) && std::isnan(b.values[i]))) << i;
}

TEST_F(StudioCommand, OffIsAWhiteSky) {
    const CommandResult result = render({"--studio", "off", "-o", "off.png"});
    EXPECT_TRUE(holds(result.err, {"white sky of radiance 1 (--env 1,1,1)"}));
    EXPECT_EQ(picture("off.png").at(0, 0, "G"), 1);
}

TEST_F(StudioCommand, TransparentPicturesHaveAlpha) {
    for (const char* integrator : {"path", "distribution", "whitted", "raycast"}) {
        const CommandResult result =
            render({"-i", integrator, "--env", "0.5,0.5,0.5", "--background", "transparent", "-o", "t.png",
                    "-o", "t.tga", "-o", "t.tif", "-o", "t.exr", "-o", "t.jpg", "--aov", "none"});
        EXPECT_TRUE(holds(result.err, {"t.jpg: the format holds no alpha"}));
        EXPECT_EQ(result.err.find("t.png: the format"), std::string::npos);
        for (const char* name : {"t.png", "t.tga", "t.tif", "t.exr"})
            expect_coverage(picture(name), std::string(integrator) + " " + name);
        EXPECT_EQ(picture("t.jpg").spec.nchannels, 3);
        EXPECT_EQ(picture("t.exr").at(0, 0, "G"), 0);
    }
}

TEST_F(StudioCommand, AlphaIsAssociatedInExrAloneAndTheSameEverywhere) {
    render(
        {"--env", "0.5,0.5,0.5", "--background", "transparent", "-o", "t.exr", "-o", "t.tif", "-o", "t.png"});
    OIIO::ImageSpec raw;
    raw.attribute("oiio:UnassociatedAlpha", 1); // as it is in the file
    const auto read = [&](const char* name) {
        const auto input = OIIO::ImageInput::open(folder.file(name), &raw);
        std::vector<float> values(16 * 12 * 4);
        EXPECT_EQ(input->spec().nchannels, 4);
        EXPECT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, values.data()));
        return values;
    };
    const std::vector<float> tif = read("t.tif"), png = read("t.png");
    const ReadPicture exr = picture("t.exr");
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) {
            const size_t i = size_t(4 * (16 * y + x));
            const float alpha = exr.at(x, y, "A");
            EXPECT_EQ(tif[i + 3], alpha);
            EXPECT_EQ(std::lround(255 * png[i + 3]), std::lround(255 * alpha));
            EXPECT_NEAR(tif[i + 1] * alpha, exr.at(x, y, "G"), 1e-6);
            if (alpha > 0) { // the square's own colour up to its edges: 0.8 of the sky, sRGB 0.665
                EXPECT_NEAR(png[i + 1], 0.665, 0.01) << x << "," << y;
            } else {
                EXPECT_EQ(png[i + 1], 0);
            }
        }
}

TEST_F(StudioCommand, AColouredBackgroundHasNoAlpha) {
    render({"--background", "0,1,0", "-o", "green.png"});
    EXPECT_EQ(picture("green.png").spec.nchannels, 3);
    EXPECT_EQ(picture("green.png").at(0, 0, "G"), 1);
    EXPECT_EQ(picture("green.png").at(0, 0, "R"), 0);
}

TEST_F(StudioCommand, AGroundIsOpaque) {
    render({"--background", "transparent", "--ground", "0.5,0.5,0.5", "--eye", "0,3,5", "-o", "g.png"});
    EXPECT_EQ(picture("g.png").at(0, 11, "A"), 1);
}

TEST_F(StudioCommand, AdaptivePicturesHaveTheirAlpha) {
    render({"--adaptive", "-s", "64", "--background", "transparent", "-o", "a.png"});
    expect_coverage(picture("a.png"), "adaptive");
}

TEST_F(StudioCommand, ReplayAndExplainAgree) {
    const CommandResult replay = render({"--background", "0.25,0.5,0.75", "--pixel", "0,0", "--sample", "0"});
    EXPECT_TRUE(holds(replay.out, {"0.25 0.5 0.75"}));
    const CommandResult plain = render({"--env", "0,0,0", "--background", "0,1,0", "--explain"});
    EXPECT_TRUE(holds(plain.out, {"present  environment", "--background: radiance above 0"}));
    EXPECT_TRUE(holds(render({"--explain"}).out, {"1 by --sun of the studio", "--env of the studio"}));
}

TEST_F(StudioCommand, FilmsOfOtherBackgroundsDoNotGoOn) {
    render({"--background", "transparent", "--checkpoint", "a.film", "-o", "a.png"});
    const CommandResult other = clrt({"square.obj", "-r", "16x12", "-s", "32", "--eye", "0,0,5", "--at",
                                      "0,0,0", "--background", "0,1,0", "--resume", "a.film", "-o", "b.png"});
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_TRUE(holds(other.err, {"background"}));
    const CommandResult merged = run_command({CLRT_MERGE_EXECUTABLE, "a.film", "-o", "m.png"}, [&] {
        CommandSettings settings;
        settings.folder = path();
        return settings;
    }());
    EXPECT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_TRUE(holds(merged.err, {"coverage of the pixels is not known"}));
    EXPECT_EQ(picture("m.png").spec.nchannels, 3);
}

} // namespace clrt
