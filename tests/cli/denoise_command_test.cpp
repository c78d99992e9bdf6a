// SPDX-License-Identifier: Apache-2.0
// --denoise: layers, statistics, what PNGs show, and what is said where it cannot be done.
#include "clrt_command.h"
#include "render/good_counts.h"

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
        further.insert(further.end(), {"-s", "8"});
        return render_until(further);
    }
    CommandResult render_until(std::vector<std::string> further) const {
        for (const char* word : {"scene.obj", "-r", "40x34", "--eye", "1,1,2", "--at", "0,0,0", "--env",
                                 "1,1,1", "--ground", "0.5,0.5,0.5"})
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

TEST_F(DenoiseCommand, ATargetEndsTheRenderWhereItIsReached) {
    const std::vector<std::string> target = {
        "--denoise=filter", "--denoised-error", "6%", "--stats", "a.json", "-o", "a.exr"};
    const CommandResult result = render_until(target);
    ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
    EXPECT_TRUE(holds(result.err, {"--denoised-error 6 % is reached"}));
    EXPECT_TRUE(holds(result.out, {"--denoised-error looked "}));
    const nlohmann::json json = statistics();
    EXPECT_EQ(json["stop"]["rule"], "denoised_error");
    EXPECT_EQ(json["stop"]["error_target"], 0.06);
    EXPECT_EQ(json["stop"]["error_reached"], true);
    EXPECT_EQ(json["stop"]["error_of"], "denoised");
    EXPECT_LE(json["denoised"]["error"]["high"], 0.06);
    const auto spp = json["spp"].get<unsigned>();
    EXPECT_TRUE(is_good_count(spp, 4)) << spp;
    const nlohmann::json& looks = json["denoised"]["looks"];
    EXPECT_EQ(looks.back()["at_spp"], spp);
    EXPECT_EQ(looks.back()["high"], json["denoised"]["error"]["high"]);
    for (size_t i = 0; i + 1 < looks.size(); ++i)
        EXPECT_GT(looks[i]["high"], 0.06);
    // Looking changes no bit: a plain render of as many samples is the same.
    ASSERT_EQ(render_until({"--denoise=filter", "-s", std::to_string(spp), "-o", "b.exr"}).exit_code, 0);
    const ReadPicture a(folder.file("a.exr")), b(folder.file("b.exr"));
    for (const char* channel : {"G", "denoised.G"})
        for (int y = 0; y < 34; ++y)
            for (int x = 0; x < 40; ++x)
                ASSERT_EQ(a.at(x, y, channel), b.at(x, y, channel));
    // And so does going on from fewer.
    ASSERT_EQ(
        render_until({"--denoise=filter", "-s", "4", "--checkpoint", "a.film", "-o", "c.png"}).exit_code, 0);
    std::vector<std::string> resumed = target;
    resumed.insert(resumed.end(), {"--resume", "a.film"});
    ASSERT_EQ(render_until(resumed).exit_code, 0);
    EXPECT_EQ(statistics()["spp"], spp);
}

TEST_F(DenoiseCommand, AMissedTargetEndsWithFiveAndThePicture) {
    const CommandResult result =
        render({"--denoised-error", "0.001%", "--denoise=filter", "-o", "a.exr", "--stats", "a.json"});
    EXPECT_EQ(result.exit_code, 5) << result.err;
    EXPECT_TRUE(holds(result.err, {"--denoised-error 0.001 % is not reached"}));
    EXPECT_TRUE(holds(result.out, {"missed   --denoised-error 0.001 % is not reached\n"}));
    EXPECT_EQ(statistics()["stop"]["rule"], "spp");
    EXPECT_EQ(statistics()["stop"]["error_reached"], false);
    EXPECT_GE(ReadPicture(folder.file("a.exr")).spec.channelindex("denoised.R"), 0);
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
