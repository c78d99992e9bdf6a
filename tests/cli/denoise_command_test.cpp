// SPDX-License-Identifier: Apache-2.0
// --denoise: layers, statistics, what PNGs show, and what is said where it cannot be done.
#include "clrt_command.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

namespace clrt {

namespace {

/// A square of many colours in front of a white sky.
class DenoiseCommand : public ClrtCommand {
protected:
    DenoiseCommand() { write_square("scene"); }

    CommandResult render(std::vector<std::string> further) const {
        for (const char* word : {"scene.obj", "-r", "40x34", "--eye", "1,1,2", "--at", "0,0,0", "--env",
                                 "1,1,1", "--ground", "0.5,0.5,0.5", "-s", "8"})
            further.emplace_back(word);
        return clrt(further);
    }
    nlohmann::json statistics() const {
        std::ifstream file(folder.file("a.json"));
        return nlohmann::json::parse(file);
    }
    bool same_bytes(const std::string& a, const std::string& b) const {
        const auto bytes = [&](const std::string& name) {
            std::ifstream file(folder.file(name), std::ios::binary);
            return std::string(std::istreambuf_iterator<char>(file), {});
        };
        return bytes(a) == bytes(b);
    }
};

} // namespace

TEST_F(DenoiseCommand, AddsLayersAndStatesTheirError) {
    ASSERT_EQ(render({"-o", "raw.exr", "-o", "raw.png"}).exit_code, 0);
    const CommandResult result = render(
        {"--denoise=filter", "-o", "a.exr", "-o", "a.png", "--stats", "a.json", "--png-from", "denoised"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(holds(result.out, {"denoised ", "without the worst 1 % of the pixels", "by filter in"}));

    const ReadPicture raw(folder.file("raw.exr")), picture(folder.file("a.exr"));
    EXPECT_LT(raw.spec.channelindex("denoised.R"), 0);
    double squares = 0, difference = 0;
    for (int y = 0; y < 34; ++y)
        for (int x = 0; x < 40; ++x) {
            for (const char* channel : {"R", "G", "B"}) {
                ASSERT_EQ(picture.at(x, y, channel), raw.at(x, y, channel)) << "the raw picture stays";
                difference += std::abs(double(picture.at(x, y, std::string("denoised.") + channel)) -
                                       double(raw.at(x, y, channel)));
            }
            squares += std::pow(double(picture.at(x, y, "error.denoised")), 2) / (34 * 40);
        }
    EXPECT_GT(difference, 0);
    const nlohmann::json json = statistics()["denoised"];
    EXPECT_EQ(json["method"], "filter");
    EXPECT_LT(json["error"]["low"], json["error"]["rel_rmse"]);
    EXPECT_GT(json["error"]["high"], json["error"]["rel_rmse"]);
    EXPECT_NEAR(json["error"]["raw_rel_rmse"], statistics()["error"]["rel_rmse"], 1e-9);
    EXPECT_EQ(json["without_worst"]["pixels"], 14);
    EXPECT_NEAR(std::stod(picture.spec.get_string_attribute("clrt.denoised.error")),
                json["error"]["rel_rmse"].get<double>(), 1e-5);
    EXPECT_GT(squares, 0);
    EXPECT_FALSE(same_bytes("raw.png", "a.png"));
}

TEST_F(DenoiseCommand, PicturesShowWhatIsRenderedUnlessTheyAreToldOtherwise) {
    ASSERT_EQ(render({"-o", "raw.png"}).exit_code, 0);
    const CommandResult result = render({"--denoise=filter", "-o", "a.png", "--stats", "a.json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_TRUE(same_bytes("raw.png", "a.png"));
    EXPECT_TRUE(holds(result.err, {"no file will hold the denoised picture", "--png-from denoised"}));
    ASSERT_EQ(render({"-o", "raw.png", "--stats", "a.json"}).exit_code, 0);
    EXPECT_TRUE(statistics()["denoised"].is_null());
}

TEST_F(DenoiseCommand, AResumedFilmIsDenoisedAsIfItHadBeenAtOnce) {
    ASSERT_EQ(render({"--denoise=filter", "-o", "a.exr"}).exit_code, 0);
    ASSERT_EQ(render({"--checkpoint", "a.film", "-o", "b.png"}).exit_code, 0);
    const CommandResult result = render({"--resume", "a.film", "--denoise=filter", "-o", "b.exr"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const ReadPicture a(folder.file("a.exr")), b(folder.file("b.exr"));
    for (int y = 0; y < 34; ++y)
        for (int x = 0; x < 40; ++x)
            ASSERT_EQ(a.at(x, y, "denoised.G"), b.at(x, y, "denoised.G"));
}

TEST_F(DenoiseCommand, ALibraryThatIsNotThereIsNamed) {
    const CommandResult absent = render({"--denoise=oidn", "--oidn", "nowhere.so", "-o", "a.exr"});
    EXPECT_EQ(absent.exit_code, 2);
    EXPECT_TRUE(holds(absent.err, {"--denoise=oidn", "'nowhere.so'", "--oidn", "CLRT_OIDN", "pyoidn"}));
    EXPECT_FALSE(exists("a.exr"));
    CommandSettings settings;
    settings.environment["CLRT_OIDN"] = "libm.so.6";
    const CommandResult other =
        clrt({"scene.obj", "--denoise=oidn", "-o", "a.exr", "-r", "16x16", "-s", "8"}, settings);
    EXPECT_EQ(other.exit_code, 2);
    EXPECT_TRUE(holds(other.err, {"CLRT_OIDN", "no function oidnNewDevice"}));
}

} // namespace clrt
